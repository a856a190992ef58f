//! Mutation testing: draws mutants by a fixed seed and has cargo-mutants try them, each with the tests of its scope.
//!
//! The draw is tried in parts. A run that was interrupted goes on with the first part that is not finished, as long as no
//! source has changed. Survivors that better tests should catch are tried alone with `--again`.
//! `cargo run --release -p ladder -- --from target/ladder` then brings the page up to date.

use clap::Parser;
use ladder::mutants::{MutantCounts, MutationRecord, Scope, reasons};
use ladder::seeded::WorkspaceCopy;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use records::{Digests, RunningCampaign, digests, root};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Mutants a part.
const PART: usize = 25;
/// Seconds after which tests of a mutant count as endless; all tests take some two minutes.
const TIMEOUT: &str = "--timeout=400";

#[derive(Parser)]
#[command(about = "Draws mutants and records which of them the tests notice")]
struct Arguments {
    /// What the mutants are drawn from.
    scope: Scope,
    /// Seed of the draw.
    #[arg(long, default_value_t = 4)]
    seed: u64,
    /// How many mutants are drawn; the scope has its own number.
    #[arg(long)]
    count: Option<usize>,
    /// Tries only the survivors of the last record that have no reason in `survivors.toml`.
    #[arg(long)]
    again: bool,
}

/// What has a verdict so far.
#[derive(Serialize, Deserialize)]
struct MutationProgress {
    /// Of what the record depends on, when the draw was made.
    sources: Digests,
    drawn: Vec<String>,
    done: usize,
    record: MutationRecord,
}

/// `outcomes.json` of cargo-mutants, as far as it is read here.
#[derive(Deserialize)]
struct Outcomes {
    outcomes: Vec<MutantOutcome>,
    cargo_mutants_version: String,
}

#[derive(Deserialize)]
struct MutantOutcome {
    scenario: Scenario,
    summary: MutantSummary,
}

#[derive(Deserialize)]
enum Scenario {
    Baseline,
    Mutant { name: String },
}

#[derive(Deserialize)]
enum MutantSummary {
    Success,
    CaughtMutant,
    MissedMutant,
    Timeout,
    Unviable,
    Failure,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let scope = arguments.scope;
    // what is only revised keeps the digests of the run that it revises
    let campaign = match arguments.again {
        true => None,
        false => Some(RunningCampaign::begin(scope.name())?),
    };
    let copy = WorkspaceCopy::new("mutation")?;
    let all = list(scope, &copy.tree())?;
    let before = arguments
        .again
        .then(|| MutationRecord::read(scope))
        .transpose()?;
    let drawn = match &before {
        Some(before) => {
            let reasons = reasons()?;
            let mut survivors = before.survivors.clone();
            survivors.retain(|name| !reasons.contains_key(name));
            survivors
        }
        None => {
            let mut drawn = all.clone();
            drawn.shuffle(&mut ChaCha8Rng::seed_from_u64(arguments.seed));
            drawn.truncate(arguments.count.unwrap_or(scope.count()));
            drawn
        }
    };
    if let Some(gone) = drawn.iter().find(|name| !all.contains(name)) {
        return Err(miette!("{gone} is of another version of the code"));
    }
    let fresh = MutationProgress {
        sources: digests(&root(), scope.name())?,
        drawn,
        done: 0,
        record: MutationRecord {
            seed: arguments.seed,
            possible: all.len(),
            tool: String::new(),
            files: Default::default(),
            survivors: Vec::new(),
        },
    };
    let tried = fresh.drawn.clone();
    let record = complete(scope, &copy, fresh)?;
    let record = match before {
        Some(before) => before.revised(&tried, record),
        None => record,
    };
    let text = serde_json::to_string_pretty(&record).into_diagnostic()?;
    fs::write(scope.path(), text + "\n").into_diagnostic()?;
    if let Some(campaign) = campaign {
        campaign.finish()?;
    }
    let total = record.total();
    println!("{:.1} % caught of {total:?}", 100.0 * record.caught());
    Ok(())
}

/// Tries the mutants part by part, after those that an interrupted run has tried.
fn complete(scope: Scope, copy: &WorkspaceCopy, fresh: MutationProgress) -> Result<MutationRecord> {
    let path = root().join(format!("target/{}-progress.json", scope.name()));
    let kept = fs::read_to_string(&path).ok();
    let kept = kept.and_then(|text| serde_json::from_str::<MutationProgress>(&text).ok());
    let same = |kept: &MutationProgress| kept.sources == fresh.sources && kept.drawn == fresh.drawn;
    let mut progress = kept.filter(same).unwrap_or(fresh);
    while progress.done < progress.drawn.len() {
        let end = progress.drawn.len().min(progress.done + PART);
        let outcomes = test(scope, copy, &progress.drawn[progress.done..end])?;
        count(
            &mut progress.record,
            &progress.drawn[progress.done..end],
            outcomes,
        )?;
        progress.done = end;
        let total = progress.record.total();
        if total.viable() + total.unviable != end {
            return Err(miette!(
                "{end} mutants were tried, {total:?} have a verdict"
            ));
        }
        let text = serde_json::to_string(&progress).into_diagnostic()?;
        fs::write(&path, text).into_diagnostic()?;
        println!("{end} of {}: {total:?}", progress.drawn.len());
    }
    fs::remove_file(&path).into_diagnostic()?;
    Ok(progress.record)
}

/// Has cargo-mutants try these mutants in the copy.
fn test(scope: Scope, copy: &WorkspaceCopy, drawn: &[String]) -> Result<Outcomes> {
    let output = root().join("target/mutation");
    let mut command = Command::new("cargo");
    command.arg("mutants").current_dir(copy.tree());
    command.args(scope.files()).args(["--in-place", TIMEOUT]);
    command.args(["--profile=mutants", "--test-tool=nextest"]);
    command.env("NEXTEST_PROFILE", "mutants");
    command.env("CARGO_TARGET_DIR", output.join("build"));
    // what is caught is caught by fresh cases, and leaves none behind
    command.env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1");
    command.arg("--output").arg(&output);
    for name in drawn {
        let exactly = format!("^{}$", regex::escape(name));
        command.arg("--re").arg(exactly);
    }
    // for the build as well as for the run
    command.args(scope.tests());
    // its exit code says whether there are survivors; what became of each mutant stands in its file
    let started = command.status().into_diagnostic();
    started.wrap_err("cargo-mutants cannot be started")?;
    let path = output.join("mutants.out/outcomes.json");
    let text = fs::read_to_string(&path).into_diagnostic();
    let text = text.wrap_err_with(|| format!("cannot read {}", path.display()))?;
    serde_json::from_str(&text).into_diagnostic()
}

/// Names of all mutants of a scope.
fn list(scope: Scope, tree: &Path) -> Result<Vec<String>> {
    let mut command = Command::new("cargo");
    command.args(["mutants", "--list"]).args(scope.files());
    let listed = command.current_dir(tree).output().into_diagnostic()?;
    if !listed.status.success() {
        let message = String::from_utf8_lossy(&listed.stderr);
        return Err(miette!("cargo mutants fails: {message}"));
    }
    let text = String::from_utf8(listed.stdout).into_diagnostic()?;
    Ok(text.lines().map(str::to_owned).collect())
}

/// Adds the verdicts on the mutants that were drawn.
fn count(record: &mut MutationRecord, drawn: &[String], outcomes: Outcomes) -> Result<()> {
    record.tool = format!("cargo-mutants {}", outcomes.cargo_mutants_version);
    for outcome in outcomes.outcomes {
        let Scenario::Mutant { name } = outcome.scenario else {
            continue;
        };
        // cargo-mutants 27.1 tests some deleted fields that no expression names
        if !drawn.contains(&name) {
            continue;
        }
        let file = name.split(':').next().unwrap_or(&name).to_owned();
        let counts: &mut MutantCounts = record.files.entry(file).or_default();
        match outcome.summary {
            MutantSummary::CaughtMutant => counts.caught += 1,
            MutantSummary::Timeout => counts.timeout += 1,
            MutantSummary::Unviable => counts.unviable += 1,
            MutantSummary::MissedMutant => {
                counts.survived += 1;
                record.survivors.push(name);
            }
            MutantSummary::Success | MutantSummary::Failure => {
                return Err(miette!("cargo-mutants has no verdict on {name}"));
            }
        }
    }
    record.survivors.sort();
    Ok(())
}
