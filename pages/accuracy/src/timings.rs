//! The raw times behind the page.

use crate::{MadeStudy, Surveyed};
use accuracy::settings::SettingsSweep;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Serialize;
use std::path::Path;
use studies::ablation::{Ablation, AblationTiming};
use studies::machine::{Machine, machine};
use studies::precision::Time;

#[derive(Serialize)]
struct StudyTimings<'a> {
    machine: Machine,
    studies: Vec<StudyTimes<'a>>,
    ablation: AblationTiming,
}

#[derive(Serialize)]
struct StudyTimes<'a> {
    study: &'a str,
    runs: Vec<Time<'a>>,
    /// How the settings of IDA were found.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    ida: &'a [SettingsSweep],
}

/// Writes the processor time of every timed run.
///
/// # Errors
/// When the file cannot be written.
pub fn write(
    path: &Path,
    made: &[MadeStudy],
    surveyed: &[Surveyed],
    ablation: &Ablation,
) -> Result<()> {
    let made = made.iter().map(|one| StudyTimes {
        study: &one.name,
        runs: one.outcome.times(),
        ida: &one.ida,
    });
    let surveyed = surveyed.iter().map(|one| StudyTimes {
        study: &one.name,
        runs: one.survey.times(),
        ida: &[],
    });
    let timings = StudyTimings {
        machine: machine(),
        studies: made.chain(surveyed).collect(),
        ablation: ablation.timing(),
    };
    let text = serde_json::to_string_pretty(&timings).into_diagnostic()?;
    std::fs::write(path, text + "\n")
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}
