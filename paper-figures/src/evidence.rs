//! Everything that the statements are decided by.

use crate::campaign::Campaign;
use crate::interval::CriterionVerdict;
use crate::measures::Measures;
use crate::record::{Ensemble, EnsembleRecord, KernelTimings};
use crate::runs::CaseRecording;
use crate::statement::{Basis, Statement};
use crate::warned::WarningSource;

/// The runs of the main job, what they measure, and the records of `ensembles`.
#[derive(Clone)]
pub struct Evidence<'a> {
    /// The runs of the figures.
    pub c: &'a Campaign,
    /// The record of the ensembles.
    pub e: &'a EnsembleRecord,
    /// The record of times.
    pub t: &'a KernelTimings,
    loose: Ensemble,
    both: Ensemble,
    /// Case 1.
    pub ideal: Measures,
    /// Case 2, fine step.
    pub flexible: Measures,
    /// Case 2, coarse step.
    pub flexible_coarse: Measures,
}

impl<'a> Evidence<'a> {
    /// Measures the runs that are not chaotic.
    pub fn of(c: &'a Campaign, e: &'a EnsembleRecord, t: &'a KernelTimings) -> Evidence<'a> {
        let measure = |r: &CaseRecording| Measures::of(&c.geometry, r);
        Evidence {
            c,
            e,
            t,
            loose: e.together(3),
            both: e.together(4),
            ideal: measure(&c.ideal),
            flexible: measure(&c.flexible),
            flexible_coarse: measure(&c.flexible_coarse),
        }
    }

    /// The same with the ensembles of one size of the displacement alone, and that size \[m\].
    pub fn of_each_size(&self) -> Vec<(Evidence<'a>, f64)> {
        let pairs = self.e.sizes(3, 0).into_iter().zip(self.e.sizes(4, 0));
        let alone = |(loose, both): (&Ensemble, &Ensemble)| Evidence {
            loose: loose.clone(),
            both: both.clone(),
            ..self.clone()
        };
        pairs.map(|pair| (alone(pair), pair.0.moved)).collect()
    }

    /// The ensembles of case 3 together.
    pub fn loose(&self) -> &Ensemble {
        &self.loose
    }

    /// The ensembles of case 4 together.
    pub fn both(&self) -> &Ensemble {
        &self.both
    }

    /// The ensembles of cases 3 and 4.
    pub fn ensembles(&self) -> Vec<WarningSource> {
        vec![self.loose().source(), self.both().source()]
    }

    /// Both runs of case 2, and the ensembles of cases 3 and 4.
    pub fn all_cases(&self) -> Vec<WarningSource> {
        let mut sources = self.case_2();
        sources.extend(self.ensembles());
        sources
    }

    /// Both runs of case 2.
    pub fn case_2(&self) -> Vec<WarningSource> {
        vec![self.c.flexible.source(), self.c.flexible_coarse.source()]
    }
}

/// A statement to be filled in.
pub fn statement(key: &'static str, place: &'static str, says: &'static str) -> Statement {
    Statement {
        key,
        place,
        says,
        measured: String::new(),
        criterion: "",
        verdict: CriterionVerdict::Undecided,
        basis: Basis::Measurement,
        factor: None,
        why: String::new(),
        sources: Vec::new(),
    }
}
