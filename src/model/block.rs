//! Maps the local vectors and matrices of a term to the global ones.

use crate::math::lu::Symbolic;

/// Coordinates of a term and the slots of its local matrix in the tangent, row by row.
#[derive(Debug, Clone)]
pub struct Block {
    /// Global indices in local order.
    pub coordinates: Vec<usize>,
    /// Slots, `coordinates.len()` squared.
    pub slots: Vec<u32>,
    /// The same as runs of entries whose slots follow each other, without known coordinates.
    runs: Runs,
}

/// Runs of four, two and one entries of a local matrix whose slots follow each other: beside each other and below each other.
#[derive(Debug, Clone)]
struct Runs {
    fours: [Vec<Run>; 2],
    twos: [Vec<Run>; 2],
    ones: Vec<Run>,
}

/// The first slot and the row and column of the first entry.
#[derive(Debug, Clone, Copy)]
struct Run {
    slot: u32,
    row: u16,
    column: u16,
}

/// Adds runs of N entries that follow each other at a distance of STRIDE in the local matrix, stored in rows of length W.
#[inline(always)]
fn add_runs<const W: usize, const N: usize, const STRIDE: usize>(
    runs: &[Run],
    local: &[f64],
    weight: f64,
    k: &mut [f64],
) {
    for run in runs {
        let (slot, first) = (
            run.slot as usize,
            run.row as usize * W + run.column as usize,
        );
        let entries = &local[first..first + (N - 1) * STRIDE + 1];
        let k: &mut [f64; N] = k[slot..]
            .first_chunk_mut()
            .expect("slots follow each other");
        for i in 0..N {
            k[i] += weight * entries[i * STRIDE];
        }
    }
}

/// Takes the runs of N entries, beside or below each other, out of the entries that are left of an n x n matrix.
fn take_runs<const N: usize>(n: usize, slots: &[u32], left: &mut [bool]) -> [Vec<Run>; 2] {
    [1, n].map(|stride| {
        let mut runs = Vec::new();
        for first in 0..n * n {
            let (row, column) = (first / n, first % n);
            let place = if stride == 1 { column } else { row };
            let entries: [usize; N] = std::array::from_fn(|i| first + i * stride);
            let follows =
                |(i, e): (usize, &usize)| left[*e] && slots[*e] == slots[first] + i as u32;
            if place + N <= n && entries.iter().enumerate().all(follows) {
                entries.iter().for_each(|e| left[*e] = false);
                runs.push(Run {
                    slot: slots[first],
                    row: row as u16,
                    column: column as u16,
                });
            }
        }
        runs
    })
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
        let slots: Vec<u32> = slots.collect();
        let n = coordinates.len();
        let mut left: Vec<bool> = slots
            .iter()
            .map(|slot| *slot != symbolic.discarded_slot())
            .collect();
        Block {
            runs: Runs {
                fours: take_runs::<4>(n, &slots, &mut left),
                twos: take_runs::<2>(n, &slots, &mut left),
                ones: take_runs::<1>(n, &slots, &mut left).concat(),
            },
            coordinates,
            slots,
        }
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
        let (local, Runs { fours, twos, ones }) = (local.as_flattened(), &self.runs);
        add_runs::<W, 4, 1>(&fours[0], local, weight, k);
        add_runs::<W, 4, W>(&fours[1], local, weight, k);
        add_runs::<W, 2, 1>(&twos[0], local, weight, k);
        add_runs::<W, 2, W>(&twos[1], local, weight, k);
        add_runs::<W, 1, 1>(ones, local, weight, k);
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
