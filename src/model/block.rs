//! Maps the local vectors and matrices of a term to the global ones.

use crate::math::lu::Symbolic;

/// Coordinates of a term and the slots of its local matrix in the tangent, row by row.
#[derive(Debug, Clone)]
pub struct Block {
    /// Global indices in local order.
    pub coordinates: Vec<usize>,
    /// Slots, `coordinates.len()` squared.
    pub slots: Vec<u32>,
}

impl Block {
    /// The place of a term with these coordinates.
    pub fn new(coordinates: Vec<usize>, symbolic: &Symbolic, unknowns: usize) -> Block {
        // known coordinates (index >= unknowns) must not be mistaken for multipliers
        let place = |i: usize| if i < unknowns { i } else { usize::MAX };
        let slots = coordinates.iter().flat_map(|&r| {
            coordinates
                .iter()
                .map(move |&c| symbolic.slot(place(r), place(c)))
        });
        let slots = slots.collect();
        Block { coordinates, slots }
    }

    /// r += local
    #[inline]
    pub fn add_vector(&self, local: &[f64], r: &mut [f64]) {
        for (&i, x) in self.coordinates.iter().zip(local) {
            r[i] += x;
        }
    }

    /// r += factor local
    #[inline]
    pub fn add_scaled(&self, factor: f64, local: &[f64], r: &mut [f64]) {
        for (&i, x) in self.coordinates.iter().zip(local) {
            r[i] += factor * x;
        }
    }

    /// k += weight local, for a local matrix stored in rows of length W.
    #[inline]
    pub fn add_matrix<const W: usize>(&self, local: &[[f64; W]; W], weight: f64, k: &mut [f64]) {
        let n = self.coordinates.len();
        for (slots, row) in self.slots.chunks_exact(n).zip(local) {
            for (&slot, x) in slots.iter().zip(row) {
                k[slot as usize] += weight * x;
            }
        }
    }
}

/// Slots of one constraint row's gradient: (coordinate, multiplier) and (multiplier, coordinate).
#[derive(Debug, Clone)]
pub struct Border {
    column: Vec<u32>,
    row: Vec<u32>,
}

impl Border {
    /// The place of the gradient of the multiplier with index `multiplier` among the multipliers.
    pub fn new(
        coordinates: &[usize],
        multiplier: usize,
        symbolic: &Symbolic,
        unknowns: usize,
    ) -> Border {
        let place = |i: usize| if i < unknowns { i } else { usize::MAX };
        let m = unknowns + multiplier;
        Border {
            column: coordinates
                .iter()
                .map(|&i| symbolic.slot(place(i), m))
                .collect(),
            row: coordinates
                .iter()
                .map(|&i| symbolic.slot(m, place(i)))
                .collect(),
        }
    }

    /// Slots that are never read.
    pub fn discarded(columns: usize, symbolic: &Symbolic) -> Border {
        Border {
            column: vec![symbolic.discarded_slot(); columns],
            row: vec![symbolic.discarded_slot(); columns],
        }
    }

    /// Adds the gradient to Phi_q and to Phi_q^T.
    #[inline]
    pub fn add(&self, gradient: &[f64], k: &mut [f64]) {
        for ((&c, &r), g) in self.column.iter().zip(&self.row).zip(gradient) {
            k[c as usize] += *g;
            k[r as usize] += *g;
        }
    }
}
