//! Points from which Sobol indices are estimated (Saltelli et al. 2010, <https://doi.org/10.1016/j.cpc.2009.09.018>).
//!
//! Two independent samples A and B of the parameters and, for each parameter i, the sample A with parameter i of B. The first
//! halves of the points of a Sobol sequence in twice as many dimensions are A, the second halves B.

use super::Design;
use super::sobol::{MOST, coordinate};
use crate::sweep::{FieldValue, SweepParameter};

/// For each of the samples: a point of A, one of B, then one for each parameter.
#[derive(Debug)]
pub struct SensitivityDesign {
    parameters: usize,
    samples: usize,
    seed: u32,
}

impl SensitivityDesign {
    /// So many samples of d parameters: `samples` (d + 2) points.
    ///
    /// # Errors
    /// More dimensions or points than the sequence has.
    pub fn new(parameters: usize, samples: usize, seed: u64) -> Result<SensitivityDesign, String> {
        let most = sobol_burley::NUM_DIMENSIONS as usize / 2;
        if parameters > most {
            return Err(format!("sensitivity is of {most} parameters at most"));
        }
        if samples > MOST {
            return Err(format!("sensitivity has {MOST} samples at most"));
        }
        Ok(SensitivityDesign {
            parameters,
            samples,
            seed: u32::try_from(seed).map_err(|_| "`seed` must be below 2^32")?,
        })
    }

    /// Points of one sample.
    pub fn block(parameters: usize) -> usize {
        parameters + 2
    }

    /// The coordinates of a point in the unit cube.
    fn place(&self, point: usize) -> impl Iterator<Item = f64> {
        let block = SensitivityDesign::block(self.parameters);
        let (sample, which) = (point / block, point % block);
        let (d, seed) = (self.parameters, self.seed);
        (0..d).map(move |j| {
            let of_b = which == 1 || which == j + 2;
            coordinate(sample, if of_b { d + j } else { j }, seed)
        })
    }
}

impl Design for SensitivityDesign {
    fn points(&self) -> usize {
        self.samples * SensitivityDesign::block(self.parameters)
    }

    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue> {
        let places = parameters.iter().zip(self.place(point));
        places.map(|(parameter, u)| parameter.at(u)).collect()
    }
}

#[cfg(test)]
impl SensitivityDesign {
    /// The coordinates of every point.
    pub(in crate::sweep) fn places(&self) -> Vec<Vec<f64>> {
        (0..self.points())
            .map(|point| self.place(point).collect())
            .collect()
    }
}
