//! What a variant does and what it costs.
//!
//! Physics is measured at the rows of the output interval, forces of joints with clearance at every step, and repeats to the last
//! bit. Processor time does not: it is taken of runs that record nothing, as the median of several.

use super::variants::{Variant, VariantRole};
use crate::machine::RunTiming;
use cpu_time::ThreadTime;
use looselink::body::Known;
use looselink::document::did_you_mean;
use looselink::scene::{ChannelPattern, Scene};
use looselink::simulate::{Recording, Simulation};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// Timed runs of a variant, unless the user says how many.
const RUNS: usize = 5;
/// No run is begun when those before it took this much processor time \[s\].
const ENOUGH: f64 = 1.0;

/// The body whose motion is compared.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Observed {
    /// The name the user wrote.
    pub name: String,
    /// What its displacement error is taken from.
    pub error_from: Origin,
}

/// What a displacement error is taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The path that the drive prescribes for the body.
    Prescribed,
    /// The path of the same body in the rigid ideal mechanism.
    Ideal,
}

impl Origin {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Origin::Prescribed => "its prescribed path",
            Origin::Ideal => "its path in the rigid ideal mechanism",
        }
    }
}

impl Serialize for Origin {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A body that cannot be observed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CannotObserve {
    /// No body that moves has the name.
    #[error(
        "no body that moves is called `{name}`; there are {}{}",
        moving.join(", "),
        did_you_mean(name, moving.iter().map(String::as_str))
    )]
    Unknown {
        /// The name asked for.
        name: String,
        /// Names of the bodies that move.
        moving: Vec<String>,
    },
    /// The scene has the ground alone.
    #[error("the scene has no body that moves")]
    NothingMoves,
}

impl Observed {
    /// The body of this name; without one the driven body, or else the last link or rigid body, or else the last body.
    ///
    /// # Errors
    /// There is no such body, or it does not move.
    pub fn choose(scene: &Scene, name: Option<&str>) -> Result<Observed, CannotObserve> {
        let moves = |b: &usize| !matches!(scene.bodies[*b].kind.known(), Some(Known::Fixed));
        let extended = |b: &usize| {
            let kind = &scene.bodies[*b].kind;
            kind.known().is_none() && kind.turns()
        };
        let mut moving = (0..scene.bodies.len()).filter(moves);
        let name_of = |b: usize| scene.bodies[b].name.clone();
        let driven = scene.drives.first().map(|drive| drive.body);
        let body = match name {
            Some(name) => {
                let found = moving.clone().find(|b| scene.bodies[*b].name == name);
                found.ok_or_else(|| CannotObserve::Unknown {
                    name: name.to_owned(),
                    moving: moving.map(name_of).collect(),
                })?
            }
            None => driven
                .or_else(|| moving.clone().rfind(extended))
                .or_else(|| moving.next_back())
                .ok_or(CannotObserve::NothingMoves)?,
        };
        Ok(Observed {
            name: name_of(body),
            error_from: match driven == Some(body) {
                true => Origin::Prescribed,
                false => Origin::Ideal,
            },
        })
    }
}

/// What a variant does, over the recorded rows; a quantity that the variant does not have is absent.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Physics {
    /// Root mean square of the displacement error of the observed body \[m\].
    pub rms_error: Option<f64>,
    /// Largest displacement error of the observed body \[m\].
    pub largest_error: Option<f64>,
    /// Root mean square of the acceleration of the observed body \[m/s2\].
    pub rms_acceleration: Option<f64>,
    /// Largest acceleration of the observed body \[m/s2\].
    pub peak_acceleration: Option<f64>,
    /// Largest force in any joint \[N\].
    pub peak_joint_force: Option<f64>,
    /// Part of the rows in contact, mean over the loose joints.
    pub contact_fraction: Option<f64>,
}

/// A quantity: name, unit, how to take it.
pub type PhysicsQuantity = (&'static str, &'static str, fn(&Physics) -> Option<f64>);

impl Physics {
    /// What is measured, its unit, its value.
    pub const QUANTITIES: [PhysicsQuantity; 6] = [
        ("rms error", "m", |p| p.rms_error),
        ("largest error", "m", |p| p.largest_error),
        ("rms acceleration", "m/s²", |p| p.rms_acceleration),
        ("peak acceleration", "m/s²", |p| p.peak_acceleration),
        ("peak joint force", "N", |p| p.peak_joint_force),
        ("contact fraction", "", |p| p.contact_fraction),
    ];

    /// The values in the order of [`Physics::QUANTITIES`].
    pub fn values(&self) -> [Option<f64>; 6] {
        Physics::QUANTITIES.map(|(_, _, value)| value(self))
    }

    /// The difference of every quantity that both have.
    pub fn less(&self, other: &Physics) -> Physics {
        let less = |value: fn(&Physics) -> Option<f64>| Some(value(self)? - value(other)?);
        Physics {
            rms_error: less(|p| p.rms_error),
            largest_error: less(|p| p.largest_error),
            rms_acceleration: less(|p| p.rms_acceleration),
            peak_acceleration: less(|p| p.peak_acceleration),
            peak_joint_force: less(|p| p.peak_joint_force),
            contact_fraction: less(|p| p.contact_fraction),
        }
    }
}

/// Sizes of a variant and the work of its run, which repeat.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct VariantCounts {
    /// Unknown coordinates.
    pub unknowns: usize,
    /// Multipliers.
    pub multipliers: usize,
    /// Contact terms.
    pub contacts: usize,
    /// Accepted steps.
    pub steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Evaluations of the terms of every kind.
    pub evaluations: BTreeMap<String, u64>,
}

/// Processor time of a variant.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cost {
    /// Timed runs, after one that is not.
    pub runs: usize,
    /// Processor time of each of them, compilation left out \[s\].
    pub seconds: Vec<f64>,
    /// Their median; of a single run its time \[s\].
    pub cpu_seconds: f64,
    /// Processor time of a step \[µs\].
    pub microseconds_a_step: f64,
    /// Processor time of a simulated second \[s\].
    pub cpu_seconds_a_simulated_second: f64,
    /// Simulated time over processor time.
    pub real_time_factor: f64,
}

/// Where a body is, row by row: x and y \[m\].
pub(super) type RecordedPath = [Vec<f64>; 2];

/// A variant that has run.
pub(super) struct VariantRun {
    pub rows: usize,
    pub physics: Physics,
    pub peak_joint: Option<String>,
    pub counts: VariantCounts,
    pub warnings: Vec<String>,
    pub path: RecordedPath,
}

/// Runs a variant and measures what it does. `ideal` is the path of the body in the rigid ideal mechanism, where that has run.
pub(super) fn run(
    variant: &Variant,
    body: &Observed,
    ideal: Option<&RecordedPath>,
) -> Result<VariantRun, String> {
    let scene = variant.scene.as_ref();
    let scene = scene.map_err(|error| format!("not possible: {error}"))?;
    let mut simulation = simulation(scene, &["*"])?;
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    ended.map_err(|error| format!("cannot go on: {error}"))?;
    let channel = |name: String| recording.get(&name).unwrap_or_default();
    let of_body = |quantity: &str| channel(format!("{}.{quantity}", body.name));
    let path = ["x", "y"].map(|name| of_body(name).to_vec());
    let errors = match (body.error_from, variant.role) {
        (Origin::Prescribed, _) => {
            let [x, y] = ["error.x", "error.y"].map(|name| channel(name.to_owned()));
            Some(lengths(x, y))
        }
        (Origin::Ideal, VariantRole::Ideal) => Some(distances(&path, &path)),
        (Origin::Ideal, _) => ideal.map(|ideal| distances(&path, ideal)),
    };
    let accelerations = lengths(of_body("ax"), of_body("ay"));
    let shape = simulation.model().shape();
    let names = scene
        .joints
        .iter()
        .map(|joint| format!("{}.contact", joint.name));
    let contacts: Vec<f64> = names
        .filter_map(|name| Some(mean(recording.get(&name)?)))
        .collect();
    let report = simulation.report();
    // rows miss the peaks of short contacts, the closing table does not
    let forces = report.closing.forces.iter();
    let peak = forces.max_by(|(_, a), (_, b)| a.largest.total_cmp(&b.largest));
    Ok(VariantRun {
        rows: recording.rows(),
        physics: Physics {
            rms_error: errors.as_deref().map(rms),
            largest_error: errors.as_deref().map(largest),
            rms_acceleration: Some(rms(&accelerations)),
            peak_acceleration: Some(largest(&accelerations)),
            peak_joint_force: peak.map(|(_, force)| force.largest),
            contact_fraction: (!contacts.is_empty()).then(|| mean(&contacts)),
        },
        peak_joint: peak
            .filter(|(_, force)| force.largest > 0.0)
            .map(|(name, _)| name.clone()),
        warnings: report.warnings(),
        counts: VariantCounts {
            unknowns: shape.unknowns,
            multipliers: shape.multipliers,
            contacts: shape.contacts,
            steps: report.steps,
            newton_iterations: report.newton_iterations,
            evaluations: report.effects,
        },
        path,
    })
}

/// Times scenes that have run before, `runs` times or as often as seems worth it, and gives the processor times of each
/// \[s\]. The scenes take turns, so that what disturbs the machine for a while disturbs all of them.
///
/// # Panics
/// When a scene does not run to its end.
pub(super) fn time(scenes: &[&Scene], runs: Option<usize>) -> Vec<Vec<f64>> {
    let mut seconds: Vec<Vec<f64>> = vec![Vec::new(); scenes.len()];
    let enough = |seconds: &[f64]| match runs {
        Some(runs) => seconds.len() >= runs,
        None => seconds.len() >= RUNS || seconds.iter().sum::<f64>() >= ENOUGH,
    };
    while seconds.iter().any(|s| !enough(s)) {
        for (scene, seconds) in scenes.iter().zip(&mut seconds) {
            if enough(seconds) {
                continue;
            }
            let again = "a run that is repeated ends as before";
            let mut simulation = simulation(scene, &[]).expect(again);
            let started = ThreadTime::now();
            simulation.run(&mut ()).expect(again);
            seconds.push(started.elapsed().as_secs_f64());
        }
    }
    seconds
}

impl Cost {
    /// The cost of a run over `simulated` \[s\] in so many steps, from the processor times of several \[s\].
    pub(super) fn new(seconds: Vec<f64>, steps: u64, simulated: f64) -> Cost {
        let timing = RunTiming::of(seconds);
        let cpu_seconds = timing.median;
        Cost {
            runs: timing.seconds.len(),
            seconds: timing.seconds,
            cpu_seconds,
            microseconds_a_step: 1e6 * cpu_seconds / steps as f64,
            cpu_seconds_a_simulated_second: cpu_seconds / simulated,
            real_time_factor: simulated / cpu_seconds,
        }
    }
}

/// The scene with these channels, ready to run.
fn simulation(scene: &Scene, channels: &[&str]) -> Result<Simulation, String> {
    let mut scene = scene.clone();
    let patterns = channels.iter().map(|pattern| ChannelPattern {
        pattern: (*pattern).to_owned(),
        span: scene.initial.span,
    });
    scene.output.channels = patterns.collect();
    Simulation::new(&scene).map_err(|error| format!("not possible: {error}"))
}

fn distances([x, y]: &RecordedPath, [x0, y0]: &RecordedPath) -> Vec<f64> {
    let less = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
    lengths(&less(x, x0), &less(y, y0))
}

fn lengths(x: &[f64], y: &[f64]) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn rms(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values.iter().map(|v| v * v).collect();
    mean(&squares).sqrt()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
