//! One run: what it reported, and how it ended.

use looselink::scene::{Scene, SceneError};
use looselink::simulate::{Control, Observer, Progress, Report, RunError, Simulation};
use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Accepted steps over those asked for at which a run is cut short.
const MOST_STEPS_A_STEP: u64 = 30;
/// Accepted steps at which a run that chooses its steps is cut short.
const MOST_CHOSEN_STEPS: u64 = 20_000;

/// How a run ended.
#[derive(Debug, Clone, PartialEq)]
pub enum RunOutcome {
    /// At the end of the scene, with nothing to remark.
    Finished,
    /// At the end of the scene, with counts in the report that say what was hard.
    Remarked(Vec<&'static str>),
    /// With an error that names what the user wrote, the time and the cause.
    Stopped(String),
    /// Before it began, with a fault at a place of the text.
    Refused(String),
    /// At the most steps that a run is given here; the report says what it needed them for.
    CutShort,
}

impl RunOutcome {
    /// Its class in tallies.
    pub fn class(&self) -> &'static str {
        match self {
            RunOutcome::Finished => "finished",
            RunOutcome::Remarked(_) => "finished with a remark",
            RunOutcome::Stopped(_) => "stopped with an error",
            RunOutcome::Refused(_) => "refused",
            RunOutcome::CutShort => "cut short",
        }
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

impl Breach {
    /// A breach of a property.
    pub fn new(property: &'static str, detail: impl Into<String>) -> Breach {
        Breach {
            property,
            detail: detail.into(),
        }
    }
}

/// Rows of a run, by channel.
#[derive(Debug, Default, Clone)]
pub struct ChannelRows {
    names: HashMap<String, usize>,
    width: usize,
    values: Vec<f64>,
}

impl ChannelRows {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    /// True without a row.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Whether there is such a channel.
    pub fn has(&self, name: &str) -> bool {
        self.names.contains_key(name)
    }

    /// A value of a channel; of the ground, which has none, zero.
    pub fn get(&self, name: &str, row: usize) -> f64 {
        let column = self.names.get(name);
        column.map_or(0.0, |c| self.values[row * self.width + c])
    }

    /// All numbers as bits, row by row.
    pub fn bits(&self) -> Vec<u64> {
        self.values.iter().map(|x| x.to_bits()).collect()
    }

    fn first_not_finite(&self) -> Option<(usize, &str)> {
        let at = self.values.iter().position(|x| !x.is_finite())?;
        let (row, column) = (at / self.width, at % self.width);
        let name = self.names.iter().find(|(_, c)| **c == column);
        Some((row, name.map_or("", |(n, _)| n.as_str())))
    }
}

/// A run.
#[derive(Debug)]
pub struct RandomRun {
    /// The scene, where it could be read.
    pub scene: Option<Scene>,
    /// What it reported.
    pub rows: ChannelRows,
    /// How it ended.
    pub outcome: RunOutcome,
    /// Its report, where it began.
    pub report: Option<Report>,
    /// Largest opening of a constraint at the end \[m\], its rate, and its name.
    pub open: Option<(f64, f64, String)>,
    /// Largest coordinate at the end.
    pub reach: f64,
}

impl RandomRun {
    /// True of an explicit scheme whose step is too long: it has gained more energy than there was.
    pub fn blown_up(&self) -> bool {
        let explicit = self
            .scene
            .as_ref()
            .is_some_and(|s| s.integrator.method.scheme.is_explicit);
        explicit && self.report.as_ref().is_some_and(blown_up)
    }
}

/// Keeps the rows of a run, and stops one that takes too many steps or too long.
struct LimitedRows {
    rows: ChannelRows,
    steps: u64,
    most: u64,
    deadline: Option<Instant>,
    late: bool,
}

impl Observer for LimitedRows {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.rows.values.extend_from_slice(values);
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> io::Result<Control> {
        self.steps += 1;
        self.late = self.deadline.is_some_and(|d| Instant::now() > d);
        Ok(match self.steps > self.most || self.late {
            true => Control::Stop,
            false => Control::Continue,
        })
    }
}

/// Runs a scene; `guard` is the longest that it may take.
///
/// # Errors
/// A panic, a hang, a row with what is not a number, an error that does not say enough.
pub fn run(text: &str, overrides: &[String], guard: Option<Duration>) -> Result<RandomRun, Breach> {
    let caught = catch_unwind(AssertUnwindSafe(|| unguarded(text, overrides, guard)));
    caught.unwrap_or_else(|cause| {
        let cause = cause
            .downcast_ref::<String>()
            .cloned()
            .or_else(|| cause.downcast_ref::<&str>().map(|s| (*s).to_owned()));
        Err(Breach::new("no panic", cause.unwrap_or_default()))
    })
}

fn unguarded(
    text: &str,
    overrides: &[String],
    guard: Option<Duration>,
) -> Result<RandomRun, Breach> {
    let mut run = RandomRun {
        scene: None,
        rows: ChannelRows::default(),
        outcome: RunOutcome::Finished,
        report: None,
        open: None,
        reach: 0.0,
    };
    let scene = match Scene::parse("random.toml", text, overrides) {
        Ok(scene) => scene,
        Err(error) => {
            run.outcome = refused(&error)?;
            return Ok(run);
        }
    };
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(error) => {
            run.outcome = refused(&error)?;
            run.scene = Some(scene);
            return Ok(run);
        }
    };
    let channels = simulation.channels().iter().enumerate();
    let step = scene.integrator.step();
    let asked = step.map(|h| (scene.simulation.duration / h).ceil() as u64);
    let mut limited = LimitedRows {
        rows: ChannelRows {
            names: channels.map(|(i, c)| (c.name.clone(), i)).collect(),
            width: simulation.channels().len(),
            values: Vec::new(),
        },
        steps: 0,
        most: asked.map_or(MOST_CHOSEN_STEPS, |n| MOST_STEPS_A_STEP * n.max(10)),
        deadline: guard.map(|g| Instant::now() + g),
        late: false,
    };
    let ended = simulation.run(&mut limited);
    let report = simulation.report();
    if let Some((row, name)) = limited.rows.first_not_finite() {
        let detail = format!("{name} of row {row} is no number; the run: {ended:?}");
        return Err(Breach::new("finite rows", detail));
    }
    run.outcome = match ended {
        Ok(()) => remarks(&report),
        Err(RunError::Interrupted { t }) if limited.late => {
            let detail = format!("{} steps to t = {t} s, {asked:?} asked for", limited.steps);
            return Err(Breach::new("no hang", detail));
        }
        Err(RunError::Interrupted { .. }) => RunOutcome::CutShort,
        Err(error) => stopped(&scene, &error)?,
    };
    run.open = simulation.model().worst_constraint(simulation.state());
    let stages = match scene.integrator.method.name() {
        "esdirk3" => 3,
        "esdirk5" => 6,
        _ => 2,
    };
    bounded(&report, asked, stages)?;
    let coordinates = simulation.state().q.iter();
    run.reach = coordinates.fold(0.0, |m, q| m.max(q.abs()));
    run.rows = limited.rows;
    run.report = Some(report);
    run.scene = Some(scene);
    Ok(run)
}

/// A fault must have a place and underline something.
fn refused(error: &SceneError) -> Result<RunOutcome, Breach> {
    match error.place() {
        Some((_, line, column)) if line > 0 && column > 0 && !error.underlined().is_empty() => {
            Ok(RunOutcome::Refused(error.to_string()))
        }
        _ => Err(Breach::new("faults have a place", error.to_string())),
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
    let in_energy = text.contains("the energy balance");
    let named = in_energy || names.any(|n| text.contains(n.as_str()));
    let begun = !matches!(error, RunError::Unaffordable { .. });
    match named && (!begun || text.contains("t = ")) {
        true => Ok(RunOutcome::Stopped(text)),
        false => Err(Breach::new("errors say what, when and why", text)),
    }
}

/// A scheme that has gained more energy than there was at the start is unstable at its step; the ledger says so.
fn blown_up(report: &Report) -> bool {
    let ledger = report.ledger.as_ref();
    ledger.is_some_and(|l| {
        -l.numerical > 0.5 * l.stored.kinetic && l.stored.kinetic > l.initial.abs() + l.work.abs()
    })
}

fn remarks(report: &Report) -> RunOutcome {
    let counts = [
        ("energy gained without bounds", u64::from(blown_up(report))),
        ("stagnations", report.stagnations),
        ("stages on the position level", report.position_level_stages),
        ("singular poses", report.singular_poses),
        ("row exchanges", report.fallbacks),
        ("halved steps", report.rejected_steps),
        ("contacts not located", report.unlocated_changes),
    ];
    let found: Vec<_> = counts
        .iter()
        .filter(|(_, n)| *n > 0)
        .map(|(n, _)| *n)
        .collect();
    match found.is_empty() {
        true => RunOutcome::Finished,
        false => RunOutcome::Remarked(found),
    }
}

/// Every step has a reason that is counted, and at most `stages` stages: a step of the grid, one that ends where a contact changes (an
/// onset and the loss after it, after each of which the grid begins again), one that was halved, or
/// one that was tried with another length to pass a singular pose.
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
        false => Err(Breach::new(
            "work has a reason",
            format!(
                "{} steps and {} stages, {asked:?} steps asked for; {} onsets, {} changes not located, {} steps halved, {} \
                 trials",
                report.steps,
                report.stages,
                report.onsets,
                report.unlocated_changes,
                report.rejected_steps,
                trials
            ),
        )),
    }
}
