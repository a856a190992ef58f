//! Points that the study writes down one by one.

use super::Design;
use crate::sweep::{FieldValue, SweepParameter};

/// As many points as every parameter has values.
#[derive(Debug)]
pub struct ListDesign {
    points: usize,
}

impl ListDesign {
    /// # Errors
    /// Parameters with unequal numbers of values.
    pub fn new(parameters: &[&SweepParameter]) -> Result<ListDesign, String> {
        let mut counts: Vec<usize> = parameters.iter().map(|p| p.levels()).collect();
        counts.dedup();
        match counts[..] {
            [points] => Ok(ListDesign { points }),
            _ => Err(format!(
                "a list needs as many values of every parameter, not {counts:?}"
            )),
        }
    }
}

impl Design for ListDesign {
    fn points(&self) -> usize {
        self.points
    }

    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue> {
        let values = parameters.iter();
        values.map(|parameter| parameter.level(point)).collect()
    }
}
