//! What the statements are decided by, and a note of everything that is read.

use crate::ensembles::{Ensemble, EnsembleRecord};
use crate::exponents::Exponents;
use crate::figures::{FigureRecord, RunRecord};
use crate::methods::{Long, MethodWork};
use crate::timings::KernelTimings;
use records::Record;
use serde::Serialize;
use statistics::Interval;
use std::cell::RefCell;

/// The records of `figures` and `ensembles`.
pub struct Evidence<'a> {
    figures: &'a Record<FigureRecord>,
    ensembles: &'a Record<EnsembleRecord>,
    /// Cases 3 and 4, each from all starts together.
    chaotic: [Ensemble; 2],
    read: RefCell<Vec<ReadSource>>,
}

/// Runs that a statement rests on.
#[derive(Debug, Serialize)]
pub struct ReadSource {
    /// How the pages call them.
    pub name: String,
    /// What they warn of.
    pub warnings: Vec<String>,
    /// Whether they are of the campaign `ensembles`.
    pub of_ensembles: bool,
}

impl<'a> Evidence<'a> {
    /// All starts of cases 3 and 4 together.
    pub fn of(
        figures: &'a Record<FigureRecord>,
        ensembles: &'a Record<EnsembleRecord>,
    ) -> Evidence<'a> {
        let chaotic = [3, 4].map(|case| Ensemble::together(&ensembles.results.sizes(case)));
        Evidence {
            figures,
            ensembles,
            chaotic,
            read: RefCell::default(),
        }
    }

    /// What has been read since the last call, each source once.
    pub fn take_sources(&self) -> Vec<ReadSource> {
        self.read.take()
    }

    fn note(&self, name: String, warnings: &[String], of_ensembles: bool) {
        let mut read = self.read.borrow_mut();
        if read.iter().all(|source| source.name != name) {
            let warnings = warnings.to_vec();
            read.push(ReadSource {
                name,
                warnings,
                of_ensembles,
            });
        }
    }

    /// A number of the scenes or of several runs.
    pub fn number(&self, name: &str) -> f64 {
        self.figures.results.numbers.get(name)
    }

    /// A measure of a run of the figures.
    ///
    /// # Panics
    /// When there is no such run.
    pub fn run(&self, name: &str, measure: &str) -> f64 {
        let found = self.figures.results.runs.iter().find(|r| r.name == name);
        let run: &RunRecord = found.unwrap_or_else(|| panic!("no run {name}"));
        let name = format!("case {}, {}", run.case, run.how);
        self.note(name, &run.warnings, false);
        run.measures.get(measure)
    }

    /// A measure of case 2 with the fine and the coarse step.
    pub fn steps(&self, measure: &str) -> [f64; 2] {
        ["flexible", "coarse"].map(|run| self.run(run, measure))
    }

    /// The runs of case 3 or 4.
    pub fn chaotic(&self, case: u32) -> &Ensemble {
        let ensemble = &self.chaotic[usize::from(case == 4)];
        self.note_ensemble(ensemble);
        ensemble
    }

    /// An ensemble by its name.
    pub fn ensemble(&self, name: &str) -> &Ensemble {
        let ensemble = self.ensembles.results.ensemble(name);
        self.note_ensemble(ensemble);
        ensemble
    }

    fn note_ensemble(&self, ensemble: &Ensemble) {
        let name = format!("runs {}", ensemble.name);
        self.note(name, &ensemble.warnings, true);
    }

    /// Means of a measure in cases 3 and 4.
    pub fn means(&self, measure: &str) -> [Interval; 2] {
        [3, 4].map(|case| self.chaotic(case).mean(measure))
    }

    /// Means of a function of a measure in cases 3 and 4.
    pub fn means_of(&self, measure: &str, of: impl Fn(f64) -> f64) -> [Interval; 2] {
        [3, 4].map(|case| {
            let values = self.chaotic(case).values(measure).iter();
            Interval::of(&values.map(|x| of(*x)).collect::<Vec<f64>>())
        })
    }

    /// Mean of a function of a measure of case 4 and the same of case 3, run by run; they are independent, so any pairing will do.
    pub fn pairs(&self, measure: &str, of: impl Fn(f64, f64) -> f64) -> Interval {
        let [loose, both] = [3, 4].map(|case| self.chaotic(case).values(measure));
        let pairs = both.iter().zip(loose);
        let values = pairs.map(|(both, loose)| of(*both, *loose));
        Interval::of(&values.collect::<Vec<f64>>())
    }

    /// A measure of a further run of case 2.
    pub fn single(&self, name: &str, measure: &str) -> f64 {
        self.ensemble(name).values(measure)[0]
    }

    /// The Lyapunov exponents of a case.
    pub fn exponents(&self, case: u32) -> Vec<&Exponents> {
        let all: Vec<&Exponents> = self.ensembles.results.exponents(case).collect();
        for x in &all {
            let name = format!("exponents of case {case} at d₀ = {:e}", x.distance);
            self.note(name, &x.warnings, true);
        }
        all
    }

    /// All runs of the comparison of methods, of which those that decide are to be noted with [`Evidence::rests_on`].
    pub fn work(&self) -> &[MethodWork] {
        self.note("comparison of methods".into(), &[], true);
        &self.ensembles.results.work
    }

    /// Notes a run of the comparison of methods.
    pub fn rests_on(&self, work: &MethodWork) {
        self.note(work.name(), &work.warnings, true);
    }

    /// The long runs with some methods.
    pub fn long(&self, wanted: impl Fn(&str) -> bool) -> Vec<&Long> {
        let all = self.ensembles.results.long.iter();
        let all: Vec<&Long> = all.filter(|long| wanted(&long.method)).collect();
        for long in &all {
            self.note(long.name(), &long.warnings, true);
        }
        all
    }

    /// The times.
    pub fn timings(&self) -> &KernelTimings {
        self.note("times of kernels and steps".into(), &[], true);
        &self.ensembles.results.timings
    }
}
