//! What becomes of a run of a hard case, and what it is called.

use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, RunError, Simulation};
use plot::{Color, palette};
use serde::Serialize;

/// A run may take this many times the steps that its duration and step ask for.
const PATIENCE: f64 = 100.0;
/// Energy lost by the integrator beyond this part of the energy in play has a name ...
const NOTABLE: f64 = 0.01;
/// ... and energy gained beyond this part: then the motion lives on it.
const FAILED: f64 = 0.5;

/// How a run of a hard case ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OutcomeClass {
    /// Within the tolerance of the map.
    Accurate,
    /// Bounded, off by more, and said so; the energy is kept.
    Coarse,
    /// Bounded, off by more, and said so; energy is lost.
    Damped,
    /// Refused, or stopped with an error that names what and when.
    Refused,
    /// The scheme puts energy into the motion, and the report says so.
    Failed,
    /// A wrong answer without a word, or a run that does not end: a fault of the program.
    Silent,
}

impl OutcomeClass {
    /// All, from good to bad.
    pub const ALL: [OutcomeClass; 6] = [
        OutcomeClass::Accurate,
        OutcomeClass::Coarse,
        OutcomeClass::Damped,
        OutcomeClass::Refused,
        OutcomeClass::Failed,
        OutcomeClass::Silent,
    ];

    /// Its name on the page.
    pub fn name(self) -> &'static str {
        match self {
            OutcomeClass::Accurate => "accurate",
            OutcomeClass::Coarse => "coarse",
            OutcomeClass::Damped => "damped",
            OutcomeClass::Refused => "refused",
            OutcomeClass::Failed => "failed",
            OutcomeClass::Silent => "silent",
        }
    }

    /// Its colour.
    pub fn color(self) -> Color {
        match self {
            OutcomeClass::Accurate => palette::GREEN,
            OutcomeClass::Coarse => palette::SKY,
            OutcomeClass::Damped => palette::BLUE,
            OutcomeClass::Refused => palette::GREY,
            OutcomeClass::Failed => palette::VERMILION,
            OutcomeClass::Silent => palette::BLACK,
        }
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
    let step = scene.integrator.step();
    let asked = step.map_or(1e6, |step| scene.simulation.duration / step);
    let mut recording = Recording::new(&simulation);
    recording.most_steps = (PATIENCE * asked.max(1000.0)) as u64;
    match simulation.run(&mut recording) {
        Ok(()) => Ok((recording, simulation.report())),
        Err(RunError::Interrupted { .. }) => Err(Stopped::Endless(recording.most_steps)),
        Err(error) => Err(Stopped::Refused(
            error.to_string(),
            changes(&simulation.report())[0],
        )),
    }
}

/// What a run that reached its end is called by its largest error; one beyond `unsaid` needs a warning.
pub fn judge(error: f64, tolerance: f64, unsaid: f64, report: &Report) -> OutcomeClass {
    if error <= tolerance {
        return OutcomeClass::Accurate;
    }
    if report.warnings().is_empty() && error > unsaid {
        return OutcomeClass::Silent;
    }
    match changes(report) {
        [gained, lost] if gained > FAILED && gained >= lost => OutcomeClass::Failed,
        [_, lost] if lost > NOTABLE => OutcomeClass::Damped,
        _ => OutcomeClass::Coarse,
    }
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
