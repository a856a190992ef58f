//! LU factorisation with a pattern and a pivot order that are fixed when the model is compiled.
//!
//! The tangent of a mechanism keeps its pattern for the whole run and is dominated by a positive definite mass
//! matrix bordered by constraints, so the pivot order can be chosen once: minimum degree, a multiplier only after the
//! coordinates of its constraint. The numeric work is then a list of multiply-subtracts with precomputed targets.
//! A pivot that turns out weak is reported; the caller falls back to a factorisation with row exchanges
//! ([`DenseLu`]) and counts it.

use faer::linalg::solvers::{PartialPivLu, Solve};
use std::collections::BTreeSet;

/// A multiplier that exceeds this loses so many digits that the factorisation is not used.
const LARGEST_MULTIPLIER: f64 = 1e9;

/// Structure of the matrix: pattern with fill, pivot order, positions of the entries in the value array.
///
/// The values of pivot k stand together: the diagonal, the row of U right of it, the column of L below it. One more
/// entry at the end of the array takes what is scattered to known coordinates and is never read.
#[derive(Debug)]
pub struct Symbolic {
    order: Vec<usize>,
    position: Vec<usize>,
    /// Start of pivot k in the value array.
    start: Vec<usize>,
    /// Start of pivot k in `structure`.
    structure_start: Vec<usize>,
    /// Positions (in pivot order) coupled to pivot k and eliminated after it, ascending.
    structure: Vec<usize>,
    /// Start of pivot k in `targets`.
    target_start: Vec<usize>,
    /// For pivot k the value index of every (row, column) pair of its structure, row by row.
    targets: Vec<u32>,
}

/// A pivot too small to divide by, in the row and column of unknown `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WeakPivot {
    /// Unknown whose pivot is weak.
    pub index: usize,
}

impl Symbolic {
    /// Analyses an n x n matrix whose pattern is the union of dense blocks on the index sets `cliques`. Unknown i is
    /// eliminated after those in `after[i]`: a multiplier after all coordinates of its constraint, whose elimination
    /// leaves it the pivot -Phi_q M^-1 Phi_q^T.
    ///
    /// # Panics
    /// If an index is not below n, or the orders asked for contradict each other.
    pub fn analyse(n: usize, cliques: &[Vec<usize>], after: &[Vec<usize>]) -> Symbolic {
        assert_eq!(after.len(), n);
        let mut neighbours = vec![BTreeSet::new(); n];
        for clique in cliques {
            for &i in clique {
                neighbours[i].extend(clique.iter().copied().filter(|&j| j != i));
            }
        }
        let mut gone = vec![false; n];
        let mut order = Vec::with_capacity(n);
        let mut eliminated_with = Vec::with_capacity(n);
        for _ in 0..n {
            let ready = |i: &usize| !gone[*i] && after[*i].iter().all(|&j| gone[j]);
            let pivot = (0..n)
                .filter(ready)
                .min_by_key(|&i| neighbours[i].len())
                .expect("the orders asked for do not contradict each other");
            let front: Vec<usize> = std::mem::take(&mut neighbours[pivot]).into_iter().collect();
            for &i in &front {
                neighbours[i].remove(&pivot);
                neighbours[i].extend(front.iter().copied().filter(|&j| j != i));
            }
            gone[pivot] = true;
            order.push(pivot);
            eliminated_with.push(front);
        }
        Self::layout(order, &eliminated_with)
    }

    fn layout(order: Vec<usize>, fronts: &[Vec<usize>]) -> Symbolic {
        let n = order.len();
        let mut position = vec![0; n];
        for (k, &i) in order.iter().enumerate() {
            position[i] = k;
        }
        let mut symbolic = Symbolic {
            order,
            position,
            start: vec![0],
            structure_start: vec![0],
            structure: Vec::new(),
            target_start: vec![0],
            targets: Vec::new(),
        };
        for (k, front) in fronts.iter().enumerate() {
            let mut rows: Vec<usize> = front.iter().map(|&i| symbolic.position[i]).collect();
            rows.sort_unstable();
            symbolic.start.push(symbolic.start[k] + 1 + 2 * rows.len());
            symbolic.structure.extend(rows);
            symbolic.structure_start.push(symbolic.structure.len());
        }
        for k in 0..n {
            let rows = symbolic.structure(k).to_vec();
            for &i in &rows {
                for &j in &rows {
                    symbolic.targets.push(
                        symbolic
                            .entry(i, j)
                            .expect("the pattern is closed under elimination"),
                    );
                }
            }
            symbolic.target_start.push(symbolic.targets.len());
        }
        symbolic
    }

    fn structure(&self, k: usize) -> &[usize] {
        &self.structure[self.structure_start[k]..self.structure_start[k + 1]]
    }

    /// Value index of the entry in rows and columns counted in pivot order.
    fn entry(&self, i: usize, j: usize) -> Option<u32> {
        let k = i.min(j);
        let rows = self.structure(k);
        let offset = match i.cmp(&j) {
            std::cmp::Ordering::Equal => 0,
            std::cmp::Ordering::Less => 1 + rows.binary_search(&j).ok()?,
            std::cmp::Ordering::Greater => 1 + rows.len() + rows.binary_search(&i).ok()?,
        };
        u32::try_from(self.start[k] + offset).ok()
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.order.len()
    }

    /// Length of the value array, the unread last entry included.
    pub fn len(&self) -> usize {
        self.start[self.n()] + 1
    }

    /// True for a matrix without unknowns.
    pub fn is_empty(&self) -> bool {
        self.n() == 0
    }

    /// Index of the value that takes what is scattered to known coordinates.
    pub fn unread(&self) -> u32 {
        self.start[self.n()] as u32
    }

    /// Value index of entry (row, column), or of the unread entry where one of them is not an unknown (index >= n).
    ///
    /// # Panics
    /// If the entry is not in the pattern.
    pub fn slot(&self, row: usize, column: usize) -> u32 {
        if row >= self.n() || column >= self.n() {
            return self.unread();
        }
        self.entry(self.position[row], self.position[column])
            .expect("the entry belongs to a clique")
    }

    /// Factorises in place: A = L U.
    ///
    /// # Errors
    /// The first pivot that is zero, not finite, or much smaller than its column.
    pub fn factor(&self, values: &mut [f64]) -> Result<(), WeakPivot> {
        assert_eq!(values.len(), self.len());
        for k in 0..self.n() {
            let count = self.structure_start[k + 1] - self.structure_start[k];
            let start = self.start[k];
            let inverse = 1.0 / values[start];
            let (upper, lower) = (start + 1, start + 1 + count);
            let mut targets = self.targets[self.target_start[k]..self.target_start[k + 1]]
                .chunks_exact(count.max(1));
            for a in 0..count {
                let multiplier = values[lower + a] * inverse;
                if multiplier.is_nan() || multiplier.abs() > LARGEST_MULTIPLIER {
                    return Err(WeakPivot {
                        index: self.order[k],
                    });
                }
                values[lower + a] = multiplier;
                let row = targets.next().unwrap_or(&[]);
                for (b, &target) in row.iter().enumerate() {
                    values[target as usize] -= multiplier * values[upper + b];
                }
            }
            if !inverse.is_finite() {
                return Err(WeakPivot {
                    index: self.order[k],
                });
            }
        }
        Ok(())
    }

    /// Smallest over largest pivot of the unknowns from `first` on, in the factors of [`Symbolic::factor`].
    pub fn pivot_range(&self, values: &[f64], first: usize) -> f64 {
        let pivots = (first..self.n()).map(|i| values[self.start[self.position[i]]].abs());
        let (low, high) = pivots.fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p), h.max(p)));
        low / high
    }

    /// Solves L U x = b with the factors of [`Symbolic::factor`]; `b` in, x out; `work` has length n.
    pub fn solve(&self, values: &[f64], b: &mut [f64], work: &mut [f64]) {
        let n = self.n();
        for k in 0..n {
            work[k] = b[self.order[k]];
        }
        for k in 0..n {
            let rows = self.structure(k);
            let lower = &values[self.start[k] + 1 + rows.len()..][..rows.len()];
            let pivot = work[k];
            for (&i, l) in rows.iter().zip(lower) {
                work[i] -= l * pivot;
            }
        }
        for k in (0..n).rev() {
            let rows = self.structure(k);
            let upper = &values[self.start[k] + 1..][..rows.len()];
            let sum: f64 = rows.iter().zip(upper).map(|(&j, u)| u * work[j]).sum();
            work[k] = (work[k] - sum) / values[self.start[k]];
        }
        for k in 0..n {
            b[self.order[k]] = work[k];
        }
    }

    /// The matrix in full, before it is factorised.
    pub fn to_dense(&self, values: &[f64]) -> faer::Mat<f64> {
        let mut dense = faer::Mat::zeros(self.n(), self.n());
        for k in 0..self.n() {
            let rows = self.structure(k);
            let (i, start) = (self.order[k], self.start[k]);
            dense[(i, i)] = values[start];
            for (b, &position) in rows.iter().enumerate() {
                let j = self.order[position];
                dense[(i, j)] = values[start + 1 + b];
                dense[(j, i)] = values[start + 1 + rows.len() + b];
            }
        }
        dense
    }
}

/// Passes of equilibration: each takes the square root of how far rows are from a largest entry of one.
const EQUILIBRATIONS: usize = 6;

/// Dense LU with row exchanges, for the rare matrix that the fixed order cannot take. It allocates.
///
/// Rows and columns are scaled alike until their largest entries are near one (Ruiz 2001, RAL-TR-2001-034), so that a
/// stiffness of 1e10 N/m beside a constraint of order one does not look singular.
#[derive(Debug)]
pub struct DenseLu {
    factors: PartialPivLu<f64>,
    scale: Vec<f64>,
}

impl DenseLu {
    /// Factorises the matrix that `values` holds before [`Symbolic::factor`]; `None` when it is singular to rounding.
    pub fn factor(symbolic: &Symbolic, values: &[f64]) -> Option<DenseLu> {
        let n = symbolic.n();
        let mut matrix = symbolic.to_dense(values);
        let mut scale = vec![1.0; n];
        for _ in 0..EQUILIBRATIONS {
            let size = |i: usize| (0..n).fold(0.0_f64, |m, j| m.max(matrix[(i, j)].abs()));
            let by: Vec<f64> = (0..n).map(|i| 1.0 / size(i).sqrt()).collect();
            if by.iter().any(|x| !x.is_finite()) {
                return None;
            }
            for i in 0..n {
                for j in 0..n {
                    matrix[(i, j)] *= by[i] * by[j];
                }
                scale[i] *= by[i];
            }
        }
        let factors = matrix.partial_piv_lu();
        let upper = factors.U();
        let diagonal = (0..n).map(|i| upper[(i, i)].abs());
        let (smallest, largest) =
            diagonal.fold((f64::INFINITY, 0.0_f64), |(s, l), d| (s.min(d), l.max(d)));
        // a pivot below the rounding of the largest one carries no digit
        (largest.is_finite() && smallest > f64::EPSILON * largest)
            .then_some(DenseLu { factors, scale })
    }

    /// Solves for `b` in place.
    pub fn solve(&self, b: &mut [f64]) {
        b.iter_mut().zip(&self.scale).for_each(|(b, s)| *b *= s);
        self.factors.solve_in_place(faer::ColMut::from_slice_mut(b));
        b.iter_mut().zip(&self.scale).for_each(|(b, s)| *b *= s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses, each of two coordinates, tied to each other by one constraint and the first to ground by another.
    fn bordered() -> (Symbolic, Vec<f64>) {
        let cliques = vec![vec![0, 1], vec![2, 3], vec![0, 1, 2, 3, 4], vec![0, 1, 5]];
        let mut after = vec![Vec::new(); 6];
        after[4] = vec![0, 1, 2, 3];
        after[5] = vec![0, 1];
        let symbolic = Symbolic::analyse(6, &cliques, &after);
        let mut values = vec![0.0; symbolic.len()];
        let mut set = |i: usize, j: usize, x: f64| values[symbolic.slot(i, j) as usize] = x;
        for (i, m) in [2.0, 3.0, 1.0, 1.5].into_iter().enumerate() {
            set(i, i, m);
        }
        set(0, 1, 0.3);
        set(1, 0, -0.2);
        for (i, g) in [0.0, 1.0, 0.4, -1.0].into_iter().enumerate() {
            set(i, 4, g);
            set(4, i, g);
        }
        for (i, g) in [0.7, 0.1].into_iter().enumerate() {
            set(i, 5, g);
            set(5, i, g);
        }
        (symbolic, values)
    }

    #[test]
    fn agrees_with_dense_elimination() {
        let (symbolic, mut values) = bordered();
        let dense = DenseLu::factor(&symbolic, &values).unwrap();
        let b = [1.0, -2.0, 0.5, 3.0, 0.25, -1.0];
        let (mut x, mut y, mut work) = (b, b, vec![0.0; 6]);
        symbolic.factor(&mut values).unwrap();
        symbolic.solve(&values, &mut x, &mut work);
        dense.solve(&mut y);
        for i in 0..6 {
            // both are backward stable here: a few roundings of numbers near one
            assert!((x[i] - y[i]).abs() < 1e-14, "{x:?} {y:?}");
        }
    }

    #[test]
    fn a_singular_matrix_is_refused_by_both() {
        let (symbolic, mut values) = bordered();
        for i in 0..2 {
            values[symbolic.slot(i, 5) as usize] = 0.0;
            values[symbolic.slot(5, i) as usize] = 0.0;
        }
        assert!(DenseLu::factor(&symbolic, &values).is_none());
        assert_eq!(symbolic.factor(&mut values), Err(WeakPivot { index: 5 }));
    }

    #[test]
    fn what_is_scattered_to_known_coordinates_is_not_read() {
        let (symbolic, mut values) = bordered();
        assert_eq!(symbolic.slot(0, 17), symbolic.unread());
        values[symbolic.unread() as usize] = f64::NAN;
        assert!(symbolic.factor(&mut values).is_ok());
    }
}
