//! Applies every seeded fault and every variant to a copy of the workspace, one at a time, and reports which tests fail.

use clap::Parser;
use ladder::faults::{Fault, FaultOutcome, List, list, outcomes as known};
use ladder::seeded::WorkspaceCopy;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::{RunningCampaign, root};
use std::fs;

/// Tests that take seconds, and those that take a minute and are asked only when the first catch nothing.
const STAGES: [&[&str]; 2] = [
    &[
        "parts",
        "every_channel",
        "motion_of_case_1",
        "motion_of_scene_everything",
    ],
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
    let campaign = match arguments.only {
        Some(_) => None,
        None => Some(RunningCampaign::begin("faults")?),
    };
    let list = list()?;
    let chosen = |fault: &&Fault| {
        let only = arguments.only.as_ref();
        only.is_none_or(|text| fault.name.contains(text.as_str()))
    };
    let copy = WorkspaceCopy::new("faults")?;
    let sound = tests(&copy, STAGES[0])?;
    if !sound.is_empty() {
        return Err(miette!(
            "without a fault these tests fail: {}",
            sound.join(", ")
        ));
    }
    let (mut outcomes, mut wrong) = (Vec::new(), 0);
    for fault in list.all().filter(chosen) {
        let outcome = seed(&copy, fault)?;
        let failed = match outcome.caught_by.len() {
            0 => "no test fails".to_owned(),
            _ => outcome.caught_by.join(", "),
        };
        let good = outcome.caught_by.is_empty() == fault.is_variant();
        wrong += usize::from(!good);
        println!(
            "{} {:60} {failed}",
            if good { " " } else { "!" },
            fault.name
        );
        outcomes.push(outcome);
    }
    keep(&list, outcomes)?;
    if let Some(campaign) = campaign {
        campaign.finish()?;
    }
    match wrong {
        0 => Ok(()),
        n => Err(miette!(
            "{n} faults were not caught, or variants change results"
        )),
    }
}

/// Writes the outcomes, those of faults that were not run from the run before.
fn keep(list: &List, fresh: Vec<FaultOutcome>) -> Result<()> {
    let before = known().unwrap_or_default();
    let find = |fault: &Fault| {
        let all = fresh.iter().chain(&before);
        all.into_iter().find(|o| o.name == fault.name)
    };
    let outcomes: Vec<&FaultOutcome> = list.all().filter_map(find).collect();
    let text = serde_json::to_string_pretty(&outcomes).into_diagnostic()?;
    fs::write(root().join("verify/faults.json"), text + "\n").into_diagnostic()
}

/// Puts a fault in, asks the tests, takes it out.
fn seed(copy: &WorkspaceCopy, fault: &Fault) -> Result<FaultOutcome> {
    let text = fault.applied(&copy.tree())?;
    let caught_by = copy.with(&fault.file, &text, || {
        if fault.is_variant() {
            let names: Vec<&str> = fault.tests.iter().map(String::as_str).collect();
            return tests(copy, &names);
        }
        let quick = tests(copy, STAGES[0])?;
        if quick.is_empty() {
            tests(copy, STAGES[1])
        } else {
            Ok(quick)
        }
    });
    Ok(FaultOutcome {
        name: fault.name.clone(),
        caught_by: caught_by.wrap_err_with(|| fault.name.clone())?,
    })
}

/// Names of the tests that fail.
fn tests(copy: &WorkspaceCopy, filters: &[&str]) -> Result<Vec<String>> {
    // many builds, short tests: little optimisation
    let profile = ["--profile", "mutants"];
    let arguments = [&profile[..], &["-p", "verify", "--test", "agreement"]];
    copy.failing(&arguments.concat(), filters)
}
