//! How far two runs are apart, in several norms.

use super::diagram::figure;
use super::table::table;
use super::{ColumnLookup, Compared, Found, Study, WorkCounts, column};
use crate::StudyError;
use plot::Figure;
use serde::{Deserialize, Serialize};

/// The distance of a run from the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Largest difference of a position over the whole time \[m\].
    pub position: f64,
    /// Largest difference of an acceleration \[m/s2\].
    pub acceleration: f64,
    /// Largest difference of an impulse, the integral of a force from the start \[N s\].
    pub impulse: f64,
    /// Largest energy lost or gained by the integrator \[J\]; of the run alone.
    pub energy: f64,
    /// Largest difference of any coordinate, as the distance by which it moves a point of its body \[m\]: what an accuracy is
    /// about. None for runs of other programs, and where the reference has another mesh.
    pub motion: Option<f64>,
}

/// A norm: name, unit, how to take it.
pub type Norm = (&'static str, &'static str, fn(&Errors) -> f64);

/// All norms.
pub const NORMS: [Norm; 4] = [
    ("position", "m", |e| e.position),
    ("acceleration", "m/s²", |e| e.acceleration),
    ("impulse", "N s", |e| e.impulse),
    ("energy", "J", |e| e.energy),
];

/// The reference of a study of errors.
#[derive(Debug, Serialize, Deserialize)]
pub struct MotionReference {
    /// Difference between the two runs of the reference: nothing below it is distinguished.
    pub floor: Errors,
    /// What the fine one recorded.
    #[serde(skip)]
    exact: RecordedSeries,
}

/// What a run that reached its end gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredRun {
    /// Against the reference.
    pub errors: Errors,
    /// Work done.
    pub work: WorkCounts,
}

impl Compared for MotionReference {
    type Kept = RecordedSeries;
    type Measured = MeasuredRun;
    const FIGURE: &str = "Work and precision";

    fn keep(
        study: &Study,
        get: ColumnLookup,
        motion: Option<Vec<f64>>,
    ) -> Result<RecordedSeries, StudyError> {
        let columns = |names: &[String]| {
            let columns = names.iter().map(|name| Ok(column(get, name)?.to_vec()));
            columns.collect::<Result<Vec<_>, StudyError>>()
        };
        Ok(RecordedSeries {
            interval: study.interval,
            position: columns(&study.position)?,
            acceleration: columns(&study.acceleration)?,
            force: columns(&study.force)?,
            energy: column(get, "energy.numerical")?.to_vec(),
            motion,
        })
    }

    fn new(coarse: RecordedSeries, fine: RecordedSeries) -> MotionReference {
        MotionReference {
            floor: coarse.errors(&fine),
            exact: fine,
        }
    }

    fn measure(&self, kept: RecordedSeries, work: WorkCounts) -> MeasuredRun {
        let errors = kept.errors(&self.exact);
        MeasuredRun { errors, work }
    }

    fn table(found: &Found<MotionReference>, _: &Study) -> String {
        table(found)
    }

    fn figure(found: &Found<MotionReference>, study: &Study) -> Figure {
        figure(study, found)
    }
}

/// What a run recorded of what is compared.
#[derive(Debug, Default)]
pub struct RecordedSeries {
    interval: f64,
    position: Vec<Vec<f64>>,
    acceleration: Vec<Vec<f64>>,
    force: Vec<Vec<f64>>,
    energy: Vec<f64>,
    motion: Option<Vec<f64>>,
}

impl RecordedSeries {
    fn errors(&self, exact: &RecordedSeries) -> Errors {
        Errors {
            position: largest(&self.position, &exact.position),
            acceleration: largest(&self.acceleration, &exact.acceleration),
            impulse: self.largest_impulse(exact),
            energy: self.energy.iter().fold(0.0, |m, e| larger(m, *e)),
            motion: self.motion_error(exact),
        }
    }

    fn motion_error(&self, exact: &RecordedSeries) -> Option<f64> {
        let (own, exact) = (self.motion.as_ref()?, exact.motion.as_ref()?);
        let pairs = own.iter().zip(exact);
        let same_mesh = own.len() == exact.len();
        same_mesh.then(|| pairs.fold(0.0, |m, (a, b)| larger(m, a - b)))
    }

    /// By the trapezoidal rule between rows, the same for both.
    fn largest_impulse(&self, exact: &RecordedSeries) -> f64 {
        let mut largest = 0.0;
        for (a, b) in self.force.iter().zip(&exact.force) {
            let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
            let mut impulse = 0.0;
            for pair in difference.windows(2) {
                impulse += 0.5 * self.interval * (pair[0] + pair[1]);
                largest = larger(largest, impulse);
            }
        }
        largest
    }
}

fn largest(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.iter().zip(b));
    pairs.fold(0.0, |m, (a, b)| larger(m, a - b))
}

/// The larger magnitude; what is not a number is larger than all.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.abs() <= a {
        a
    } else {
        b.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::larger;

    #[test]
    fn what_is_not_a_number_stays_the_largest() {
        let all = [1.0, f64::NAN, -2.0, 3.0];
        assert!(all.into_iter().fold(0.0, larger).is_nan());
        assert_eq!([1.0, -4.0, 3.0].into_iter().fold(0.0, larger), 4.0);
    }
}
