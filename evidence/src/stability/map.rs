//! Maps: a scene over a parameter and the step, with every method.

use crate::stability::outcome::{
    OutcomeClass, Stopped, gist, judge, judge_stop, largest, limits, record,
};
use indexmap::IndexSet;
use looselink::scene::Scene;
use looselink::simulate::Recording;
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The reference must be this much better than the tolerance.
const REFERENCE_SHARE: f64 = 0.25;
/// Accuracies that are asked of `auto`, over the loosest.
const ACCURACIES: [f64; 4] = [1e-3, 1e-2, 1e-1, 1.0];

/// Methods: their names and the overrides that choose them, one after the other.
pub const METHODS: [(&str, &str); 11] = [
    ("Bathe", "method=bathe"),
    ("trapezoidal", "method=trapezoidal"),
    (
        "generalised-alpha 0.8",
        "method=generalized_alpha spectral_radius=0.8",
    ),
    ("HHT 0.8", "method=hht spectral_radius=0.8"),
    ("backward Euler", "method=backward_euler"),
    ("ESDIRK 3", "method=esdirk3"),
    ("ESDIRK 5", "method=esdirk5"),
    ("velocity Verlet", "method=velocity_verlet"),
    ("Dormand-Prince", "method=dormand_prince"),
    ("DOP853", "method=dop853"),
    (AUTO, "method=auto"),
];
/// The method that takes an accuracy instead of a step.
pub const AUTO: &str = "auto";

/// A run without a warning is right to this part of what moves: some times the estimate that a warning is given for.
pub const UNSAID: f64 = 0.05;

fn unsaid() -> f64 {
    UNSAID
}

/// A map as its file says it.
#[derive(Debug, Clone, Serialize, Deserialize)]
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
    /// The loosest accuracy that is asked of `auto` \[m\]: the tolerance, unless the channels are no positions.
    pub loosest: Option<f64>,
    /// An error beyond this part of the range of the channels needs a warning.
    #[serde(default = "unsaid")]
    pub unsaid: f64,
    /// What is varied.
    pub parameter: MapParameter,
    /// Steps \[s\].
    pub steps: Vec<f64>,
    /// What the runs are compared with.
    pub reference: MapReference,
    /// Names of those [`METHODS`] that do not take the scene.
    #[serde(default)]
    pub without: Vec<String>,
}

/// What is varied.
#[derive(Debug, Clone, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapReference {
    /// Overrides that choose its method; `{}` stands for the step, in an accuracy that replaces it.
    pub set: Vec<String>,
    /// Its step \[s\], or accuracy \[m\], one for all values or one each; a run with twice of it must agree.
    pub steps: Vec<f64>,
}

/// A run: its outcome, its largest error in the unit of the channels where it reached its end, and what it said, an index of
/// [`MadeMap::said`].
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MapCell(pub OutcomeClass, pub Option<f64>, pub Option<usize>);

/// All runs of a method.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MapPanel {
    /// Its name.
    pub method: String,
    /// Its runs, by the value of the parameter and then by the step, or the accuracy.
    pub cells: Vec<Vec<MapCell>>,
}

/// All runs of a map.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MadeMap {
    /// Name of its file without the extension.
    pub name: String,
    /// What was asked.
    pub map: Map,
    /// What came of it.
    pub panels: Vec<MapPanel>,
    /// Widest range of the channels of the reference, for each value of the parameter.
    pub ranges: Vec<f64>,
    /// First warnings of errors and causes of stops, without their numbers.
    pub said: IndexSet<String>,
}

/// Silent runs of one kind, in `evidence/silent.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownSilent {
    /// Why nothing warns of the error.
    pub because: String,
    /// Map, method, value of the parameter, step or accuracy.
    runs: Vec<(String, String, f64, f64)>,
}

impl KnownSilent {
    /// Whether this run of a map is one of them.
    pub fn has(&self, map: &str, run: &MapRun) -> bool {
        // accuracies are products
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        self.runs.iter().any(|(of, method, value, column)| {
            (&of[..], &method[..]) == (map, run.method)
                && near(*value, run.value)
                && near(*column, run.column)
        })
    }
}

/// The values of the parameter and the steps, or accuracies, of the silent runs of a map that are known.
pub fn listed(known: &[KnownSilent], map: &str) -> (Vec<f64>, Vec<f64>) {
    let runs = known.iter().flat_map(|kind| &kind.runs);
    let of_map = runs.filter(|(name, ..)| name == map);
    of_map.map(|(.., value, column)| (value, column)).unzip()
}

/// The silent runs that are known, and why they are.
///
/// # Errors
/// A file that is no list of them.
pub fn known_silent() -> Result<Vec<KnownSilent>> {
    #[derive(Deserialize)]
    struct File {
        silent: Vec<KnownSilent>,
    }
    let text = std::fs::read_to_string(records::root().join("evidence/silent.toml"));
    let file: File = toml::from_str(&text.into_diagnostic()?).into_diagnostic()?;
    Ok(file.silent)
}

/// Files of maps, in the order of their names.
///
/// # Errors
/// A folder that cannot be read.
pub fn files() -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(records::root().join("evidence/maps")).into_diagnostic()?;
    let paths = entries.map(|entry| Ok(entry.into_diagnostic()?.path()));
    let mut paths = paths.collect::<Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

/// Largest difference of two recordings, in the unit of their channels; not a number where one of theirs is none.
pub fn difference(a: &Recording, b: &Recording) -> f64 {
    let columns = a.names().iter().skip(1);
    let pairs = columns.filter_map(|name| Some(a.get(name)?.iter().zip(b.get(name)?)));
    largest(pairs.flatten().map(|(a, b)| a - b))
}

/// Widest range of the channels of a recording.
fn range(recording: &Recording) -> f64 {
    let columns = recording.names().iter().skip(1);
    let columns = columns.filter_map(|name| recording.get(name));
    let widths = columns.map(|x| {
        let [least, greatest] = limits(x.iter().copied());
        greatest - least
    });
    widths.fold(0.0, f64::max)
}

impl Map {
    /// Reads a map.
    ///
    /// # Errors
    /// A file that cannot be read, or a fault with its line.
    pub fn load(path: &Path) -> Result<Map> {
        let name = path.display();
        let text = std::fs::read_to_string(path).into_diagnostic();
        let read = text.and_then(|text| toml::from_str(&text).into_diagnostic());
        let map: Map = read.wrap_err_with(|| name.to_string())?;
        let (steps, values) = (map.reference.steps.len(), map.parameter.values.len());
        ensure!(
            steps == 1 || steps == values,
            "{name}: {steps} steps of the reference for {values} values"
        );
        let positions = map
            .channels
            .iter()
            .all(|c| c.ends_with(".x") || c.ends_with(".y"));
        ensure!(
            positions != map.loosest.is_some(),
            "{name}: `loosest` is for maps of other channels than positions"
        );
        for method in &map.without {
            let known = METHODS.iter().any(|(known, _)| known == method);
            ensure!(known, "{name}: no method is called {method:?}");
        }
        Ok(map)
    }

    /// What the columns of a panel are: steps \[s\] or accuracies \[m\].
    pub fn columns(&self, method: &str) -> Vec<f64> {
        match method {
            AUTO => ACCURACIES
                .map(|part| part * self.loosest.unwrap_or(self.tolerance))
                .to_vec(),
            _ => self.steps.clone(),
        }
    }

    fn scene(&self, value: f64, more: &[String]) -> Result<Scene, Stopped> {
        let path = records::root().join("scenes").join(&self.scene);
        let varied = self.parameter.set.iter();
        let varied = varied.map(|set| set.replace("{}", &value.to_string()));
        let own = [
            format!("simulation.duration={:e}", self.duration),
            format!("output.interval={:e}", self.interval),
            format!("output.channels={:?}", self.channels),
        ];
        let all = self.set.iter().cloned().chain(varied).chain(own);
        let all: Vec<String> = all.chain(more.iter().cloned()).collect();
        Scene::load(&path, &all).map_err(|e| Stopped::Refused(e.to_string(), 0.0))
    }

    /// The reference for a value of the parameter, checked.
    fn reference(&self, index: usize) -> Result<Recording> {
        let (value, steps) = (self.parameter.values[index], &self.reference.steps);
        let step = steps[index.min(steps.len() - 1)];
        let run = |step: f64| {
            let set = self.reference.set.iter();
            let set = set.map(|set| set.replace("{}", &format!("{step:e}")));
            let more: Vec<String> = std::iter::once(step_of(step)).chain(set).collect();
            let made = self.scene(value, &more).and_then(|scene| record(&scene));
            made.map_err(|e| miette!("the reference at {value:e} with step {step:e} s: {e}"))
        };
        let ((fine, _), (coarse, _)) = (run(step)?, run(2.0 * step)?);
        let difference = difference(&fine, &coarse) / self.tolerance;
        ensure!(
            difference <= REFERENCE_SHARE,
            "the reference at {value:e} has not converged: steps of {step:e} s and twice that differ by {difference:.2} tolerances"
        );
        Ok(fine)
    }

    /// A run: its outcome, its error, and what it said.
    fn run(
        &self,
        (method, set): (&str, &str),
        value: f64,
        column: f64,
        reference: &Recording,
    ) -> (OutcomeClass, Option<f64>, Option<String>) {
        let set = set.split(' ').map(|set| format!("integrator.{set}"));
        let mut set: Vec<String> = set.collect();
        set.push(match method {
            AUTO => format!(
                "integrator.accuracy={{ position = {column:e}, horizon = {:e} }}",
                self.duration
            ),
            _ => step_of(column),
        });
        match self.scene(value, &set).and_then(|scene| record(&scene)) {
            Ok((recording, report)) => {
                let error = difference(&recording, reference);
                let outcome = judge(
                    error,
                    self.tolerance,
                    range(reference),
                    self.unsaid,
                    &report,
                );
                let shown = error.is_finite().then(|| numbers::rounded(error, 3));
                (outcome, shown, report.error_warnings().into_iter().next())
            }
            Err(stopped) => (judge_stop(&stopped), None, Some(stopped.to_string())),
        }
    }

    /// Makes all runs.
    ///
    /// # Errors
    /// A reference that fails or has not converged.
    pub fn make(self, name: &str) -> Result<MadeMap> {
        let values = &self.parameter.values;
        let references: Vec<Recording> = (0..values.len())
            .into_par_iter()
            .map(|index| self.reference(index).wrap_err_with(|| name.to_owned()))
            .collect::<Result<_>>()?;
        let (mut panels, mut said) = (Vec::new(), IndexSet::new());
        for method in METHODS {
            if self.without.iter().any(|name| *name == method.0) {
                continue;
            }
            let columns = self.columns(method.0);
            let row = |v: usize| -> Vec<_> {
                let runs = columns.par_iter();
                let runs = runs.map(|c| self.run(method, values[v], *c, &references[v]));
                runs.collect()
            };
            let rows: Vec<Vec<_>> = (0..values.len()).into_par_iter().map(row).collect();
            let mut cell = |(outcome, error, text): (_, _, Option<String>)| {
                let text = text.filter(|_| outcome != OutcomeClass::Accurate);
                let index = text.map(|text| said.insert_full(gist(&text)).0);
                MapCell(outcome, error, index)
            };
            let mut row = |row: Vec<_>| row.into_iter().map(&mut cell).collect();
            panels.push(MapPanel {
                method: method.0.to_owned(),
                cells: rows.into_iter().map(&mut row).collect(),
            });
        }
        Ok(MadeMap {
            name: name.to_owned(),
            panels,
            ranges: references
                .iter()
                .map(|r| numbers::rounded(range(r), 3))
                .collect(),
            said,
            map: self,
        })
    }
}

fn step_of(step: f64) -> String {
    format!("integrator.step={step:e}")
}

impl MadeMap {
    /// All runs.
    pub fn runs(&self) -> impl Iterator<Item = MapRun<'_>> {
        self.panels.iter().flat_map(|panel| {
            let columns = self.map.columns(&panel.method);
            let values = self.map.parameter.values.iter().zip(&self.ranges);
            let rows = values.zip(&panel.cells);
            rows.flat_map(move |((&value, &range), row)| {
                let cells = columns.clone().into_iter().zip(row);
                cells.map(move |(column, cell)| MapRun {
                    method: &panel.method,
                    value,
                    column,
                    range,
                    cell,
                })
            })
        })
    }
}

/// A run with its place in the map.
#[derive(Debug)]
pub struct MapRun<'a> {
    /// Its method.
    pub method: &'a str,
    /// Value of the parameter.
    pub value: f64,
    /// Its step \[s\], or the accuracy of `auto` \[m\].
    pub column: f64,
    /// Range of the compared channels, in their unit.
    pub range: f64,
    /// What came of it.
    pub cell: &'a MapCell,
}

impl MapRun<'_> {
    /// Whether this is how it ended.
    pub fn is(&self, class: OutcomeClass) -> bool {
        self.cell.0 == class
    }
}
