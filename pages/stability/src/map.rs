//! Maps: a scene over a parameter and the step, with several methods.

use crate::outcome::{OutcomeClass, Stopped, judge, judge_stop, record};
use looselink::scene::Scene;
use looselink::simulate::Recording;
use plot::{Axis, Figure, Mark, Panel};
use rayon::prelude::*;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The reference must be this much better than the tolerance.
const REFERENCE_SHARE: f64 = 0.25;
/// Panels beside each other.
const COLUMNS: usize = 2;

/// Methods of maps: their names and the overrides that choose them.
pub const METHODS: [(&str, &[&str]); 7] = [
    ("Bathe", &["integrator.method=bathe"]),
    ("trapezoidal", &["integrator.method=trapezoidal"]),
    (
        "generalised-alpha 0.8",
        &[
            "integrator.method=generalized_alpha",
            "integrator.spectral_radius=0.8",
        ],
    ),
    (
        "HHT 0.8",
        &["integrator.method=hht", "integrator.spectral_radius=0.8"],
    ),
    ("backward Euler", &["integrator.method=backward_euler"]),
    ("velocity Verlet", &["integrator.method=velocity_verlet"]),
    ("Dormand-Prince", &["integrator.method=dormand_prince"]),
];

/// What a map compares unless it says otherwise.
fn usual() -> Vec<String> {
    let names = [
        "Bathe",
        "trapezoidal",
        "generalised-alpha 0.8",
        "Dormand-Prince",
    ];
    names.map(str::to_owned).to_vec()
}

/// A run without a warning is right to this part of what moves: some times the estimate that a warning is given for.
fn unsaid() -> f64 {
    0.05
}

/// A map as its file says it.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// What is shown, in a line.
    pub title: String,
    /// What to see in it.
    pub remark: String,
    /// The scene, below `scenes/`.
    pub scene: PathBuf,
    /// Overrides of all runs.
    #[serde(default)]
    pub set: Vec<String>,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Time between the rows that are compared \[s\].
    pub interval: f64,
    /// Channels that are compared, all with the same unit.
    pub channels: Vec<String>,
    /// Largest error of a run that is called accurate, in the unit of the channels.
    pub tolerance: f64,
    /// An error beyond this part of the range of the channels needs a warning.
    #[serde(default = "unsaid")]
    pub unsaid: f64,
    /// What is varied.
    pub parameter: MapParameter,
    /// Steps \[s\].
    pub steps: Vec<f64>,
    /// What the runs are compared with.
    pub reference: MapReference,
    /// Names of [`METHODS`].
    #[serde(default = "usual")]
    pub methods: Vec<String>,
}

/// What is varied.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapParameter {
    /// Its name.
    pub label: String,
    /// Its unit; empty for a number.
    #[serde(default)]
    pub unit: String,
    /// Overrides in which `{}` stands for the value.
    pub set: Vec<String>,
    /// Values.
    pub values: Vec<f64>,
}

/// A run with which those of a map are compared.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapReference {
    /// Overrides that choose its method.
    pub set: Vec<String>,
    /// Its step \[s\], one for all values or one each; a run with twice the step must agree.
    pub steps: Vec<f64>,
}

/// A run of a map.
#[derive(Debug, Clone)]
pub struct MapCell {
    /// Index of its method, its parameter and its step.
    pub at: [usize; 3],
    /// What became of it.
    pub outcome: OutcomeClass,
    /// Largest error in the unit of the channels, of a run that reached its end.
    pub error: Option<f64>,
    /// What it said: its first warning, or why it stopped.
    pub said: String,
}

/// All runs of a map.
#[derive(Debug, Clone)]
pub struct MadeMap {
    /// Name of its file without the extension.
    pub name: String,
    /// What was asked.
    pub map: Map,
    /// What came of it: methods, parameters, steps.
    pub cells: Vec<MapCell>,
}

/// Why a map cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("{map}: {message}")]
pub struct MapError {
    map: String,
    message: String,
}

/// Files of maps, in the order of their names.
///
/// # Errors
/// A folder that cannot be read.
pub fn files() -> std::io::Result<Vec<PathBuf>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps");
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        paths.push(entry?.path());
    }
    paths.sort();
    Ok(paths)
}

/// Largest difference of two recordings, in the unit of their channels.
pub(crate) fn difference(a: &Recording, b: &Recording) -> f64 {
    let columns = a.names().iter().skip(1).filter_map(|name| {
        let (a, b) = (a.get(name)?, b.get(name)?);
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        Some(differences.fold(0.0, f64::max))
    });
    columns.fold(0.0, f64::max)
}

/// Widest range of the channels of a recording.
fn range(recording: &Recording) -> f64 {
    let columns = recording.names().iter().skip(1);
    let widths = columns.filter_map(|name| recording.get(name)).map(|x| {
        let ends = x.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |r, x| {
            (r.0.min(*x), r.1.max(*x))
        });
        ends.1 - ends.0
    });
    widths.fold(0.0, f64::max)
}

impl Map {
    /// Reads a map.
    ///
    /// # Errors
    /// A file that cannot be read, or a fault with its line.
    pub fn load(path: &Path) -> Result<Map, MapError> {
        let fault = |message: String| MapError {
            map: path.display().to_string(),
            message,
        };
        let text = std::fs::read_to_string(path).map_err(|e| fault(e.to_string()))?;
        let map: Map = toml::from_str(&text).map_err(|e| fault(e.to_string()))?;
        let count = map.reference.steps.len();
        if count != 1 && count != map.parameter.values.len() {
            return Err(fault(format!(
                "{count} steps of the reference for {} values",
                map.parameter.values.len()
            )));
        }
        let known = |name: &&String| METHODS.iter().any(|(method, _)| method == name);
        match map.methods.iter().find(|name| !known(name)) {
            Some(name) => Err(fault(format!("no method is called {name:?}"))),
            None => Ok(map),
        }
    }

    fn scene(&self, more: &[String], value: f64, step: f64) -> Result<Scene, Stopped> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../scenes")
            .join(&self.scene);
        let varied = self.parameter.set.iter();
        let varied = varied.map(|set| set.replace("{}", &value.to_string()));
        let channels: Vec<String> = self.channels.iter().map(|c| format!("{c:?}")).collect();
        let own = [
            format!("simulation.duration={:e}", self.duration),
            format!("output.interval={:e}", self.interval),
            format!("output.channels=[{}]", channels.join(", ")),
            format!("integrator.step={step:e}"),
        ];
        let all = self.set.iter().cloned().chain(varied).chain(own);
        let all: Vec<String> = all.chain(more.iter().cloned()).collect();
        Scene::load(&path, &all).map_err(|e| Stopped::Refused(e.to_string(), 0.0))
    }

    /// The reference for a value of the parameter, checked.
    fn reference(&self, name: &str, index: usize) -> Result<Recording, MapError> {
        let steps = &self.reference.steps;
        let (value, step) = (
            self.parameter.values[index],
            steps[index.min(steps.len() - 1)],
        );
        let fault = |message: String| MapError {
            map: name.to_owned(),
            message: format!(
                "the reference at {} = {value:e} {message}",
                self.parameter.label
            ),
        };
        let run = |step: f64| {
            let scene = self.scene(&self.reference.set, value, step);
            let made = scene.and_then(|scene| record(&scene));
            made.map_err(|e| fault(format!("with step {step:e} s fails: {e}")))
        };
        let ((fine, _), (coarse, _)) = (run(step)?, run(2.0 * step)?);
        let difference = difference(&fine, &coarse) / self.tolerance;
        match difference <= REFERENCE_SHARE {
            true => Ok(fine),
            false => Err(fault(format!(
                "is not converged: steps of {step:e} s and twice that differ by {difference:.2} tolerances"
            ))),
        }
    }

    fn cell(&self, at: [usize; 3], reference: &Recording) -> MapCell {
        let [method, parameter, step] = at;
        let chosen = METHODS
            .iter()
            .find(|(name, _)| *name == self.methods[method]);
        let set: Vec<String> = chosen.map_or(Vec::new(), |(_, set)| {
            set.iter().map(|s| (*s).to_owned()).collect()
        });
        let scene = self.scene(&set, self.parameter.values[parameter], self.steps[step]);
        match scene.and_then(|scene| record(&scene)) {
            Ok((recording, report)) => {
                let error = difference(&recording, reference);
                MapCell {
                    at,
                    outcome: judge(
                        error,
                        self.tolerance,
                        self.unsaid * range(reference),
                        &report,
                    ),
                    error: Some(error),
                    said: report.warnings().first().cloned().unwrap_or_default(),
                }
            }
            Err(stopped) => MapCell {
                at,
                outcome: judge_stop(&stopped),
                error: None,
                said: stopped.to_string(),
            },
        }
    }

    /// Makes all runs.
    ///
    /// # Errors
    /// A reference that fails or has not converged.
    pub fn make(self, name: &str) -> Result<MadeMap, MapError> {
        let values = 0..self.parameter.values.len();
        let references: Vec<Recording> = values
            .into_par_iter()
            .map(|index| self.reference(name, index))
            .collect::<Result<_, _>>()?;
        let methods = 0..self.methods.len();
        let places: Vec<[usize; 3]> = methods
            .flat_map(|m| (0..references.len()).map(move |p| (m, p)))
            .flat_map(|(m, p)| (0..self.steps.len()).map(move |s| [m, p, s]))
            .collect();
        let cells = places
            .into_par_iter()
            .map(|at| self.cell(at, &references[at[1]]));
        Ok(MadeMap {
            name: name.to_owned(),
            cells: cells.collect(),
            map: self,
        })
    }
}

impl MadeMap {
    /// Number of runs of a method with an outcome.
    pub fn count(&self, method: usize, outcome: OutcomeClass) -> usize {
        let cells = self.cells.iter();
        cells
            .filter(|c| c.at[0] == method && c.outcome == outcome)
            .count()
    }

    /// The picture: a panel a method, a dot a run.
    pub fn figure(&self) -> Figure {
        let map = &self.map;
        let panels = map.methods.iter().enumerate().map(|(m, method)| Panel {
            title: method.clone(),
            note: String::new(),
            x: Axis::new("Step", "s", 1.0).log(),
            y: Axis::new(&self.map.parameter.label, unit(&map.parameter.unit), 1.0).log(),
            marks: OutcomeClass::ALL
                .into_iter()
                .filter_map(|o| self.dots(m, o))
                .collect(),
        });
        let caption = format!(
            "{}. Scene {}, {} long. Accurate: within {} of the reference in every row. Coarse and damped: larger errors, \
                 with a warning where they are large. Failed: the integrator adds energy, and the run warns or stops. Refused: \
                 stopped with an error. {}",
            map.title,
            map.scene.display(),
            numbers::si(map.duration, "s"),
            numbers::si(map.tolerance, self.unit_of_channels()),
            map.remark
        );
        Figure::grid(panels.collect(), COLUMNS, caption)
    }

    /// The unit of the channels that are compared, which follows from their names.
    fn unit_of_channels(&self) -> &'static str {
        match self.map.channels.first() {
            Some(name) if name.ends_with(".ax") || name.ends_with(".ay") => "m/s²",
            _ => "m",
        }
    }

    fn dots(&self, method: usize, outcome: OutcomeClass) -> Option<Mark> {
        let cells = self.cells.iter();
        let places = cells.filter(|c| c.at[0] == method && c.outcome == outcome);
        let place = |c: &MapCell| (self.map.steps[c.at[2]], self.map.parameter.values[c.at[1]]);
        let (x, y): (Vec<f64>, Vec<f64>) = places.map(place).unzip();
        let mark = || Mark::points(outcome.name(), outcome.color(), &x, &y, 17);
        (!x.is_empty()).then(mark)
    }
}

/// Symbols of units that maps have.
fn unit(name: &str) -> &'static str {
    const UNITS: [&str; 8] = ["", "N/m", "Pa", "m", "kg", "m/s", "rad/s", "N/m^1.5"];
    let known = UNITS.into_iter().find(|u| *u == name);
    known.unwrap_or_else(|| panic!("no axis has the unit {name:?} yet"))
}
