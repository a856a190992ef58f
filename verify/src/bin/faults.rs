//! Applies every seeded fault to a copy of the workspace, one at a time, and reports which tests catch it.

use clap::Parser;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use verify::faults::{Fault, Outcome, list, outcomes as known, root};

/// Tests that take seconds, and those that take a minute and are asked only when the first catch nothing.
const STAGES: [&[&str]; 2] = [
    &["parts", "rigid_mechanisms", "other_elements"],
    &["impacts", "one_element"],
];

/// Runs all seeded faults and writes verify/faults.json.
#[derive(Parser)]
struct Arguments {
    /// Runs only faults whose name contains this; what is known of the others stays.
    #[arg(long)]
    only: Option<String>,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let faults = list()?;
    let chosen = |fault: &&Fault| {
        let only = arguments.only.as_ref();
        only.is_none_or(|text| fault.name.contains(text.as_str()))
    };
    let chosen: Vec<&Fault> = faults.iter().filter(chosen).collect();
    let tree = copy_workspace()?;
    let sound = tests(&tree, STAGES[0])?;
    if !sound.is_empty() {
        return Err(miette!(
            "without a fault these tests fail: {}",
            sound.join(", ")
        ));
    }
    let mut outcomes = Vec::new();
    for fault in chosen {
        let outcome = seed(&tree, fault)?;
        let caught = match outcome.caught_by.len() {
            0 => "NOT CAUGHT".to_owned(),
            _ => outcome.caught_by.join(", "),
        };
        println!("{:60} {caught}", fault.name);
        outcomes.push(outcome);
    }
    let missed = outcomes.iter().filter(|o| o.caught_by.is_empty()).count();
    keep(&faults, outcomes)?;
    match missed {
        0 => Ok(()),
        n => Err(miette!("{n} faults were not caught")),
    }
}

/// Writes the outcomes, those of faults that were not run from the run before.
fn keep(faults: &[Fault], fresh: Vec<Outcome>) -> Result<()> {
    let before = known().unwrap_or_default();
    let find = |fault: &Fault| {
        let all = fresh.iter().chain(&before);
        all.into_iter().find(|o| o.name == fault.name)
    };
    let outcomes: Vec<&Outcome> = faults.iter().filter_map(find).collect();
    let text = serde_json::to_string_pretty(&outcomes).into_diagnostic()?;
    fs::write(root().join("verify/faults.json"), text + "\n").into_diagnostic()
}

/// Copies what is under version control to the target folder, where cargo never looks for a workspace of its own.
fn copy_workspace() -> Result<PathBuf> {
    let root = root();
    let tree = root.join("target/faults/tree");
    let listed = Command::new("git")
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(&root)
        .output()
        .into_diagnostic()
        .wrap_err("git lists the files to copy")?;
    let names = String::from_utf8(listed.stdout).into_diagnostic()?;
    for name in names.split('\0').filter(|name| !name.is_empty()) {
        let (from, to) = (root.join(name), tree.join(name));
        let bytes = fs::read(&from).into_diagnostic()?;
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            continue;
        }
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder).into_diagnostic()?;
        }
        fs::write(&to, bytes)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", to.display()))?;
    }
    Ok(tree)
}

/// Puts a fault in, asks the tests, takes it out.
fn seed(tree: &Path, fault: &Fault) -> Result<Outcome> {
    let path = tree.join(&fault.file);
    let sound = fs::read_to_string(&path).into_diagnostic()?;
    fs::write(&path, fault.applied(tree)?).into_diagnostic()?;
    let mut caught_by = Vec::new();
    for stage in STAGES {
        caught_by = tests(tree, stage).wrap_err_with(|| fault.name.clone())?;
        if !caught_by.is_empty() {
            break;
        }
    }
    fs::write(&path, sound).into_diagnostic()?;
    Ok(Outcome {
        name: fault.name.clone(),
        caught_by,
    })
}

/// Names of the tests that fail.
fn tests(tree: &Path, filters: &[&str]) -> Result<Vec<String>> {
    let output = Command::new(env!("CARGO"))
        .args([
            "test",
            "--release",
            "--quiet",
            "-p",
            "verify",
            "--test",
            "agreement",
            "--",
        ])
        .args(["--format", "pretty"])
        .args(filters)
        .env("CARGO_TARGET_DIR", root().join("target/faults/build"))
        .env("RUST_BACKTRACE", "0")
        .current_dir(tree)
        .output()
        .into_diagnostic()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let failed = text.lines().filter_map(|line| {
        let name = line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?;
        Some(name.rsplit("::").next().unwrap_or(name).to_owned())
    });
    let failed: Vec<String> = failed.collect();
    if failed.is_empty() && !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("the tests did not run:\n{errors}"));
    }
    Ok(failed)
}
