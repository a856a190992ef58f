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
pub enum Outcome {
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

impl Outcome {
    /// All, from good to bad.
    pub const ALL: [Outcome; 6] = [
        Outcome::Accurate,
        Outcome::Coarse,
        Outcome::Damped,
        Outcome::Refused,
        Outcome::Failed,
        Outcome::Silent,
    ];

    /// Its name on the page.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Accurate => "accurate",
            Outcome::Coarse => "coarse",
            Outcome::Damped => "damped",
            Outcome::Refused => "refused",
            Outcome::Failed => "failed",
            Outcome::Silent => "silent",
        }
    }

    /// Its colour.
    pub fn color(self) -> Color {
        match self {
            Outcome::Accurate => palette::GREEN,
            Outcome::Coarse => palette::SKY,
            Outcome::Damped => palette::BLUE,
            Outcome::Refused => palette::GREY,
            Outcome::Failed => palette::VERMILION,
            Outcome::Silent => palette::BLACK,
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
pub fn judge(error: f64, tolerance: f64, unsaid: f64, report: &Report) -> Outcome {
    if error <= tolerance {
        return Outcome::Accurate;
    }
    if report.warnings().is_empty() && error > unsaid {
        return Outcome::Silent;
    }
    match changes(report) {
        [gained, lost] if gained > FAILED && gained >= lost => Outcome::Failed,
        [_, lost] if lost > NOTABLE => Outcome::Damped,
        _ => Outcome::Coarse,
    }
}

/// What a run that stopped is called.
pub fn judge_stop(stopped: &Stopped) -> Outcome {
    match stopped {
        Stopped::Refused(_, gained) if *gained > FAILED => Outcome::Failed,
        Stopped::Refused(..) => Outcome::Refused,
        Stopped::Endless(_) => Outcome::Silent,
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
