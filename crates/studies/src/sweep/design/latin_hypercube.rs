//! A Latin hypercube (McKay, Beckman and Conover 1979): each of n equal parts of every range holds one of the n points, at a
//! random place.

use super::Design;
use crate::sweep::starts::{below, unit};
use crate::sweep::{FieldValue, SweepParameter};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Points in the unit cube.
#[derive(Debug)]
pub struct LatinHypercubeDesign {
    /// One list of coordinates a parameter.
    coordinates: Vec<Vec<f64>>,
}

impl LatinHypercubeDesign {
    /// So many points; equal seeds give equal points.
    pub fn new(parameters: usize, points: usize, seed: u64) -> LatinHypercubeDesign {
        let coordinates = (0..parameters).map(|parameter| {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(parameter as u64);
            let mut parts: Vec<usize> = (0..points).collect();
            // Fisher and Yates
            for last in (1..points).rev() {
                parts.swap(last, below(&mut random, last + 1));
            }
            let place = |part: usize| (part as f64 + unit(&mut random)) / points as f64;
            parts.into_iter().map(place).collect()
        });
        LatinHypercubeDesign {
            coordinates: coordinates.collect(),
        }
    }
}

impl Design for LatinHypercubeDesign {
    fn points(&self) -> usize {
        self.coordinates.first().map_or(0, Vec::len)
    }

    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue> {
        let places = parameters.iter().zip(&self.coordinates);
        places
            .map(|(parameter, u)| parameter.at(u[point]))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_every_range_is_visited_once() {
        let cube = LatinHypercubeDesign::new(3, 50, 7);
        for u in &cube.coordinates {
            let mut parts: Vec<usize> = u.iter().map(|u| (u * 50.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..50).collect::<Vec<_>>());
        }
        assert_ne!(cube.coordinates[0], cube.coordinates[1]);
        assert_ne!(
            cube.coordinates,
            LatinHypercubeDesign::new(3, 50, 8).coordinates,
            "the seed matters"
        );
    }
}
