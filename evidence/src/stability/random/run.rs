//! One run: what it reported, and how it ended.

use looselink::scene::{Scene, SceneError};
use looselink::simulate::{Recording, Report, RunError, Simulation};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Accepted steps over those asked for at which a run is cut short.
const MOST_STEPS_A_STEP: u64 = 30;
/// Accepted steps at which a run that chooses its steps is cut short.
const MOST_CHOSEN_STEPS: u64 = 20_000;

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum RunOutcome {
    /// At the end of the scene, without a warning.
    Finished,
    /// At the end of the scene, with these warnings.
    Remarked(Vec<String>),
    /// With an error that names what the user wrote, the time and the cause.
    Stopped(String),
    /// Before it began, with a fault at a place of the text.
    Refused(String),
    /// At the most steps that a run is given here; the report says what it needed them for.
    CutShort,
}

impl RunOutcome {
    /// Its name in tallies.
    pub fn name(&self) -> &'static str {
        match self {
            RunOutcome::Finished => "finished",
            RunOutcome::Remarked(_) => "finished with a remark",
            RunOutcome::Stopped(_) => "stopped with an error",
            RunOutcome::Refused(_) => "refused",
            RunOutcome::CutShort => "cut short",
        }
    }

    /// Whether the run came to the end of the scene.
    pub fn is_complete(&self) -> bool {
        matches!(self, RunOutcome::Finished | RunOutcome::Remarked(_))
    }
}

/// What must not happen.
#[derive(Debug, Clone, PartialEq)]
pub struct Breach {
    /// Which property does not hold.
    pub property: &'static str,
    /// How.
    pub detail: String,
}

/// A breach of a property.
pub fn breach<T>(property: &'static str, detail: impl Into<String>) -> Result<T, Breach> {
    let detail = detail.into();
    Err(Breach { property, detail })
}

/// A run that has begun.
#[derive(Debug)]
pub struct RandomRun {
    pub scene: Scene,
    /// What it recorded.
    pub rows: Recording,
    /// How it ended.
    pub outcome: RunOutcome,
    pub report: Report,
    /// Largest opening of a constraint at the end \[m\], its rate, and its name.
    pub open: Option<(f64, f64, String)>,
    /// Largest coordinate at the end.
    pub reach: f64,
}

impl RandomRun {
    /// A value of a channel; of the ground, which has none, zero.
    pub fn get(&self, name: &str, row: usize) -> f64 {
        self.rows.get(name).map_or(0.0, |column| column[row])
    }

    /// True of an explicit scheme whose step is too long: it has gained more energy than there was at the start.
    pub fn blown_up(&self) -> bool {
        let ledger = self.report.ledger.as_ref();
        let gained = ledger.is_some_and(|l| {
            let there = l.initial.abs() + l.work.abs();
            -l.numerical > 0.5 * l.stored.kinetic && l.stored.kinetic > there
        });
        self.scene.integrator.method.scheme.is_explicit && gained
    }
}

/// Runs a scene; the message where it is refused. A panic, a row with what is not a number and an error that does not say
/// enough are breaches.
pub fn run(text: &str, overrides: &[String]) -> Result<Result<RandomRun, String>, Breach> {
    let caught = catch_unwind(AssertUnwindSafe(|| unguarded(text, overrides)));
    caught.unwrap_or_else(|cause| {
        let owned = cause.downcast_ref::<String>().cloned();
        let cause = owned.or_else(|| cause.downcast_ref::<&str>().map(|s| (*s).to_owned()));
        breach("no panic", cause.unwrap_or_default())
    })
}

fn unguarded(text: &str, overrides: &[String]) -> Result<Result<RandomRun, String>, Breach> {
    let scene = match Scene::parse("random.toml", text, overrides) {
        Ok(scene) => scene,
        Err(error) => return refused(&error).map(Err),
    };
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(error) => return refused(&error).map(Err),
    };
    let step = scene.integrator.step();
    let asked = step.map(|h| (scene.simulation.duration / h).ceil() as u64);
    let mut rows = Recording::new(&simulation);
    rows.most_steps = asked.map_or(MOST_CHOSEN_STEPS, |n| MOST_STEPS_A_STEP * n.max(10));
    let ended = simulation.run(&mut rows);
    let report = simulation.report();
    for name in rows.names() {
        let column = rows.get(name).unwrap_or(&[]);
        if column.iter().any(|x| !x.is_finite()) {
            return breach("finite rows", format!("{name}; the run: {ended:?}"));
        }
    }
    let outcome = match ended {
        Ok(()) => match [report.warnings(), report.notes()].concat() {
            remarks if remarks.is_empty() => RunOutcome::Finished,
            remarks => RunOutcome::Remarked(remarks),
        },
        Err(RunError::Interrupted { .. }) => RunOutcome::CutShort,
        Err(error) => stopped(&scene, &error)?,
    };
    let stages = match scene.integrator.method.name() {
        "esdirk3" => 3,
        "esdirk5" => 6,
        _ => 2,
    };
    bounded(&report, asked, stages)?;
    let (model, state) = (simulation.model(), simulation.state());
    Ok(Ok(RandomRun {
        open: model.worst_constraint(state),
        reach: state.q.iter().fold(0.0, |m, q| m.max(q.abs())),
        rows,
        outcome,
        report,
        scene,
    }))
}

/// A fault must have a place and underline something.
fn refused(error: &SceneError) -> Result<String, Breach> {
    match error.place() {
        Some((_, line, column)) if line > 0 && column > 0 && !error.underlined().is_empty() => {
            Ok(error.to_string())
        }
        _ => breach("faults have a place", error.to_string()),
    }
}

/// An error must name something of the scene and, where the run had begun, the time.
fn stopped(scene: &Scene, error: &RunError) -> Result<RunOutcome, Breach> {
    let text = error.to_string();
    let bodies = scene.bodies.iter().map(|b| &b.name);
    let joints = scene.joints.iter().map(|j| &j.name);
    let drives = scene.drives.iter().map(|d| &d.name);
    let motions = scene.motions.iter().map(|m| &m.name);
    let mut names = bodies.chain(joints).chain(drives).chain(motions);
    let named = text.contains("the energy balance") || names.any(|n| text.contains(n.as_str()));
    let begun = !matches!(error, RunError::Unaffordable { .. });
    match named && (!begun || text.contains("t = ")) {
        true => Ok(RunOutcome::Stopped(text)),
        false => breach("errors say what, when and why", text),
    }
}

/// Every step has a reason that is counted, and at most `stages` stages: a step of the grid, one that ends where a contact
/// changes (an onset and the loss after it, after each of which the grid begins again), one that was halved, or one that was
/// tried with another length to pass a singular pose.
fn bounded(report: &Report, asked: Option<u64>, stages: u64) -> Result<(), Breach> {
    let repeated = report.accuracy.as_ref().map_or(0, |a| a.rejected_steps);
    let trials = report.location_trials + report.singular_pose_trials;
    let tried = report.steps + report.rejected_steps + trials + repeated;
    // a change may be tried at its end once more
    let stages = stages * (tried + 2 * report.steps);
    let changes = 2 * report.onsets + report.unlocated_changes;
    let cuts = 4 * changes + 2 * (report.rejected_steps + report.location_trials);
    let steps = asked.map(|n| n + cuts + 10);
    match report.stages <= stages && steps.is_none_or(|n| report.steps <= n) {
        true => Ok(()),
        false => breach(
            "work has a reason",
            format!(
                "{} steps and {} stages, {asked:?} steps asked for; {} onsets, {} changes not located, {} steps halved, {trials} \
                 trials",
                report.steps,
                report.stages,
                report.onsets,
                report.unlocated_changes,
                report.rejected_steps
            ),
        ),
    }
}
