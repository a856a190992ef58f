//! Every combination of the values; those of the last parameter follow each other.

use super::Design;
use crate::sweep::{FieldValue, SweepParameter};

/// More points are a mistake.
const MOST: usize = 1_000_000_000;

/// A grid with so many values of every parameter.
#[derive(Debug)]
pub struct GridDesign {
    points: usize,
}

impl GridDesign {
    /// # Errors
    /// More than a thousand million points.
    pub fn new(parameters: &[&SweepParameter]) -> Result<GridDesign, String> {
        let mut counts = parameters.iter().map(|parameter| parameter.levels());
        let points = counts.try_fold(1_usize, usize::checked_mul);
        match points.filter(|points| *points <= MOST) {
            Some(points) => Ok(GridDesign { points }),
            None => Err(format!("the grid has more than {MOST} points")),
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
