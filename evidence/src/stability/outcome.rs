//! What becomes of a run of a hard case, and what it is called.

use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, RunError, Simulation};
use serde::{Deserialize, Serialize};

/// A run may take this many times the steps that its duration and step ask for.
const PATIENCE: f64 = 100.0;
/// Steps that a run may take whose accuracy chooses them.
const CHOSEN_STEPS: f64 = 1e6;
/// Energy lost by the integrator beyond this part of the energy in play has a name ...
const NOTABLE: f64 = 0.01;
/// ... and energy gained beyond this part: then the motion lives on it.
const FAILED: f64 = 0.5;

/// How a run of a hard case ends; in records its first letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum OutcomeClass {
    /// Within the tolerance of the map.
    #[serde(rename = "A")]
    Accurate,
    /// Off by more, by less than the range of the channels, and said so where that is much; the energy is kept.
    #[serde(rename = "C")]
    Coarse,
    /// As coarse, but energy is lost.
    #[serde(rename = "D")]
    Damped,
    /// Refused, or stopped with an error that names what and when.
    #[serde(rename = "R")]
    Refused,
    /// Off by more than the range of the channels, or the scheme puts energy into the motion; the report says so.
    #[serde(rename = "F")]
    Failed,
    /// Far off without a warning of an error, or a run that does not end: a fault of the program.
    #[serde(rename = "S")]
    Silent,
}

impl OutcomeClass {
    /// All, from good to bad.
    pub const ALL: [OutcomeClass; 6] = {
        use OutcomeClass::*;
        [Accurate, Coarse, Damped, Refused, Failed, Silent]
    };

    /// Its name on the page.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// Why a run has no rows to look at.
#[derive(Debug, thiserror::Error)]
pub enum Stopped {
    /// The program said why, when the integrator had gained this part of the energy.
    #[error("{0}")]
    Refused(String, f64),
    /// It was stopped from outside, because it would not end.
    #[error("no end after {0} steps")]
    Endless(u64),
}

/// Runs a scene to its end.
///
/// # Errors
/// What stopped it.
pub fn record(scene: &Scene) -> Result<(Recording, Report), Stopped> {
    let mut simulation =
        Simulation::new(scene).map_err(|e| Stopped::Refused(e.to_string(), 0.0))?;
    let steps = match scene.integrator.step() {
        Some(step) => PATIENCE * (scene.simulation.duration / step).max(1000.0),
        None => CHOSEN_STEPS,
    };
    let mut recording = Recording::new(&simulation);
    recording.most_steps = steps as u64;
    match simulation.run(&mut recording) {
        Ok(()) => Ok((recording, simulation.report())),
        Err(RunError::Interrupted { .. }) => Err(Stopped::Endless(recording.most_steps)),
        Err(error) => Err(Stopped::Refused(
            error.to_string(),
            changes(&simulation.report())[0],
        )),
    }
}

/// What a run that reached its end is called by its largest error; one beyond the part `unsaid` of the range of the channels
/// needs a warning of an error.
pub fn judge(error: f64, tolerance: f64, range: f64, unsaid: f64, report: &Report) -> OutcomeClass {
    if error <= tolerance {
        return OutcomeClass::Accurate;
    }
    if report.error_warnings().is_empty() && is_beyond(error, unsaid * range) {
        return OutcomeClass::Silent;
    }
    match changes(report) {
        _ if is_beyond(error, range) => OutcomeClass::Failed,
        [gained, lost] if gained > FAILED && gained >= lost => OutcomeClass::Failed,
        [_, lost] if lost > NOTABLE => OutcomeClass::Damped,
        _ => OutcomeClass::Coarse,
    }
}

/// An error that is not a number is beyond every bound.
pub fn is_beyond(error: f64, bound: f64) -> bool {
    error.is_nan() || error > bound
}

/// What a run that stopped is called.
pub fn judge_stop(stopped: &Stopped) -> OutcomeClass {
    match stopped {
        Stopped::Refused(_, gained) if *gained > FAILED => OutcomeClass::Failed,
        Stopped::Refused(..) => OutcomeClass::Refused,
        Stopped::Endless(_) => OutcomeClass::Silent,
    }
}

/// Energy gained and lost by the integrator over the energy in play.
fn changes(report: &Report) -> [f64; 2] {
    let Some(integration) = &report.integration else {
        return [0.0; 2];
    };
    let [least, greatest] = integration.lost;
    [-least, greatest].map(|change| match integration.turnover > 0.0 {
        true if change.is_finite() => change / integration.turnover,
        true => 1.0,
        false => 0.0,
    })
}

/// A message without what is particular to one run: the words with digits in them.
pub fn gist(text: &str) -> String {
    let plain = |word: &&str| !word.chars().any(|c| c.is_ascii_digit());
    let words = text.split_whitespace().filter(plain);
    words.collect::<Vec<_>>().join(" ")
}

/// Largest magnitude of what is in a list; not a number where one of it is none.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let magnitudes = values.into_iter().map(f64::abs);
    magnitudes.fold(0.0, |m: f64, x| if m.is_nan() || x <= m { m } else { x })
}

/// Least and greatest of a list.
pub fn limits(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let wider = |[low, high]: [f64; 2], x: f64| [x.min(low), x.max(high)];
    let nothing = [f64::INFINITY, f64::NEG_INFINITY];
    values.into_iter().fold(nothing, wider)
}
