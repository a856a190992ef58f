//! Whether runs reach the accuracy that they are asked for: every dynamic scene, every method, seven accuracies.
//!
//! The error of a run is the largest difference of a position, over all recorded rows up to the horizon H, from a
//! reference. The reference is a run of Dormand and Prince's method with the tightest accuracy that it reaches within
//! [`REFERENCE_STEPS`]; its floor is its distance from a run ten times looser, and not below the accuracy it was asked for.

use crate::amplification::amplification;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Recording, RunError, Simulation};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::Digests;
use serde::{Deserialize, Serialize};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::thread;

/// Methods, the one of the references first, with what they need beside their name.
pub const METHODS: [(&str, &[&str]); 9] = [
    ("dormand_prince", &[]),
    ("dop853", &[]),
    ("esdirk5", &[]),
    ("bathe", &[]),
    ("trapezoidal", &[]),
    ("generalized_alpha", &["integrator.spectral_radius=0.8"]),
    ("hht", &["integrator.spectral_radius=0.8"]),
    ("backward_euler", &[]),
    ("velocity_verlet", &[]),
];
/// Accuracies asked for \[m\], the loosest first.
pub const ACCURACIES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// Horizon where a joint has clearance \[s\]; elsewhere it is the duration.
pub const LOOSE_HORIZON: f64 = 0.01;
/// Recorded rows of a run.
pub const ROWS: usize = 50;
/// Steps after which a run is given up.
pub const STEPS: u64 = 300_000;
/// So many accuracies in a row that take more steps end the list of a method.
pub const GIVEN_UP: usize = 2;
/// Steps that a reference may take.
pub const REFERENCE_STEPS: u64 = 2_000_000;
/// Accuracies of references \[m\].
const REFERENCES: [f64; 7] = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14];
/// A floor this low is a tenth of the tightest accuracy \[m\]. Where no joint is loose no tighter run is made: none is needed,
/// and near a singular pose rounding is magnified (`n-four-bar`), so that it would be refused.
pub const GOOD: f64 = 1e-10;
/// Accuracy of neighbouring motions where joints are loose \[m\].
const CLOSE: f64 = 1e-12;
/// From this amplification on a motion counts as one that amplifies errors.
pub const AMPLIFIES: f64 = 10.0;
/// What a motion that amplifies errors is asked to keep by an accuracy divided by its amplification \[m\].
pub const GOAL: f64 = 1e-6;
/// Newton's tolerance for scenes of an explicit method, which have none \[m/s\].
const NEWTON_TOLERANCE: f64 = 1e-11;

/// One scene by one method: a line of the record.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct GuaranteeEntry {
    /// Path below `scenes/`, without the ending.
    pub scene: String,
    /// As in the scene.
    pub method: String,
    /// What holds for every method.
    pub facts: Facts,
    /// Why the method does not take the scene.
    pub refused: Option<String>,
    /// One for each accuracy, the loosest first.
    pub runs: Vec<Asked>,
    /// By Dormand and Prince's method, where the motion amplifies errors: [`GOAL`] over the amplification asked for.
    pub advised: Option<Asked>,
}

/// A scene.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Facts {
    /// Horizon and duration of its runs \[s\].
    pub horizon: f64,
    /// Accuracy of the reference, and its floor \[m\]; none where no two runs came to the end.
    pub reference: Option<[f64; 2]>,
    /// Amplification of the motion; 0 where the drives leave nothing to displace. None without a reference, and where
    /// displaced motions take far more steps: near a singular pose they may have no way on.
    pub amplification: Option<f64>,
}

/// A run.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Asked {
    /// The accuracy \[m\].
    pub position: f64,
    /// How it ended.
    pub end: RunEnd,
    /// Steps taken.
    pub steps: u64,
    /// What it warns of.
    pub warnings: Vec<String>,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunEnd {
    /// At the horizon, with this error \[m\]; none without a reference.
    Complete(Option<f64>),
    /// With this message.
    Stopped(String),
    /// After [`STEPS`].
    TooLong,
    /// It was not made, since [`GIVEN_UP`] looser accuracies took too many steps.
    Skipped,
}

impl GuaranteeEntry {
    /// Error achieved over accuracy asked for, of a complete run whose reference is good enough.
    pub fn ratio(&self, run: &Asked) -> Option<f64> {
        let (RunEnd::Complete(Some(error)), Some([_, floor])) = (&run.end, self.facts.reference)
        else {
            return None;
        };
        // powers of ten: a floor of exactly a tenth is below it but for rounding
        (floor <= 0.1001 * run.position).then(|| error / run.position)
    }
}

impl Facts {
    /// True of a motion known to amplify errors.
    pub fn amplifies(&self) -> bool {
        self.amplification.is_some_and(|a| a >= AMPLIFIES)
    }
}

/// A number as the record keeps it: four digits, which any reader reads back to the same bits.
fn kept(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// The record: the digests of the sources, then a line for each scene and method.
pub fn path() -> PathBuf {
    records::root().join("pages/accuracy/guarantee.jsonl")
}

/// What the record holds, and the digests of the sources that it was made from. A line that an interruption has cut off ends it.
///
/// # Errors
/// A record that cannot be read, or begins otherwise.
pub fn read() -> Result<(Digests, Vec<GuaranteeEntry>)> {
    let path = path().display().to_string();
    let text = fs::read_to_string(&path).into_diagnostic();
    let text = text.wrap_err_with(|| format!("cannot read {path}"))?;
    let mut lines = text.lines();
    let digests = serde_json::from_str(lines.next().unwrap_or_default());
    let digests = digests.into_diagnostic().wrap_err(path)?;
    let entries = lines.map_while(|line| serde_json::from_str(line).ok());
    Ok((digests, entries.collect()))
}

fn write(digests: &Digests, entries: &[GuaranteeEntry]) -> Result<()> {
    let mut text = serde_json::to_string(digests).into_diagnostic()? + "\n";
    for entry in entries {
        text += &(serde_json::to_string(entry).into_diagnostic()? + "\n");
    }
    fs::write(path(), text).into_diagnostic()
}

/// Dynamic scenes among the sources, in the order of their names.
fn dynamic_scenes(digests: &Digests) -> Result<Vec<MeasuredScene>> {
    let mut found = Vec::new();
    for file in digests.keys() {
        let name = file
            .strip_prefix("scenes/")
            .and_then(|f| f.strip_suffix(".toml"));
        let Some(name) = name else { continue };
        let path = records::root().join(file);
        let scene = Scene::load(&path, &[]).map_err(|e| miette!("{e}"))?;
        if scene.simulation.analysis == Analysis::Dynamic {
            let (name, common) = (name.to_owned(), OnceLock::new());
            found.push(MeasuredScene {
                name,
                path,
                scene,
                common,
            });
        }
    }
    Ok(found)
}

/// Makes the runs that the record does not have yet and returns all of it; `true` when nothing is left to be made.
///
/// `only`: scenes to be run; all when empty. The record is the same whatever the number of threads.
///
/// # Errors
/// A scene that cannot be read, a record that cannot be written.
pub fn run(only: &[String], threads: usize) -> Result<(Vec<GuaranteeEntry>, bool)> {
    let digests = records::digests(&records::root(), "guarantee")?;
    let all = dynamic_scenes(&digests)?;
    if let Some(unknown) = only
        .iter()
        .find(|name| all.iter().all(|m| m.name != **name))
    {
        return Err(miette!("there is no dynamic scene {unknown}"));
    }
    let mut entries = match read() {
        Ok((then, entries)) if then == digests => entries,
        _ => Vec::new(),
    };
    eprintln!(
        "{} lines of the record are of the present sources",
        entries.len()
    );
    write(&digests, &entries)?;
    // the methods one after the other: so many scenes are measured at once
    let mut jobs: Vec<Job> = Vec::new();
    for method in METHODS {
        let wanted = all
            .iter()
            .filter(|m| only.is_empty() || only.contains(&m.name));
        let missing = |m: &&MeasuredScene| {
            !entries
                .iter()
                .any(|e| e.scene == m.name && e.method == method.0)
        };
        jobs.extend(wanted.filter(missing).map(|m| (m, method)));
    }
    entries.extend(work(&jobs, threads)?);
    let method = |e: &GuaranteeEntry| METHODS.iter().position(|(name, _)| *name == e.method);
    entries.sort_by(|a, b| (&a.scene, method(a)).cmp(&(&b.scene, method(b))));
    write(&digests, &entries)?;
    let complete = entries.len() == all.len() * METHODS.len();
    Ok((entries, complete))
}

/// Recorded positions, by channel.
type RecordedPositions = Vec<Vec<f64>>;
/// The facts and the reference, or why the scene cannot start.
type Common = std::result::Result<(Facts, RecordedPositions), String>;
type Job<'a> = (&'a MeasuredScene, (&'static str, &'static [&'static str]));

/// Takes one job after the other on every thread, and writes a line as soon as one is done.
fn work(jobs: &[Job], threads: usize) -> Result<Vec<GuaranteeEntry>> {
    let file = OpenOptions::new()
        .append(true)
        .open(path())
        .into_diagnostic()?;
    let next = AtomicUsize::new(0);
    let done = Mutex::new((file, Vec::new()));
    let worker = || -> Result<()> {
        while let Some((scene, method)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            let entry = scene.entry(*method)?;
            let line = serde_json::to_string(&entry).into_diagnostic()?;
            let mut done = done.lock().map_err(|_| miette!("a thread has ended"))?;
            writeln!(done.0, "{line}").into_diagnostic()?;
            done.1.push(entry);
            eprintln!(
                "{}/{}: {}, {}",
                done.1.len(),
                jobs.len(),
                scene.name,
                method.0
            );
        }
        Ok(())
    };
    thread::scope(|scope| {
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        all.into_iter()
            .try_for_each(|one| one.join().map_err(|_| miette!("a thread has ended"))?)
    })?;
    Ok(done
        .into_inner()
        .map_err(|_| miette!("a thread has ended"))?
        .1)
}

/// A scene, and what its methods have in common once it is measured.
struct MeasuredScene {
    name: String,
    path: PathBuf,
    scene: Scene,
    common: OnceLock<Common>,
}

impl MeasuredScene {
    fn horizon(&self) -> f64 {
        match loose(&self.scene) {
            true => self.scene.simulation.duration.min(LOOSE_HORIZON),
            false => self.scene.simulation.duration,
        }
    }

    fn scene(&self, method: (&str, &[&str]), position: f64) -> Result<Scene> {
        let horizon = self.horizon();
        let mut overrides = vec![
            format!("simulation.duration={horizon:?}"),
            format!("output.interval={:?}", horizon / ROWS as f64),
            "output.channels=[\"*.x\", \"*.y\"]".to_owned(),
            format!("integrator.method={}", method.0),
            format!("integrator.accuracy={{ position = {position:?}, horizon = {horizon:?} }}"),
        ];
        if self.scene.integrator.newton_tolerance == 0.0 {
            overrides.push(format!("integrator.newton_tolerance={NEWTON_TOLERANCE:?}"));
        }
        overrides.extend(method.1.iter().map(|o| (*o).to_owned()));
        Scene::load(&self.path, &overrides).map_err(|e| miette!("{e}"))
    }

    fn entry(&self, method: (&str, &[&str])) -> Result<GuaranteeEntry> {
        let common = self
            .common
            .get_or_init(|| self.measure().map_err(|e| format!("{e:?}")));
        let (facts, exact) = common.as_ref().map_err(|e| miette!("{}: {e}", self.name))?;
        let mut entry = GuaranteeEntry {
            scene: self.name.clone(),
            method: method.0.to_owned(),
            facts: facts.clone(),
            refused: None,
            runs: Vec::new(),
            advised: None,
        };
        if let Err(error) = Simulation::new(&self.scene(method, ACCURACIES[0])?) {
            entry.refused = Some(error.to_string());
            return Ok(entry);
        }
        let mut given_up = 0;
        for position in ACCURACIES {
            let run = match given_up {
                GIVEN_UP => not_made(position, RunEnd::Skipped),
                _ => self.asked(method, position, exact)?,
            };
            match run.end {
                RunEnd::Skipped => {}
                RunEnd::TooLong => given_up += 1,
                _ => given_up = 0,
            }
            entry.runs.push(run);
        }
        if method == METHODS[0] && facts.amplifies() {
            let amplification = facts.amplification.unwrap_or(1.0);
            entry.advised = Some(self.asked(method, kept(GOAL / amplification), exact)?);
        }
        Ok(entry)
    }

    fn asked(&self, method: (&str, &[&str]), position: f64, exact: &[Vec<f64>]) -> Result<Asked> {
        let mut simulation = match Simulation::new(&self.scene(method, position)?) {
            Ok(simulation) => simulation,
            Err(error) => return Ok(not_made(position, RunEnd::Stopped(error.to_string()))),
        };
        let (ended, positions) = observe(&mut simulation, STEPS);
        let report = simulation.report();
        Ok(Asked {
            position,
            end: match ended {
                Ok(()) => {
                    RunEnd::Complete((!exact.is_empty()).then(|| kept(distance(&positions, exact))))
                }
                Err(RunError::Interrupted { .. }) => RunEnd::TooLong,
                Err(error) => RunEnd::Stopped(error.to_string()),
            },
            steps: report.steps,
            warnings: report.warnings(),
        })
    }

    /// The reference, its floor and the amplification; no positions where there is no reference.
    fn measure(&self) -> Result<(Facts, RecordedPositions)> {
        let mut best: Option<(f64, RecordedPositions)> = None;
        let (mut floor, mut steps) = (None, 0);
        for position in REFERENCES {
            let mut simulation = simulation(&self.scene(METHODS[0], position)?)?;
            let (Ok(()), positions) = observe(&mut simulation, REFERENCE_STEPS) else {
                break;
            };
            let apart = best
                .as_ref()
                .map(|(_, looser)| distance(&positions, looser));
            floor = apart.map(|apart| kept(apart.max(position)));
            steps = steps.max(simulation.report().steps);
            best = Some((position, positions));
            let tightest = !loose(&self.scene) && position <= GOOD;
            if tightest || floor.is_some_and(|floor| floor <= 1.001 * GOOD) {
                break;
            }
        }
        let mut facts = Facts {
            horizon: self.horizon(),
            reference: None,
            amplification: None,
        };
        let (Some((position, positions)), Some(floor)) = (best, floor) else {
            return Ok((facts, Vec::new()));
        };
        facts.reference = Some([position, floor]);
        // a displacement has to be far below a penetration, where there are contacts
        let pace = match loose(&self.scene) {
            true => CLOSE.max(position),
            false => REFERENCES[0],
        };
        facts.amplification = amplification(&self.scene(METHODS[0], pace)?, pace, steps)?.map(kept);
        Ok((facts, positions))
    }
}

fn not_made(position: f64, end: RunEnd) -> Asked {
    Asked {
        position,
        end,
        steps: 0,
        warnings: Vec::new(),
    }
}

/// True where a joint has clearance.
pub fn loose(scene: &Scene) -> bool {
    scene.smallest_clearance().is_some()
}

/// The scene, ready to run.
///
/// # Errors
/// A scene that cannot start.
pub fn simulation(scene: &Scene) -> Result<Simulation> {
    Simulation::new(scene).map_err(|e| miette!("{e}"))
}

/// Runs to the end; the positions up to there.
fn observe(
    simulation: &mut Simulation,
    steps: u64,
) -> (std::result::Result<(), RunError>, RecordedPositions) {
    let mut recording = Recording::new(simulation);
    recording.most_steps = steps;
    let ended = simulation.run(&mut recording);
    let channels = simulation.channels().iter();
    let positions = channels
        .zip(recording.into_columns())
        .filter(|(c, _)| c.unit == "m" && !c.name.starts_with("error."))
        .map(|(_, (_, column))| column);
    (ended, positions.collect())
}

/// The largest difference; what is not a number is larger than all.
fn distance(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    let larger = |m: f64, d: f64| if m.is_nan() || d <= m { m } else { d };
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, larger)
}
