//! What the statements are decided by.

use crate::ensembles::{Ensemble, EnsembleRecord};
use crate::figures::{FigureRecord, PERIODS};
use crate::measures::{AFTER_ONSET, PEAKS, SIMULTANEOUS};
use crate::methods::HORIZON;
use crate::pictures::CLAIMED;
use crate::runs::{DURATION, FROM};
use minijinja::{Value, context};
use statistics::Interval;
use std::cell::Cell;
use std::collections::BTreeMap;

/// Young's modulus of aluminium \[Pa\].
pub const ALUMINIUM: f64 = 70e9;

/// The results of `figures` and `ensembles`.
pub struct Evidence<'a> {
    figures: &'a FigureRecord,
    ensembles: &'a EnsembleRecord,
    /// Cases 3 and 4, each from all starts together.
    chaotic: [Ensemble; 2],
    /// True once the ensembles have been asked.
    asked: Cell<bool>,
}

impl<'a> Evidence<'a> {
    /// All starts of cases 3 and 4 together.
    pub fn of(figures: &'a FigureRecord, ensembles: &'a EnsembleRecord) -> Evidence<'a> {
        Evidence {
            figures,
            ensembles,
            chaotic: [3, 4].map(|case| Ensemble::together(&ensembles.sizes(case))),
            asked: Cell::default(),
        }
    }

    /// What the templates of all statements may use: `run.<name>.<measure>` of the figures, the means `case3.<measure>` and
    /// `case4.<measure>`, `numbers`, `timings` and constants.
    pub fn values(&self) -> Value {
        let runs = self.figures.runs.iter();
        let run: BTreeMap<&str, _> = runs.map(|run| (&*run.name, &run.measures)).collect();
        let [case3, case4] = self.chaotic.each_ref().map(Ensemble::means);
        context! {
            run, case3, case4, numbers => self.figures.numbers, timings => self.ensembles.timings,
            claimed => CLAIMED, aluminium => ALUMINIUM, horizon => HORIZON, periods => PERIODS, peaks => PEAKS,
            after_onset => AFTER_ONSET, simultaneous => SIMULTANEOUS, from => FROM, duration => DURATION,
        }
    }

    /// Whether the ensembles have been asked since the last call.
    pub fn asked(&self) -> bool {
        self.asked.take()
    }

    /// The results of `ensembles`.
    pub fn ensembles(&self) -> &EnsembleRecord {
        self.asked.set(true);
        self.ensembles
    }

    /// A number of the scenes or of several runs.
    pub fn number(&self, name: &str) -> f64 {
        self.figures.numbers.get(name)
    }

    /// A measure of a run of the figures.
    ///
    /// # Panics
    /// When there is no such run.
    pub fn run(&self, name: &str, measure: &str) -> f64 {
        let run = self.figures.runs.iter().find(|r| r.name == name);
        let run = run.unwrap_or_else(|| panic!("no run {name}"));
        run.measures.get(measure)
    }

    /// A measure of case 2 with the fine and the coarse step.
    pub fn steps(&self, measure: &str) -> [f64; 2] {
        ["flexible", "coarse"].map(|run| self.run(run, measure))
    }

    /// The runs of case 3 or 4.
    pub fn chaotic(&self, case: u32) -> &Ensemble {
        self.ensembles();
        &self.chaotic[usize::from(case == 4)]
    }

    /// A measure of all runs of cases 3 and 4.
    pub fn both(&self, measure: &str) -> Vec<f64> {
        let [loose, both] = [3, 4].map(|case| self.chaotic(case).values(measure));
        [loose, both].concat()
    }

    /// Means of a measure in cases 3 and 4.
    pub fn means(&self, measure: &str) -> [Interval; 2] {
        self.means_of(measure, |x| x)
    }

    /// Means of a function of a measure in cases 3 and 4.
    pub fn means_of(&self, measure: &str, of: impl Fn(f64) -> f64) -> [Interval; 2] {
        [3, 4].map(|case| {
            let values = self.chaotic(case).values(measure).iter().map(|x| of(*x));
            Interval::of(&values.collect::<Vec<f64>>())
        })
    }

    /// Mean of a function of a measure of case 4 and the same of case 3, run by run; they are independent, so any pairing will do.
    pub fn pairs(&self, measure: &str, of: impl Fn(f64, f64) -> f64) -> Interval {
        self.chaotic(4).pairs(self.chaotic(3), measure, of)
    }

    /// A measure of a further run of case 2.
    pub fn single(&self, name: &str, measure: &str) -> f64 {
        self.ensembles().ensemble(name).values(measure)[0]
    }
}
