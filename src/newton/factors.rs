//! A matrix of fixed pattern and its factors.

use super::{Counters, Failure};
use crate::math::lu::{DenseLu, Symbolic};

/// A matrix that is filled, factorised and solved many times.
#[derive(Debug)]
pub(super) struct Factors {
    pub values: Vec<f64>,
    /// Factors with row exchanges, where the fixed pivot order met a weak pivot.
    pub dense: Option<DenseLu>,
}

impl Factors {
    /// Memory for the pattern.
    pub fn new(symbolic: &Symbolic) -> Factors {
        Factors {
            values: vec![0.0; symbolic.len()],
            dense: None,
        }
    }

    /// Fills the matrix and factorises it; after a weak pivot, once more as a dense matrix with row exchanges.
    pub fn renew(
        &mut self,
        symbolic: &Symbolic,
        counters: &mut Counters,
        mut fill: impl FnMut(&mut [f64]),
    ) -> Result<(), Failure> {
        counters.factorisations += 1;
        self.dense = None;
        fill(&mut self.values);
        if let Err(weak) = symbolic.factor(&mut self.values) {
            counters.fallbacks += 1;
            fill(&mut self.values);
            self.dense = DenseLu::factor(symbolic, &self.values);
            if self.dense.is_none() {
                return Err(Failure::Singular { index: weak.index });
            }
        }
        Ok(())
    }

    /// Solves in place.
    pub fn solve(&self, symbolic: &Symbolic, b: &mut [f64]) {
        match &self.dense {
            None => symbolic.solve(&self.values, b),
            Some(dense) => dense.solve(b),
        }
    }
}
