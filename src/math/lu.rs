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
/// The values of pivot k stand together: the diagonal, which its inverse replaces, the row of U right of it, the column of L
/// below it. One more entry at the end of the array takes what is scattered to known coordinates and is never read.
#[derive(Debug)]
pub struct Symbolic {
    pivots: Vec<Pivot>,
    /// Place of each unknown among the pivots.
    position: Vec<usize>,
    /// Places of the unknowns coupled to a pivot and eliminated after it, ascending; pivot after pivot.
    structure: Vec<usize>,
    /// The same unknowns by their indices.
    coupled: Vec<usize>,
    /// For every (row, column) pair of a pivot's structure, row by row, where its value stands behind those of the pivot.
    targets: Vec<u32>,
}

/// What elimination needs to know of one pivot.
#[derive(Debug)]
struct Pivot {
    /// Its unknown.
    index: usize,
    /// Start of its values.
    start: usize,
    /// How many unknowns are coupled to it.
    count: usize,
    /// Start of them in the structure.
    structure: usize,
    /// Start of its targets.
    targets: usize,
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
        // how many unknowns must still go before each one, and those that wait for each one
        let mut awaited: Vec<usize> = after.iter().map(Vec::len).collect();
        let mut waiting = vec![Vec::new(); n];
        for (i, before) in after.iter().enumerate() {
            before.iter().for_each(|&j| waiting[j].push(i));
        }
        // the unknowns that can go, by their number of neighbours
        let free = (0..n).filter(|&i| awaited[i] == 0);
        let mut ready: BTreeSet<(usize, usize)> = free.map(|i| (neighbours[i].len(), i)).collect();
        let mut order = Vec::with_capacity(n);
        let mut eliminated_with = Vec::with_capacity(n);
        for _ in 0..n {
            let next = ready.pop_first();
            let (_, pivot) = next.expect("the orders asked for do not contradict each other");
            let front: Vec<usize> = std::mem::take(&mut neighbours[pivot]).into_iter().collect();
            for &i in &front {
                let before = neighbours[i].len();
                neighbours[i].remove(&pivot);
                neighbours[i].extend(front.iter().copied().filter(|&j| j != i));
                if ready.remove(&(before, i)) {
                    ready.insert((neighbours[i].len(), i));
                }
            }
            for &i in &waiting[pivot] {
                awaited[i] -= 1;
                if awaited[i] == 0 {
                    ready.insert((neighbours[i].len(), i));
                }
            }
            order.push(pivot);
            eliminated_with.push(front);
        }
        Self::layout(order, &eliminated_with)
    }

    fn layout(order: Vec<usize>, fronts: &[Vec<usize>]) -> Symbolic {
        let mut symbolic = Symbolic {
            pivots: Vec::with_capacity(order.len()),
            position: vec![0; order.len()],
            structure: Vec::new(),
            coupled: Vec::new(),
            targets: Vec::new(),
        };
        for (k, &i) in order.iter().enumerate() {
            symbolic.position[i] = k;
        }
        let mut start = 0;
        for (&index, front) in order.iter().zip(fronts) {
            let mut places: Vec<usize> = front.iter().map(|&i| symbolic.position[i]).collect();
            places.sort_unstable();
            symbolic.pivots.push(Pivot {
                index,
                start,
                count: front.len(),
                structure: symbolic.structure.len(),
                targets: 0,
            });
            start += 1 + 2 * front.len();
            symbolic.coupled.extend(places.iter().map(|&p| order[p]));
            symbolic.structure.extend(places);
        }
        for k in 0..order.len() {
            let places = symbolic.structure(k).to_vec();
            symbolic.pivots[k].targets = symbolic.targets.len();
            let Pivot { start, count, .. } = symbolic.pivots[k];
            for &i in &places {
                for &j in &places {
                    let entry = symbolic.entry(i, j);
                    let entry = entry.expect("the pattern is closed under elimination");
                    let behind = entry as usize - (start + 1 + 2 * count);
                    symbolic.targets.push(behind as u32);
                }
            }
        }
        symbolic
    }

    fn structure(&self, k: usize) -> &[usize] {
        let Pivot {
            structure, count, ..
        } = self.pivots[k];
        &self.structure[structure..structure + count]
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
        u32::try_from(self.pivots[k].start + offset).ok()
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.pivots.len()
    }

    /// Length of the value array, the discarded_slot last entry included.
    pub fn len(&self) -> usize {
        self.discarded_slot() as usize + 1
    }

    /// True for a matrix without unknowns.
    pub fn is_empty(&self) -> bool {
        self.n() == 0
    }

    /// Index of the value that takes what is scattered to known coordinates.
    pub fn discarded_slot(&self) -> u32 {
        let last = self.pivots.last();
        last.map_or(0, |p| p.start + 1 + 2 * p.count) as u32
    }

    /// Value index of entry (row, column), or of the discarded_slot entry where one of them is not an unknown (index >= n).
    ///
    /// # Panics
    /// If the entry is not in the pattern.
    pub fn slot(&self, row: usize, column: usize) -> u32 {
        if row >= self.n() || column >= self.n() {
            return self.discarded_slot();
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
        for p in &self.pivots {
            let (here, behind) = values.split_at_mut(p.start + 1 + 2 * p.count);
            let (diagonal, here) = here[p.start..].split_at_mut(1);
            let (upper, lower) = here.split_at_mut(p.count);
            let inverse = 1.0 / diagonal[0];
            diagonal[0] = inverse;
            let mut largest = 0.0_f64;
            for l in lower.iter_mut() {
                *l *= inverse;
                // f64::max drops NaN
                largest = if l.abs() <= largest { largest } else { l.abs() };
            }
            if !inverse.is_finite() || largest.is_nan() || largest > LARGEST_MULTIPLIER {
                return Err(WeakPivot { index: p.index });
            }
            if p.count > 0 {
                let targets = &self.targets[p.targets..p.targets + p.count * p.count];
                for (l, targets) in lower.iter().zip(targets.chunks_exact(p.count)) {
                    for (u, &target) in upper.iter().zip(targets) {
                        behind[target as usize] -= l * u;
                    }
                }
            }
        }
        Ok(())
    }

    /// The pivot of an unknown in the factors of [`Symbolic::factor`].
    pub fn pivot(&self, values: &[f64], unknown: usize) -> f64 {
        1.0 / values[self.pivots[self.position[unknown]].start]
    }

    /// Smallest over largest pivot of the unknowns from `first` on, in the factors of [`Symbolic::factor`].
    pub fn pivot_range(&self, values: &[f64], first: usize) -> f64 {
        let inverses = (first..self.n()).map(|i| values[self.pivots[self.position[i]].start].abs());
        let (low, high) = inverses.fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p), h.max(p)));
        low / high
    }

    /// Solves L U x = b with the factors of [`Symbolic::factor`]; `b` in, x out.
    pub fn solve(&self, values: &[f64], b: &mut [f64]) {
        for p in &self.pivots {
            let coupled = &self.coupled[p.structure..p.structure + p.count];
            let lower = &values[p.start + 1 + p.count..];
            let pivot = b[p.index];
            for (&row, l) in coupled.iter().zip(lower) {
                b[row] -= l * pivot;
            }
        }
        for p in self.pivots.iter().rev() {
            let coupled = &self.coupled[p.structure..p.structure + p.count];
            let (inverse, upper) = (values[p.start], &values[p.start + 1..]);
            let sum: f64 = coupled.iter().zip(upper).map(|(&j, u)| u * b[j]).sum();
            b[p.index] = (b[p.index] - sum) * inverse;
        }
    }

    /// The matrix in full, before it is factorised.
    pub fn to_dense(&self, values: &[f64]) -> faer::Mat<f64> {
        let mut dense = faer::Mat::zeros(self.n(), self.n());
        for p in &self.pivots {
            let i = p.index;
            dense[(i, i)] = values[p.start];
            let coupled = &self.coupled[p.structure..p.structure + p.count];
            for (b, &j) in coupled.iter().enumerate() {
                dense[(i, j)] = values[p.start + 1 + b];
                dense[(j, i)] = values[p.start + 1 + p.count + b];
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
#[derive(Debug, Clone)]
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
        let (mut x, mut y) = (b, b);
        symbolic.factor(&mut values).unwrap();
        symbolic.solve(&values, &mut x);
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
        assert_eq!(symbolic.slot(0, 17), symbolic.discarded_slot());
        values[symbolic.discarded_slot() as usize] = f64::NAN;
        assert!(symbolic.factor(&mut values).is_ok());
    }
}
