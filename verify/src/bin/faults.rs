//! Applies every seeded fault to a copy of the workspace, one at a time, and reports which tests catch it.

use clap::Parser;
use ladder::seeded::{Copy, root};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::Run;
use std::fs;
use verify::faults::{Fault, Outcome, list, outcomes as known};

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
    // some faults run again say nothing of the others
    let run = match arguments.only {
        Some(_) => None,
        None => Some(Run::begin("faults")?),
    };
    let faults = list()?;
    let chosen = |fault: &&Fault| {
        let only = arguments.only.as_ref();
        only.is_none_or(|text| fault.name.contains(text.as_str()))
    };
    let chosen: Vec<&Fault> = faults.iter().filter(chosen).collect();
    let copy = Copy::new("faults")?;
    let sound = tests(&copy, STAGES[0])?;
    if !sound.is_empty() {
        return Err(miette!(
            "without a fault these tests fail: {}",
            sound.join(", ")
        ));
    }
    let mut outcomes = Vec::new();
    for fault in chosen {
        let outcome = seed(&copy, fault)?;
        let caught = match outcome.caught_by.len() {
            0 => "NOT CAUGHT".to_owned(),
            _ => outcome.caught_by.join(", "),
        };
        println!("{:60} {caught}", fault.name);
        outcomes.push(outcome);
    }
    let missed = outcomes.iter().filter(|o| o.caught_by.is_empty()).count();
    keep(&faults, outcomes)?;
    if let Some(run) = run {
        run.finish()?;
    }
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

/// Puts a fault in, asks the tests, takes it out.
fn seed(copy: &Copy, fault: &Fault) -> Result<Outcome> {
    let text = fault.applied(&copy.tree())?;
    let caught_by = copy.with(&fault.file, &text, || {
        let quick = tests(copy, STAGES[0])?;
        if quick.is_empty() {
            tests(copy, STAGES[1])
        } else {
            Ok(quick)
        }
    });
    Ok(Outcome {
        name: fault.name.clone(),
        caught_by: caught_by.wrap_err_with(|| fault.name.clone())?,
    })
}

/// Names of the tests that fail.
fn tests(copy: &Copy, filters: &[&str]) -> Result<Vec<String>> {
    copy.failing(
        &["--release", "-p", "verify", "--test", "agreement"],
        filters,
    )
}
