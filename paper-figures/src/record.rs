//! What `ensembles` leaves for the reproduction report, as JSON.

use crate::interval::{CriterionVerdict, Interval, STARTS};
use crate::measures::Measures;
use crate::runs::words;
use crate::warned::{WarningSource, merged};
use miette::{IntoDiagnostic, Result, WrapErr};
use numbers::{digits, si};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the ensemble of case 4.
pub const BOTH: &str = "B";
/// Name of the ensemble of case 3 with half the clearance.
pub const TIGHTER: &str = "G";

/// Everything; a rerun gives the same bytes.
#[derive(Debug, Serialize, Deserialize)]
pub struct EnsembleRecord {
    /// Runs of chaotic cases that differ by a tiny displacement at the start.
    pub ensembles: Vec<Ensemble>,
    /// Largest Lyapunov exponents.
    pub exponents: Vec<Exponents>,
    /// Runs of case 2, which is not chaotic.
    pub singles: Vec<Single>,
    /// Work and error of explicit and implicit methods.
    pub work: Vec<MethodWork>,
    /// Runs over many cycles.
    pub long: Vec<Long>,
}

/// Runs that differ by the direction of a tiny displacement of the platform at the start.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ensemble {
    /// A letter.
    pub name: String,
    /// Case of Table 2.
    pub case: u32,
    /// The displacement \[m\].
    pub moved: f64,
    /// The first of its directions: 0, or as many as an ensemble has where the ensemble repeats another in directions
    /// between.
    pub first: usize,
    /// What else is changed in the scene; empty for nothing.
    pub changed: String,
    /// Method and step.
    pub how: String,
    /// One for each start.
    pub members: Vec<EnsembleMember>,
}

/// One run of an ensemble.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct EnsembleMember {
    /// What was measured.
    pub measures: Measures,
    /// What the run warns of.
    pub warnings: Vec<String>,
}

/// Largest Lyapunov exponents of one case, one for each start.
#[derive(Debug, Serialize, Deserialize)]
pub struct Exponents {
    /// Case of Table 2.
    pub case: u32,
    /// Distance to which the neighbouring motion is brought back.
    pub distance: f64,
    /// Method and step.
    pub how: String,
    /// The exponents \[1/s\].
    pub values: Vec<f64>,
    /// Mean of the sums of logarithms, at equal intervals of time.
    pub growth: Vec<f64>,
    /// What each run warns of.
    pub warnings: Vec<Vec<String>>,
}

/// One run of case 2.
#[derive(Debug, Serialize, Deserialize)]
pub struct Single {
    /// What is special about it.
    pub name: String,
    /// Method and step.
    pub how: String,
    /// What was measured.
    pub measures: Measures,
    /// What the run warns of.
    pub warnings: Vec<String>,
}

/// One run of a comparison of methods.
#[derive(Debug, Serialize, Deserialize)]
pub struct MethodWork {
    /// Case of Table 2.
    pub case: u32,
    /// Method as in the scene.
    pub method: String,
    /// Step \[s\].
    pub step: f64,
    /// Evaluations of the elastic force of an element.
    pub evaluations: u64,
    /// Largest difference of e_x from the reference \[m\]; none where the run stopped.
    pub error: Option<f64>,
    /// Largest |e_x| of the reference \[m\].
    pub size: f64,
    /// What the run warns of, or why it stopped.
    pub warnings: Vec<String>,
}

/// Runs over many cycles that differ in the start: one of case 2, an ensemble of case 4.
#[derive(Debug, Serialize, Deserialize)]
pub struct Long {
    /// Case of Table 2.
    pub case: u32,
    /// Method as in the scene.
    pub method: String,
    /// Step \[s\].
    pub step: f64,
    /// Cycles of a run.
    pub cycles: f64,
    /// How many runs stopped.
    pub stopped: usize,
    /// Rms deviation of the acceleration in the last cycle over that in the second, of every run that did not stop.
    pub growth: Vec<f64>,
    /// What every run warns of, or why it stopped.
    pub warnings: Vec<Vec<String>>,
}

impl Long {
    /// The growth in words.
    pub fn reported(&self) -> String {
        let runs = self.warnings.len();
        match self.growth.as_slice() {
            [one] if runs == 1 => digits(*one),
            all if all.len() == STARTS => Interval::of(all).reported(digits),
            _ => format!("stopped runs: {} of {runs}", self.stopped),
        }
    }

    /// Whether the motion has not grown by more than a factor.
    pub fn stays(&self, factor: f64) -> CriterionVerdict {
        match self.growth.as_slice() {
            _ if self.stopped > 0 => CriterionVerdict::Fails,
            [one] => CriterionVerdict::of(*one <= factor),
            all => Interval::of(all).below(factor),
        }
    }

    /// Method, step and warnings.
    pub fn source(&self) -> WarningSource {
        let (case, step) = (self.case, si(self.step, "s"));
        let all: Vec<&[String]> = self.warnings.iter().map(Vec::as_slice).collect();
        WarningSource {
            name: format!(
                "case {case}, {} with h = {step} over {} cycles",
                words(&self.method),
                self.cycles
            ),
            warnings: match all.as_slice() {
                [one] => one.to_vec(),
                all => merged(all),
            },
        }
    }
}

impl EnsembleRecord {
    /// The ensemble of this name.
    ///
    /// # Panics
    /// When there is none.
    pub fn ensemble(&self, name: &str) -> &Ensemble {
        let found = self.ensembles.iter().find(|e| e.name == name);
        found.unwrap_or_else(|| panic!("no ensemble {name}"))
    }

    /// The ensembles of a case that differ by the size of the displacement alone, in the directions from `first` on.
    pub fn sizes(&self, case: u32, first: usize) -> Vec<&Ensemble> {
        let wanted = |e: &&Ensemble| e.case == case && e.first == first && e.changed.is_empty();
        self.ensembles.iter().filter(wanted).collect()
    }

    /// The ensembles of a case that differ by the size of the displacement alone, as one.
    pub fn together(&self, case: u32) -> Ensemble {
        let all = self.sizes(case, 0);
        let names: Vec<&str> = all.iter().map(|e| e.name.as_str()).collect();
        Ensemble {
            name: names.join(", "),
            members: all.iter().flat_map(|e| e.members.clone()).collect(),
            ..all[0].clone()
        }
    }

    /// The run of case 2 of this name.
    ///
    /// # Panics
    /// When there is none.
    pub fn single(&self, name: &str) -> &Single {
        let found = self.singles.iter().find(|s| s.name == name);
        found.unwrap_or_else(|| panic!("no run \"{name}\""))
    }

    /// The exponents of a case, one entry for each distance.
    pub fn exponents(&self, case: u32) -> impl Iterator<Item = &Exponents> {
        self.exponents.iter().filter(move |e| e.case == case)
    }
}

impl Ensemble {
    /// A measure of every member.
    pub fn values(&self, name: &str) -> Vec<f64> {
        self.members.iter().map(|m| m.measures.get(name)).collect()
    }

    /// Its mean and interval.
    pub fn mean(&self, name: &str) -> Interval {
        Interval::of(&self.values(name))
    }

    /// Mean and interval of a function of a measure.
    pub fn mean_of(&self, name: &str, f: impl Fn(f64) -> f64) -> Interval {
        let values: Vec<f64> = self.values(name).into_iter().map(f).collect();
        Interval::of(&values)
    }

    /// Mean and interval of a function of the same measure of this ensemble and another, member by member; they are
    /// independent, so any pairing will do.
    pub fn mean_with(&self, other: &Ensemble, name: &str, f: impl Fn(f64, f64) -> f64) -> Interval {
        let pairs = self.values(name).into_iter().zip(other.values(name));
        Interval::of(&pairs.map(|(a, b)| f(a, b)).collect::<Vec<f64>>())
    }

    /// The name and what its runs warn of.
    pub fn source(&self) -> WarningSource {
        let all: Vec<&[String]> = self.members.iter().map(|m| m.warnings.as_slice()).collect();
        WarningSource {
            name: format!("ensemble {}", self.name),
            warnings: merged(&all),
        }
    }
}

impl Exponents {
    /// Mean and interval \[1/s\].
    pub fn mean(&self) -> Interval {
        Interval::of(&self.values)
    }

    /// What its runs warn of.
    pub fn source(&self) -> WarningSource {
        let all: Vec<&[String]> = self.warnings.iter().map(Vec::as_slice).collect();
        WarningSource {
            name: format!(
                "exponents of case {} at d₀ = {:e}",
                self.case, self.distance
            ),
            warnings: merged(&all),
        }
    }
}

impl Single {
    /// The name and what it warns of.
    pub fn source(&self) -> WarningSource {
        WarningSource {
            name: format!("case 2, {}", self.name),
            warnings: self.warnings.clone(),
        }
    }
}

/// What was timed, with the day: times differ from run to run, so they are kept apart from the record.
#[derive(Debug, Serialize, Deserialize)]
pub struct KernelTimings {
    /// Day of the measurement.
    pub day: String,
    /// Elastic force and tangent of an element by the transcription of eqs. 14 and 15 \[s\].
    pub literal: f64,
    /// The same by five-point Gauss quadrature \[s\].
    pub gauss: f64,
    /// The same by the reduced tensor that simulations use \[s\].
    pub reduced: f64,
    /// One step of Bathe's method in case 2, reduced tensor \[s\].
    pub step: f64,
    /// Evaluations of force and tangent in that step.
    pub evaluations: f64,
}

/// The file of a record.
pub fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("figures")
        .join(name)
}

/// Writes a record.
///
/// # Errors
/// When the file cannot be written.
pub fn save(record: &impl Serialize, name: &str) -> Result<()> {
    let text = serde_json::to_string_pretty(record).into_diagnostic()?;
    let path = file(name);
    fs::write(&path, text + "\n")
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

/// Reads a record.
///
/// # Errors
/// When there is none, or one of another form; the message names the command that writes it.
pub fn load<T: DeserializeOwned>(name: &str) -> Result<T> {
    let path = file(name);
    let read = fs::read_to_string(&path).into_diagnostic();
    read.and_then(|text| serde_json::from_str(&text).into_diagnostic())
        .wrap_err_with(|| {
            format!(
                "cannot read {}; `cargo run --release -p paper-figures -- ensembles` writes it",
                path.display()
            )
        })
}
