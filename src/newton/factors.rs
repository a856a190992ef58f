//! A matrix of fixed pattern and its factors.

use super::{Counters, Failure};
use crate::checkpoint::{Carried, Checkpoint};
use crate::math::lu::{DenseLu, Symbolic};

/// A matrix that is filled, factorised and solved many times.
#[derive(Debug, Clone)]
pub(crate) struct Factors {
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

    /// Fills the matrix and factorises it in the fixed pivot order, with a limit of its multipliers; after a weak pivot, once more as a
    /// dense matrix with row exchanges.
    ///
    /// # Errors
    /// The matrix is singular to rounding.
    pub fn renew(
        &mut self,
        symbolic: &Symbolic,
        limit: f64,
        counters: &mut Counters,
        mut fill: impl FnMut(&mut [f64]),
    ) -> Result<(), Failure> {
        counters.factorisations += 1;
        self.dense = None;
        fill(&mut self.values);
        if let Err(weak) = symbolic.factor_within(&mut self.values, limit) {
            counters.fallbacks += 1;
            fill(&mut self.values);
            self.dense = DenseLu::factor(symbolic.to_dense(&self.values));
            if self.dense.is_none() {
                return Err(weak.into());
            }
        }
        Ok(())
    }

    /// Carries the factors; `values` beside dense factors are the matrix itself.
    pub fn carry(&mut self, symbolic: &Symbolic, checkpoint: &mut Checkpoint) {
        let Factors { values, dense } = self;
        let mut is_dense = dense.is_some();
        is_dense.carry(checkpoint);
        values.carry(checkpoint);
        *dense = match is_dense {
            true => DenseLu::factor(symbolic.to_dense(values)),
            false => None,
        };
    }

    /// Solves in place.
    pub fn solve(&self, symbolic: &Symbolic, b: &mut [f64]) {
        match &self.dense {
            None => symbolic.solve(&self.values, b),
            Some(dense) => dense.solve(b),
        }
    }

    /// Solves for two right sides at once, in place; `column` is memory for one.
    pub fn solve_pair(&self, symbolic: &Symbolic, b: &mut [[f64; 2]], column: &mut [f64]) {
        let Some(dense) = &self.dense else {
            return symbolic.solve_all(&self.values, b);
        };
        for side in 0..2 {
            column.iter_mut().zip(&*b).for_each(|(x, b)| *x = b[side]);
            dense.solve(column);
            b.iter_mut().zip(&*column).for_each(|(b, x)| b[side] = *x);
        }
    }
}
