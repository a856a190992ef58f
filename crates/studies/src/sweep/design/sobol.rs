//! A Sobol sequence with Owen's scrambling (Burley 2020, <https://jcgt.org/published/0009/04/01/>): points that fill the ranges
//! evenly, the more so if their number is a power of two.

use super::Design;
use crate::sweep::{FieldValue, SweepParameter};

/// Most points that the generator has.
pub(super) const MOST: usize = 1 << 16;

/// The first points of the sequence.
#[derive(Debug)]
pub struct SobolDesign {
    points: usize,
    seed: u32,
}

impl SobolDesign {
    /// So many points; equal seeds give equal points.
    ///
    /// # Errors
    /// More dimensions or points than the sequence has.
    pub fn new(parameters: usize, points: usize, seed: u64) -> Result<SobolDesign, String> {
        let dimensions = sobol_burley::NUM_DIMENSIONS as usize;
        if parameters > dimensions {
            return Err(format!(
                "a Sobol sequence has {dimensions} parameters at most"
            ));
        }
        if points > MOST {
            return Err(format!("a Sobol sequence has {MOST} points at most"));
        }
        let seed = u32::try_from(seed).map_err(|_| "`seed` must be below 2^32")?;
        Ok(SobolDesign { points, seed })
    }
}

/// A coordinate of a point, 0 <= u < 1, in steps of 2^-24.
pub(super) fn coordinate(point: usize, dimension: usize, seed: u32) -> f64 {
    f64::from(sobol_burley::sample(point as u32, dimension as u32, seed))
}

impl Design for SobolDesign {
    fn points(&self) -> usize {
        self.points
    }

    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue> {
        let places = parameters.iter().enumerate();
        places
            .map(|(j, parameter)| parameter.at(coordinate(point, j, self.seed)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_elementary_interval_holds_one_point() {
        // 64 points, in any two of the first four dimensions: one in each of 8 x 8 squares would need t = 0, which the first
        // two dimensions have; each of 64 strips of every dimension holds one
        for dimension in 0..4 {
            let mut strips: Vec<usize> = (0..64)
                .map(|point| (coordinate(point, dimension, 3) * 64.0) as usize)
                .collect();
            strips.sort_unstable();
            assert_eq!(strips, (0..64).collect::<Vec<_>>());
        }
        let mut squares: Vec<[usize; 2]> = (0..64)
            .map(|point| [0, 1].map(|d| (coordinate(point, d, 3) * 8.0) as usize))
            .collect();
        squares.sort_unstable();
        squares.dedup();
        assert_eq!(squares.len(), 64);
    }
}
