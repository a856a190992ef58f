//! Every combination of the values; those of the last parameter follow each other.

use super::Design;
use crate::sweep::{FieldValue, SweepParameter};

/// A grid with so many values of every parameter.
#[derive(Debug)]
pub struct GridDesign {
    points: usize,
}

impl GridDesign {
    /// All combinations; a number of points that cannot be counted is the largest there is.
    pub fn new(parameters: &[&SweepParameter]) -> GridDesign {
        let counts = parameters.iter().map(|parameter| parameter.levels());
        GridDesign {
            points: counts.fold(1, usize::saturating_mul),
        }
    }
}

impl Design for GridDesign {
    fn points(&self) -> usize {
        self.points
    }

    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue> {
        let mut rest = point;
        let backward = parameters.iter().rev().map(|parameter| {
            let level = rest % parameter.levels();
            rest /= parameter.levels();
            parameter.level(level)
        });
        let mut values: Vec<FieldValue> = backward.collect();
        values.reverse();
        values
    }
}
