//! Mutation testing of the kernels: draws mutants by a fixed seed, runs cargo-mutants on them, writes `mutants.json`.
//!
//! It takes about half an hour on an idle machine. Survivors that better tests should catch are tried alone with `--again`.
//! `cargo run --release -p ladder -- --from target/ladder` then brings the page up to date.

use clap::Parser;
use ladder::mutants::{Counts, Record, paths};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use records::Run;
use serde::Deserialize;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Folders of the kernels.
const KERNELS: [&str; 5] = ["link", "contact", "constraint", "force", "stepper"];

#[derive(Parser)]
#[command(about = "Draws mutants of the kernels and records which of them the tests notice")]
struct Arguments {
    /// Seed of the draw.
    #[arg(long, default_value_t = 4)]
    seed: u64,
    /// How many mutants are drawn.
    #[arg(long, default_value_t = 500)]
    count: usize,
    /// Tries only the survivors of the last record.
    #[arg(long)]
    again: bool,
    /// Mutants under test at once.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
}

/// `outcomes.json` of cargo-mutants, as far as it is read here.
#[derive(Deserialize)]
struct Outcomes {
    outcomes: Vec<Outcome>,
    cargo_mutants_version: String,
}

#[derive(Deserialize)]
struct Outcome {
    scenario: Scenario,
    summary: Summary,
}

#[derive(Deserialize)]
enum Scenario {
    Baseline,
    Mutant { name: String },
}

#[derive(Deserialize)]
enum Summary {
    Success,
    CaughtMutant,
    MissedMutant,
    Timeout,
    Unviable,
    Failure,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // what is only revised keeps the digests of the run that it revises
    let run = match arguments.again {
        true => None,
        false => Some(Run::begin("mutation")?),
    };
    let all = list(&root)?;
    let before = arguments.again.then(Record::read).transpose()?;
    let drawn = match &before {
        Some(before) => before.survivors.clone(),
        None => {
            let mut drawn = all.clone();
            drawn.shuffle(&mut ChaCha8Rng::seed_from_u64(arguments.seed));
            drawn.truncate(arguments.count);
            drawn
        }
    };
    if let Some(gone) = drawn.iter().find(|name| !all.contains(name)) {
        return Err(miette!("{gone} is of another version of the code"));
    }

    let output = root.join("target/mutation");
    fs::create_dir_all(&output).into_diagnostic()?;
    let mut command = Command::new("cargo");
    command.arg("mutants").current_dir(&root).args(kernels());
    command.args(["--profile", "mutants"]);
    // each job builds in a folder of its own: jobs that wait for a shared one count as timeouts
    command.env_remove("CARGO_TARGET_DIR");
    command.args(["--jobs", &arguments.jobs.to_string()]);
    command.arg("--output").arg(&output);
    for name in &drawn {
        command
            .arg("--re")
            .arg(format!("^{}$", regex::escape(name)));
    }
    // for the build as well as for the run
    command.arg("--cargo-arg=--test=kernels");
    // its exit code says whether there are survivors; what became of each mutant stands in its file
    command
        .status()
        .into_diagnostic()
        .wrap_err("cargo-mutants cannot be started")?;
    let path = output.join("mutants.out/outcomes.json");
    let text = fs::read_to_string(&path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let outcomes: Outcomes = serde_json::from_str(&text).into_diagnostic()?;
    let record = record(&arguments, all.len(), &drawn, outcomes)?;
    let total = record.total();
    if total.viable() + total.unviable != drawn.len() {
        return Err(miette!(
            "{} mutants were drawn, {total:?} have a verdict",
            drawn.len()
        ));
    }
    let record = match before {
        Some(before) => before.revised(record),
        None => record,
    };
    let [path, _] = paths();
    let text = serde_json::to_string_pretty(&record).into_diagnostic()?;
    fs::write(&path, text + "\n").into_diagnostic()?;
    if let Some(run) = run {
        run.finish()?;
    }
    let total = record.total();
    println!("{:.1} % caught of {total:?}", 100.0 * record.caught());
    Ok(())
}

/// Arguments that choose the kernels.
fn kernels() -> Vec<String> {
    let files = KERNELS.map(|kernel| format!("--file=src/{kernel}/**"));
    ["--package=looselink".to_owned()]
        .into_iter()
        .chain(files)
        .collect()
}

/// Names of all mutants of the kernels.
fn list(root: &Path) -> Result<Vec<String>> {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--list"]).args(kernels());
    let listed = command.current_dir(root).output().into_diagnostic()?;
    if !listed.status.success() {
        let message = String::from_utf8_lossy(&listed.stderr);
        return Err(miette!("cargo mutants fails: {message}"));
    }
    let text = String::from_utf8(listed.stdout).into_diagnostic()?;
    Ok(text.lines().map(str::to_owned).collect())
}

fn record(
    arguments: &Arguments,
    possible: usize,
    drawn: &[String],
    outcomes: Outcomes,
) -> Result<Record> {
    let mut record = Record {
        seed: arguments.seed,
        possible,
        tool: format!("cargo-mutants {}", outcomes.cargo_mutants_version),
        files: Default::default(),
        survivors: Vec::new(),
    };
    for outcome in outcomes.outcomes {
        let Scenario::Mutant { name } = outcome.scenario else {
            continue;
        };
        // cargo-mutants 27.1 tests some deleted fields that no expression names
        if !drawn.contains(&name) {
            continue;
        }
        let file = name.split(':').next().unwrap_or(&name).to_owned();
        let counts: &mut Counts = record.files.entry(file).or_default();
        match outcome.summary {
            Summary::CaughtMutant => counts.caught += 1,
            Summary::Timeout => counts.timeout += 1,
            Summary::Unviable => counts.unviable += 1,
            Summary::MissedMutant => {
                counts.survived += 1;
                record.survivors.push(name);
            }
            Summary::Success | Summary::Failure => {
                return Err(miette!("cargo-mutants has no verdict on {name}"));
            }
        }
    }
    record.survivors.sort();
    Ok(record)
}
