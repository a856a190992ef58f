//! Damping proportional to mass, the first half of Rayleigh's.

use super::{Force, LocalMatrix, WIDTH};
use crate::effect::Effect;
use crate::ledger::{self, Entry, Powers};
use crate::system::{State, Weights};

/// f = alpha M v on the coordinates of one element or link; it resists rigid motion too.
#[derive(Debug)]
pub struct MassDamping {
    /// Coordinates of the mass matrix.
    pub coordinates: Vec<usize>,
    /// alpha M, row by row \[kg/s\].
    pub values: Vec<f64>,
}

impl MassDamping {
    fn product(&self, at: &State) -> [f64; WIDTH] {
        let n = self.coordinates.len();
        let mut product = [0.0; WIDTH];
        for (p, row) in product.iter_mut().zip(self.values.chunks_exact(n)) {
            *p = row
                .iter()
                .zip(&self.coordinates)
                .map(|(m, &i)| m * at.v[i])
                .sum();
        }
        product
    }
}

impl Force for MassDamping {
    fn effect(&self) -> Effect {
        "mass_damping"
    }

    fn is_smooth(&self) -> bool {
        true
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [vec![], self.coordinates.clone()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        for (f, p) in f.iter_mut().zip(self.product(at)) {
            *f += p;
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        self.force(at, f);
        let n = self.coordinates.len();
        for (k, row) in k.iter_mut().zip(self.values.chunks_exact(n)) {
            for (k, m) in k.iter_mut().zip(row) {
                *k += w.v * m;
            }
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::DAMPING]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let product = self.product(at);
        let power = self
            .coordinates
            .iter()
            .zip(product)
            .map(|(&i, p)| at.v[i] * p);
        powers.add(0, power.sum::<f64>());
    }
}
