//! Runs the tests and writes VERIFICATION.md and its pictures, or checks the page against a run.

use clap::Parser;
use ladder::mutants::{MutationRecord, reasons};
use ladder::{Answer, FOLDER, Rung, compare, constants, figures, page};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

#[derive(Parser)]
#[command(about = "Runs the tests and writes VERIFICATION.md")]
struct Arguments {
    /// Use the answers of this folder instead of running the tests.
    #[arg(long, value_name = "FOLDER")]
    from: Option<PathBuf>,
    /// Compare the page with the answers instead of writing it.
    #[arg(long, requires = "from")]
    check: bool,
}

fn main() -> Result<ExitCode> {
    let arguments = Arguments::parse();
    let root = records::root();
    let path = root.join("VERIFICATION.md");
    let folder = match arguments.from {
        Some(folder) => folder,
        None => ask(&root)?,
    };
    let answers = Answer::read_all(&folder)?;
    if arguments.check {
        return check(&path, &answers);
    }
    let mut pictures = Vec::new();
    for rung in Rung::ALL {
        if let Some(figure) = figures::convergence(rung, &answers) {
            plot::save(
                &figure,
                &root.join("pages/ladder/figures"),
                &page::slug(rung),
            )?;
            pictures.push(rung);
        }
    }
    let text = page::page(
        &answers,
        &pictures,
        &constants::ConstantsRecord::load()?,
        &MutationRecord::read_all()?,
        &reasons()?,
    )?;
    fs::write(&path, text).into_diagnostic()?;
    records::write_notes(&root)?;
    let failed: Vec<&Answer> = answers.iter().filter(|a| !a.holds()).collect();
    for answer in &failed {
        eprintln!("does not hold: {}", answer.question);
    }
    Ok(ExitCode::from(u8::from(!failed.is_empty())))
}

/// Runs all tests; a test that fails has still written the answers before its failure.
fn ask(root: &Path) -> Result<PathBuf> {
    let folder = root.join("target/ladder");
    if folder.exists() {
        fs::remove_dir_all(&folder).into_diagnostic()?;
    }
    let status = Command::new(env!("CARGO"))
        .args(["test", "--workspace", "--no-fail-fast"])
        .current_dir(root)
        .env(FOLDER, &folder)
        .status()
        .into_diagnostic()?;
    if !status.success() {
        eprintln!("tests fail; the page shows how far they came");
    }
    Ok(folder)
}

fn check(path: &Path, answers: &[Answer]) -> Result<ExitCode> {
    let page = fs::read_to_string(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let stale = compare::stale(&page, answers);
    if stale.is_empty() {
        println!(
            "VERIFICATION.md has the {} rows of the tests, with their bounds, reasons and numbers",
            answers.len()
        );
        return Ok(ExitCode::SUCCESS);
    }
    Err(miette!(
        help = "cargo run --release -p ladder",
        "VERIFICATION.md is stale\n{}",
        stale.join("\n")
    ))
}
