//! What the file of a sweep says.

use super::design::DesignKind;
use super::{EnvelopePlan, FieldValue, Measure, Starts, SweepParameter, SweepTarget};
use crate::study_file::{StudyError, parsed};
use indexmap::IndexMap;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// More runs than anybody makes; the numbers of this many fit into memory.
const MOST_RUNS: usize = 100_000_000;

/// A scene, what is changed in it, and what is measured.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepStudy {
    /// What is asked, in a line.
    pub title: String,
    /// The scene, a path beside the study file.
    pub scene: PathBuf,
    /// Changes `path=value` of every run.
    #[serde(default)]
    pub set: Vec<String>,
    /// Which points are visited.
    #[serde(default)]
    pub design: DesignKind,
    /// How many points, or samples, a design has that is sampled.
    pub samples: Option<usize>,
    /// Seed of everything random.
    #[serde(default)]
    pub seed: u64,
    /// What varies, in the order of the file.
    pub parameters: IndexMap<String, SweepParameter>,
    /// Several starts of every point.
    pub starts: Option<Starts>,
    /// What is measured of every run.
    pub measures: IndexMap<String, Measure>,
    /// What is kept of its course.
    #[serde(default)]
    pub envelopes: IndexMap<String, EnvelopePlan>,
    /// What a bisection is to reach.
    pub target: Option<SweepTarget>,
}

impl SweepStudy {
    /// Reads a study from text; `path` stands for the file in errors. A target replaces that of the file, and makes the study a
    /// bisection.
    ///
    /// # Errors
    /// The first fault found.
    pub fn parse(
        path: &Path,
        text: &str,
        target: Option<&SweepTarget>,
    ) -> Result<SweepStudy, StudyError> {
        let mut study: SweepStudy = parsed(path, text)?;
        if let Some(target) = target {
            study.design = DesignKind::Bisection;
            study.samples = None;
            let parameters = study.parameters.values_mut();
            parameters.for_each(|parameter| parameter.count = None);
            let tolerance = study.target.map_or(target.tolerance, |own| own.tolerance);
            study.target = Some(SweepTarget {
                tolerance,
                ..target.clone()
            });
        }
        study.scene = path.with_file_name(&study.scene);
        match study.check() {
            Ok(()) => Ok(study),
            Err(message) => Err(StudyError::of_key(path, text, &message)),
        }
    }

    fn check(&self) -> Result<(), String> {
        if self.parameters.is_empty() || self.measures.is_empty() {
            return Err(
                "a sweep needs at least one table `[parameters.NAME]` and one `[measures.NAME]`"
                    .into(),
            );
        }
        let kind = self.design;
        match (&self.target, kind == DesignKind::Bisection) {
            (None, true) => {
                return Err("`design` is a bisection, which needs a table `[target]`".to_owned());
            }
            (Some(_), false) => {
                let message = "`target` belongs to a bisection: add `design = \"bisection\"`";
                return Err(message.to_owned());
            }
            _ => {}
        }
        let grid = kind == DesignKind::Grid || kind == DesignKind::List;
        for (name, parameter) in &self.parameters {
            let fault = |message| format!("`parameters.{name}` {message}");
            parameter.check(grid).map_err(fault)?;
        }
        for (name, measure) in &self.measures {
            let fault = |message| format!("`measures.{name}` {message}");
            measure.check().map_err(fault)?;
        }
        for (name, envelope) in &self.envelopes {
            let fault = |message| format!("`envelopes.{name}` {message}");
            envelope.check().map_err(fault)?;
        }
        self.check_names()?;
        let points = self.samples.unwrap_or(1);
        self.runs(points)?;
        match (kind.is_sampled(), self.samples) {
            (true, None | Some(0 | 1)) => {
                return Err("this design needs `samples`, two or more".to_owned());
            }
            (false, Some(_)) => {
                return Err(
                    "`samples` belongs to the designs latin_hypercube, sobol and sensitivity"
                        .into(),
                );
            }
            _ => {}
        }
        if let Some(target) = &self.target {
            target.check(self)?;
        }
        match self.starts {
            Some(Starts { count, velocity })
                if !(count >= 1 && velocity > 0.0 && velocity.is_finite()) =>
            {
                Err("`starts` needs a `count` of 1 at least and a `velocity` above 0".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Columns of the table have one name each.
    fn check_names(&self) -> Result<(), String> {
        let mut names: Vec<&str> = super::columns::OWN.to_vec();
        let mut paths: Vec<&str> = vec!["output.channels", "output.motion"];
        for (name, parameter) in &self.parameters {
            for field in &parameter.fields {
                if paths.contains(&field.path()) {
                    return Err(format!(
                        "`parameters.{name}` sets `{}`, which the sweep or another parameter sets already",
                        field.path()
                    ));
                }
                paths.push(field.path());
            }
        }
        let parameters = self.parameters.keys().map(|name| ("parameters", name));
        let measures = self.measures.keys().map(|name| ("measures", name));
        for (table, name) in parameters.chain(measures) {
            if names.contains(&name.as_str()) {
                return Err(format!(
                    "`{table}.{name}` needs another name: the table of runs has a column `{name}` already"
                ));
            }
            names.push(name);
        }
        Ok(())
    }

    /// Starts of every point.
    pub fn starts_of_a_point(&self) -> usize {
        self.starts.map_or(1, |starts| starts.count)
    }

    /// The parameters without their names.
    pub fn parameter_list(&self) -> Vec<&SweepParameter> {
        self.parameters.values().collect()
    }

    /// All channels that are measured.
    pub(super) fn channels(&self) -> Vec<String> {
        let measured = self.measures.values().flat_map(Measure::recorded);
        let kept = self.envelopes.values();
        let kept = kept.flat_map(|plan| plan.channels.iter().cloned());
        let mut names = vec!["t".to_owned()];
        for name in measured.chain(kept) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    /// The changes to the scene of a run with these values.
    pub fn overrides(&self, values: &[FieldValue]) -> Vec<String> {
        let mut overrides = self.set.clone();
        for (parameter, value) in self.parameters.values().zip(values) {
            overrides.extend(parameter.overrides(value));
        }
        overrides.push(format!("output.channels={:?}", self.channels()));
        overrides.push("output.motion=false".to_owned());
        overrides
    }

    /// The number of runs of so many points.
    ///
    /// # Errors
    /// Too many.
    pub(super) fn runs(&self, points: usize) -> Result<usize, String> {
        let runs = points.checked_mul(self.starts_of_a_point());
        let runs = runs.filter(|runs| *runs <= MOST_RUNS);
        runs.ok_or_else(|| format!("the sweep has more than {MOST_RUNS} runs"))
    }
}
