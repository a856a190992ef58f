//! Whether runs reach the accuracy that they are asked for: every dynamic scene, every method, seven accuracies.
//!
//! The error of a run is the largest difference of a position, over all recorded rows up to the horizon H, from a
//! reference. The reference is a run of Dormand and Prince's method with the tightest accuracy that it reaches within
//! [`REFERENCE_STEPS`]; its floor is its distance from a run ten times looser, and not below the accuracy it was asked for.

use crate::accuracy::amplification::amplification;
use crate::campaign::results;
use looselink::scene::{AUTO, Analysis, Scene};
use looselink::simulate::{Recording, RunError, Simulation};
use looselink::stepper::SCHEMES;
use miette::{Result, WrapErr};
use numbers::rounded;
use records::{Journal, root};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use verify::compare::scenes;

/// The method of the references.
const METHOD: &str = "dormand_prince";
/// Parameter of the methods that need one: the spectral radius at infinite frequency.
pub const SPECTRAL_RADIUS: f64 = 0.8;
/// Scenes side by side.
const THREADS: usize = 2;
/// Accuracies asked for \[m\], the loosest first.
pub const ACCURACIES: [f64; 7] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// Horizon where a joint has clearance \[s\]; elsewhere it is the duration.
pub const LOOSE_HORIZON: f64 = 0.01;
/// Recorded rows of a run.
pub const ROWS: usize = 50;
/// Steps after which a run is given up, and the tighter accuracies of the same method with it.
pub const STEPS: u64 = 200_000;
/// Steps that a reference may take.
pub const REFERENCE_STEPS: u64 = 2_000_000;
/// Accuracies of references \[m\].
const REFERENCES: [f64; 7] = [1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14];
/// A floor this low is a tenth of the tightest accuracy \[m\]. Where no joint is loose no tighter run is made: none is needed,
/// and near a singular pose rounding is magnified (`n-four-bar`), so that it would be refused.
pub const GOOD: f64 = 1e-10;
/// Accuracy of neighbouring motions where joints are loose \[m\].
const CLOSE: f64 = 1e-12;
/// A run misses its accuracy that errs by more than this many times.
pub const MISS: f64 = 3.0;
/// From this amplification on a motion counts as one that amplifies errors.
pub const AMPLIFIES: f64 = 10.0;
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    /// One for each accuracy, the loosest first.
    pub runs: Vec<Asked>,
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
    /// Its warnings of an error; kept of runs that miss their accuracy.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
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
    /// It was not made, since a looser accuracy took too many steps.
    Skipped,
}

impl GuaranteeEntry {
    /// Leaves out the warnings that no page has.
    fn shorten(&mut self) {
        let mut runs = std::mem::take(&mut self.runs);
        let misses = |run: &Asked| self.ratio(run).is_some_and(|ratio| ratio > MISS);
        let hits = runs.iter_mut().filter(|run| !misses(run));
        hits.for_each(|run| run.warnings.clear());
        self.runs = runs;
    }

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

/// All schemes, the one of the references first, and the choice among them.
pub fn methods() -> Vec<&'static str> {
    let schemes = SCHEMES.iter().map(|scheme| scheme.name);
    let mut names: Vec<&str> = schemes.chain([AUTO]).collect();
    names.sort_by_key(|name| *name != METHOD);
    names
}

/// What the schemes need beside their names.
fn parameters(method: &str) -> impl Iterator<Item = String> {
    let scheme = SCHEMES.iter().filter(move |scheme| scheme.name == method);
    let needed = scheme
        .flat_map(|scheme| scheme.parameters)
        .filter(|p| p.default.is_none());
    needed.map(|parameter| format!("integrator.{}={SPECTRAL_RADIUS}", parameter.name))
}

/// Runs every dynamic scene with every method.
///
/// # Errors
/// A scene that cannot be read or has no start.
pub fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let name = |scene: &MeasuredScene| scene.name.clone();
    let entries = journal.items(&dynamic_scenes()?, THREADS, name, MeasuredScene::entries)?;
    let mut entries = entries.concat();
    entries.iter_mut().for_each(GuaranteeEntry::shorten);
    results(entries)
}

/// Dynamic scenes of the project, in the order of their names.
fn dynamic_scenes() -> Result<Vec<MeasuredScene>> {
    let plans = scenes::of(Analysis::Dynamic)?.into_iter();
    // the comparison has scenes of its own
    let names = plans
        .map(|plan| plan.scene)
        .filter(|name| !name.starts_with(".."));
    let scenes = names.map(|name| {
        let path = root().join("scenes").join(format!("{name}.toml"));
        Ok(MeasuredScene {
            scene: Scene::load(&path, &[])?,
            name,
            path,
        })
    });
    scenes.collect()
}

/// Recorded positions, by channel.
type RecordedPositions = Vec<Vec<f64>>;

/// A scene.
struct MeasuredScene {
    name: String,
    path: PathBuf,
    scene: Scene,
}

impl MeasuredScene {
    fn horizon(&self) -> f64 {
        match loose(&self.scene) {
            true => self.scene.simulation.duration.min(LOOSE_HORIZON),
            false => self.scene.simulation.duration,
        }
    }

    fn scene(&self, method: &str, position: f64) -> Result<Scene> {
        let horizon = self.horizon();
        let mut overrides = vec![
            format!("simulation.duration={horizon:?}"),
            format!("output.interval={:?}", horizon / ROWS as f64),
            "output.channels=[\"*.x\", \"*.y\"]".to_owned(),
            format!("integrator.method={method}"),
            format!("integrator.accuracy={{ position = {position:?}, horizon = {horizon:?} }}"),
        ];
        if self.scene.integrator.newton_tolerance.is_none() {
            overrides.push(format!("integrator.newton_tolerance={NEWTON_TOLERANCE:?}"));
        }
        overrides.extend(parameters(method));
        Ok(Scene::load(&self.path, &overrides)?)
    }

    /// All methods.
    fn entries(&self) -> Result<Vec<GuaranteeEntry>> {
        let (facts, exact) = self.measure().wrap_err_with(|| self.name.clone())?;
        let methods = methods().into_iter();
        methods
            .map(|method| self.entry(method, &facts, &exact))
            .collect()
    }

    fn entry(&self, method: &str, facts: &Facts, exact: &[Vec<f64>]) -> Result<GuaranteeEntry> {
        let mut entry = GuaranteeEntry {
            scene: self.name.clone(),
            method: method.to_owned(),
            facts: facts.clone(),
            refused: None,
            runs: Vec::new(),
        };
        if let Err(error) = Simulation::new(&self.scene(method, ACCURACIES[0])?) {
            entry.refused = Some(error.to_string());
            return Ok(entry);
        }
        for position in ACCURACIES {
            entry
                .runs
                .push(match entry.runs.last().map(|looser| &looser.end) {
                    Some(RunEnd::TooLong | RunEnd::Skipped) => not_made(position, RunEnd::Skipped),
                    _ => self.asked(method, position, exact)?,
                });
        }
        Ok(entry)
    }

    fn asked(&self, method: &str, position: f64, exact: &[Vec<f64>]) -> Result<Asked> {
        let mut simulation = match Simulation::new(&self.scene(method, position)?) {
            Ok(simulation) => simulation,
            Err(error) => return Ok(not_made(position, RunEnd::Stopped(error.to_string()))),
        };
        let (ended, positions) = observe(&mut simulation, STEPS);
        let report = simulation.report();
        Ok(Asked {
            position,
            end: match ended {
                Ok(()) if exact.is_empty() => RunEnd::Complete(None),
                Ok(()) => match rounded(distance(&positions, exact), 4) {
                    error if error.is_finite() => RunEnd::Complete(Some(error)),
                    _ => RunEnd::Stopped("a position is no number".to_owned()),
                },
                Err(RunError::Interrupted { .. }) => RunEnd::TooLong,
                Err(error) => RunEnd::Stopped(error.to_string()),
            },
            steps: report.steps,
            warnings: report.error_warnings(),
        })
    }

    /// The reference, its floor and the amplification; no positions where there is no reference.
    fn measure(&self) -> Result<(Facts, RecordedPositions)> {
        let mut best: Option<(f64, RecordedPositions)> = None;
        let (mut floor, mut steps) = (None, 0);
        for position in REFERENCES {
            let mut simulation = Simulation::new(&self.scene(METHOD, position)?)?;
            let (Ok(()), positions) = observe(&mut simulation, REFERENCE_STEPS) else {
                break;
            };
            let apart = best
                .as_ref()
                .map(|(_, looser)| distance(&positions, looser));
            floor = apart.map(|apart| rounded(apart.max(position), 4));
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
        facts.amplification =
            amplification(&self.scene(METHOD, pace)?, pace, steps)?.map(|a| rounded(a, 4));
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
