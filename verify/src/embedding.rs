//! How Looselink's shared coordinates appear among the full ones of the reference.
//!
//! Every full coordinate is a copy of one of Looselink's, q_full = B q with one 1 a row of B. Then M = B^T M_full B, and
//! forces are B^T f_full: what the reference computes body by body is summed where Looselink shares a node.

use crate::channels::{coordinates, places};
use crate::description::Description;
use looselink::model::{BodyCoordinates, Model};

/// The matrix B as a list: the coordinate of Looselink that each full coordinate copies.
#[derive(Debug)]
pub struct Embedding {
    source: Vec<usize>,
    /// Coordinates of Looselink.
    count: usize,
}

impl Embedding {
    /// The copies of a scene's coordinates, matched body by body through the names.
    ///
    /// # Panics
    /// When the two sides do not have the same bodies.
    pub fn new(description: &Description, model: &Model, count: usize) -> Embedding {
        let bodies = &description.mechanism.bodies;
        let mut source = Vec::new();
        for ((name, body), place) in description.bodies.iter().zip(bodies).zip(places(bodies)) {
            assert_eq!(source.len(), place, "bodies stand one behind the other");
            let found = model.bodies().iter().find(|b| b.name == *name);
            let found = found.unwrap_or_else(|| panic!("Looselink has no body {name}"));
            match &found.coordinates {
                BodyCoordinates::Ground { .. } => {}
                BodyCoordinates::Rigid { x } => source.extend(*x..x + 3),
                BodyCoordinates::PointMass { x } => source.extend(*x..x + 2),
                BodyCoordinates::RigidLink { ends } => {
                    source.extend(ends.iter().flat_map(|&x| [x, x + 1]));
                }
                BodyCoordinates::FlexibleLink { nodes, slopes, .. } => {
                    let pairs = nodes.iter().zip(slopes);
                    source.extend(pairs.flat_map(|(&x, &s)| [x, x + 1, s, s + 1]));
                }
            }
            let size = coordinates(body);
            assert_eq!(source.len(), place + size, "{name} has {size} coordinates");
        }
        Embedding { source, count }
    }

    /// B x.
    pub fn spread(&self, x: &[f64]) -> Vec<f64> {
        self.source.iter().map(|&i| x[i]).collect()
    }

    /// B^T f.
    pub fn gather(&self, f: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.count];
        for (&i, f) in self.source.iter().zip(f) {
            sum[i] += f;
        }
        sum
    }

    /// The same with zeros where no coordinate has a copy.
    pub fn keep(&self, mut x: Vec<f64>) -> Vec<f64> {
        let mut copied = vec![false; self.count];
        self.source.iter().for_each(|&i| copied[i] = true);
        for (x, copied) in x.iter_mut().zip(copied) {
            if !copied {
                *x = 0.0;
            }
        }
        x
    }

    /// B^T K B, row by row.
    pub fn congruence(&self, k: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.count * self.count];
        for (row, &i) in k.chunks_exact(self.source.len()).zip(&self.source) {
            for (value, &j) in row.iter().zip(&self.source) {
                sum[i * self.count + j] += value;
            }
        }
        sum
    }

    /// Sets the coordinates below `end` that have a copy; copies of one coordinate agree on the manifold.
    pub fn take(&self, full: &[f64], x: &mut [f64], end: usize) {
        for (&i, value) in self.source.iter().zip(full) {
            if i < end {
                x[i] = *value;
            }
        }
    }
}
