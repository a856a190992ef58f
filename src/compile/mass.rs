//! Masses and weights: the parts of the bodies and their sums.

use super::Mode;
use super::numbering::Numbering;
use crate::math::sparse_product::SparseProduct;
use crate::model::Mass;
use crate::terms::Inertia;

/// Weight as forces on the left side of the equations of motion, if there is gravity.
pub(super) fn weight(parts: &[Inertia], coordinates: usize) -> Vec<(usize, f64)> {
    let mut forces = vec![0.0; coordinates];
    for part in parts {
        let n = part.coordinates.len();
        for (row, &i) in part.coordinates.iter().enumerate() {
            forces[i] -= (0..n)
                .map(|k| part.values[row * n + k] * part.field[k])
                .sum::<f64>();
        }
    }
    forces
        .into_iter()
        .enumerate()
        .filter(|(_, f)| *f != 0.0)
        .collect()
}

/// Sums the parts. In the ideal mechanism the parts are kept, but their sum is empty.
pub(super) fn mass(parts: Vec<Inertia>, numbering: &Numbering, mode: Mode) -> Mass {
    let mut rows: Vec<std::collections::BTreeMap<usize, f64>> =
        vec![Default::default(); numbering.coordinates];
    let summed = if mode != Mode::Ideal { &parts[..] } else { &[] };
    for part in summed {
        let n = part.coordinates.len();
        for (r, &i) in part.coordinates.iter().enumerate() {
            for (s, &j) in part.coordinates.iter().enumerate() {
                let m = part.values[r * n + s];
                if m != 0.0 {
                    *rows[i].entry(j).or_default() += m;
                }
            }
        }
    }
    let n = numbering.unknowns;
    let unknown = rows[..n].iter().map(|row| {
        let row = row.iter().filter(|(j, _)| **j < n);
        row.map(|(&j, &m)| (j, m)).collect()
    });
    let mut moves = vec![true; rows.len()];
    moves[n - numbering.states.len()..n].fill(false);
    let moving = rows.iter().zip(moves).map(|(row, moves)| {
        let row = row.iter().filter(|_| moves);
        row.map(|(&j, &m)| (j, m)).collect()
    });
    let mut mass = Mass {
        parts,
        entries: Vec::new(),
        ends: Vec::new(),
        tangent: Vec::new(),
        product: SparseProduct::new(&unknown.collect::<Vec<_>>()),
        kinetic: SparseProduct::new(&moving.collect::<Vec<_>>()),
        known: Vec::new(),
    };
    for (i, row) in rows.iter().enumerate() {
        for (&j, &m) in row {
            mass.entries.push((j as u32, m));
            if i < n && j >= n {
                mass.known.push((i, j, m));
            }
        }
        mass.ends.push(mass.entries.len() as u32);
    }
    mass
}

impl Mass {
    /// The sum over unknowns as (row, column, mass).
    pub(super) fn entries(&self, unknowns: usize) -> Vec<(usize, usize, f64)> {
        let rows = (0..unknowns).flat_map(|i| self.row(i).map(move |(j, m)| (i, j, m)));
        rows.filter(|(_, j, _)| *j < unknowns).collect()
    }
}
