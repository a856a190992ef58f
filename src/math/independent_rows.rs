//! The rows of linear equations that do not depend on those before them, and solutions of their equations: by [`super::dense`] where
//! they are few; otherwise in a time that grows little faster than their number, where few of them depend on others.

use super::dense::{DEPENDENT, Equations};
use super::generic;
use super::sparse_rows::{SparseRow, SparseRows, SymmetricBlock, full_row, square, times};
use faer::Mat;
use indexmap::IndexMap;
use std::collections::BTreeSet;

/// From this number of unknowns and rows on, sparse algebra is used. Dense algebra takes some milliseconds there.
const LARGE: usize = 300;
/// Rows are certainly independent if the squared sine of each to the span of those eliminated before it is larger than this, and if
/// their equations can be solved: the squared sine of a sum of rows times large factors may be above it by rounding. Rounding is a
/// thousandth of it, so that every correction of a solution gains three digits.
const INDEPENDENT: f64 = 1e-13;
/// Error of the solution of such equations, as a part of the length of a row: far above what corrections leave, far below the error
/// where one of some million rows depends on the others.
const SOLVED: f64 = 1e-6;
/// A pivot is at least this part of the largest entry of its row (threshold pivoting; Duff, Erisman & Reid 2017, Direct Methods for Sparse
/// Matrices, section 5.2): three digits are lost at worst, where the next larger pivots would cost many entries.
const LEAST_PIVOT: f64 = 1e-3;
/// Entries below this part of the largest one on the way are some tens of roundings.
const ROUNDING: f64 = 1e-14;

/// Linear equations G x = b, of which some may depend on those before them.
#[derive(Debug)]
pub struct IndependentRows {
    n: usize,
    /// The rows that depend on those before them, ascending.
    pub dependent: Vec<usize>,
    solver: RowSolver,
}

/// Solves the independent equations.
#[derive(Debug)]
enum RowSolver {
    /// By the factors of the rows with M = I, from the right sides.
    Sparse(Box<SparseRows>, Vec<f64>),
    Dense(Equations),
}

impl IndependentRows {
    /// Of n unknowns.
    pub fn new(n: usize, rows: &[SparseRow], b: &[f64]) -> IndependentRows {
        let is_large = n + rows.len() >= LARGE;
        let sparse = is_large.then(|| IndependentRows::sparse(n, rows, b));
        sparse
            .flatten()
            .unwrap_or_else(|| IndependentRows::dense(n, rows, b))
    }

    /// Of n unknowns, with right sides of zero.
    pub fn homogeneous(n: usize, rows: &[SparseRow]) -> IndependentRows {
        IndependentRows::new(n, rows, &vec![0.0; rows.len()])
    }

    /// None where it is not certain which rows are independent.
    fn sparse(n: usize, rows: &[SparseRow], b: &[f64]) -> Option<IndependentRows> {
        let sparse = |dependent, factors, b| IndependentRows {
            n,
            dependent,
            solver: RowSolver::Sparse(Box::new(factors), b),
        };
        if let Some(factors) = certainly_independent(n, rows) {
            return Some(sparse(Vec::new(), factors, b.to_vec()));
        }
        let echelon = Echelon::of(n, rows, b);
        let factors = certainly_independent(n, &echelon.rows)?;
        let left_out = echelon.dependent.iter().map(|&k| &rows[k]);
        let depend = depend(n, &left_out.collect::<Vec<_>>(), &factors);
        depend.then(|| sparse(echelon.dependent, factors, echelon.b))
    }

    fn dense(n: usize, rows: &[SparseRow], b: &[f64]) -> IndependentRows {
        let mut equations = Equations::default();
        let mut depends = |k: &usize| !equations.add(&full_row(n, &rows[*k]), b[*k]);
        let dependent = (0..rows.len()).filter(&mut depends).collect();
        IndependentRows {
            n,
            dependent,
            solver: RowSolver::Dense(equations),
        }
    }

    /// The x of least norm that satisfies the independent equations.
    pub fn least_norm(&self) -> Vec<f64> {
        match &self.solver {
            RowSolver::Sparse(factors, b) => factors.solve(&vec![0.0; self.n], b),
            RowSolver::Dense(equations) => equations.least_norm(self.n),
        }
    }

    /// The part of x that no equation sees.
    pub fn free_part(&self, x: &[f64]) -> Vec<f64> {
        match &self.solver {
            RowSolver::Sparse(factors, b) => factors.solve(x, &vec![0.0; b.len()]),
            RowSolver::Dense(equations) => equations.free_part(x),
        }
    }

    /// The x that satisfies the independent equations and minimises 1/2 x . M x + c . x for a positive definite M, which is the sum of
    /// some blocks. Where sparse algebra leaves an error above `tolerance` in an equation, dense algebra solves all.
    pub fn least_energy(&self, blocks: &[SymmetricBlock], c: &[f64], tolerance: f64) -> Vec<f64> {
        match &self.solver {
            RowSolver::Sparse(factors, b) => {
                let rows = factors.rows();
                // not -c, which would turn a zero into a negative one
                let against: Vec<f64> = c.iter().map(|c| 0.0 - c).collect();
                let x = SparseRows::factor(self.n, rows, blocks);
                let x = x.map(|factors| factors.solve(&against, b)).filter(|x| {
                    let mut pairs = rows.iter().zip(b);
                    pairs.all(|(row, b)| (times(row, x) - b).abs() <= tolerance)
                });
                x.unwrap_or_else(|| {
                    let all = IndependentRows::dense(self.n, rows, b);
                    all.least_energy(blocks, c, tolerance)
                })
            }
            RowSolver::Dense(equations) => equations.least_energy(&full(self.n, blocks), c),
        }
    }
}

/// A matrix of n rows as the sum of blocks.
fn full(n: usize, blocks: &[SymmetricBlock]) -> Mat<f64> {
    let mut m = Mat::zeros(n, n);
    for (own, block) in blocks {
        for (&i, row) in own.iter().zip(block.chunks_exact(own.len())) {
            own.iter()
                .zip(row)
                .for_each(|(&j, value)| m[(i, j)] += value);
        }
    }
    m
}

fn indices(n: usize) -> Vec<usize> {
    (0..n).collect()
}

/// The blocks of M = I.
fn identity(indices: &[usize]) -> Vec<SymmetricBlock<'_>> {
    indices.chunks(1).map(|i| (i, &[1.0][..])).collect()
}

/// The factors of rows for n unknowns, with M = I. None unless all are certainly independent.
fn certainly_independent(n: usize, rows: &[SparseRow]) -> Option<SparseRows> {
    if rows.len() > n {
        return None;
    }
    let factors = SparseRows::factor(n, rows, &identity(&indices(n)))?;
    let is_far = |(k, row)| factors.squared_distance(k) > INDEPENDENT * square(row);
    if factors.smallest_tie() <= INDEPENDENT || !rows.iter().enumerate().all(is_far) {
        return None;
    }
    // right sides that no sum of rows gives
    let sizes = rows.iter().map(|row| square(row).sqrt()).enumerate();
    let b: Vec<f64> = sizes.map(|(k, size)| size * generic(k)).collect();
    let x = factors.solve(&vec![0.0; n], &b);
    let is_solved =
        |(row, b): (&SparseRow, &f64)| (times(row, &x) - b).abs() <= SOLVED * square(row).sqrt();
    rows.iter().zip(&b).all(is_solved).then_some(factors)
}

/// True where rows are sums of those that were factorised: of what these do not see they see nothing.
fn depend(n: usize, rows: &[&SparseRow], factors: &SparseRows) -> bool {
    let zero = vec![0.0; factors.rows().len()];
    [0, n].into_iter().all(|first| {
        let direction: Vec<f64> = (first..first + n).map(generic).collect();
        let unseen = factors.solve(&direction, &zero);
        let seen = |row: &&SparseRow| times(row, &unseen).abs();
        rows.iter()
            .all(|row| seen(row) <= DEPENDENT * square(row).sqrt())
    })
}

/// A row with all entries divided by a number.
fn divided(row: SparseRow, by: f64) -> SparseRow {
    row.into_iter().map(|(i, g)| (i, g / by)).collect()
}

/// Equations in echelon form: each row is solved for one of its unknowns, which is eliminated from the rows behind it.
struct Echelon {
    /// The rows that do not depend on those before them, less what these give, and their right sides.
    rows: Vec<SparseRow>,
    b: Vec<f64>,
    /// The other rows.
    dependent: Vec<usize>,
    /// The unknown of every row, whose entry is 1, and the row of every unknown.
    unknowns: Vec<usize>,
    row_of: Vec<Option<usize>>,
}

impl Echelon {
    /// Equations of n unknowns.
    fn of(n: usize, rows: &[SparseRow], b: &[f64]) -> Echelon {
        let rows: Vec<SparseRow> = rows.iter().map(merged).collect();
        let mut to_come = vec![0; n];
        rows.iter().flatten().for_each(|(i, _)| to_come[*i] += 1);
        let mut echelon = Echelon {
            rows: Vec::new(),
            b: Vec::new(),
            dependent: Vec::new(),
            unknowns: Vec::new(),
            row_of: vec![None; n],
        };
        let mut memory = vec![0.0; n];
        for (k, (row, b)) in rows.into_iter().zip(b).enumerate() {
            row.iter().for_each(|(i, _)| to_come[*i] -= 1);
            let size = square(&row).sqrt();
            let (row, b) = echelon.reduced(divided(row, size), b / size, &mut memory);
            let largest = row.iter().fold(0.0_f64, |m, (_, g)| m.max(g.abs()));
            // an unknown of few rows to come, in which elimination makes few entries
            let eligible = row.iter().filter(|(_, g)| g.abs() >= LEAST_PIVOT * largest);
            let pivot = eligible.min_by_key(|(i, _)| (to_come[*i], *i)).copied();
            let Some((unknown, value)) = pivot.filter(|_| largest > DEPENDENT) else {
                echelon.dependent.push(k);
                continue;
            };
            echelon.row_of[unknown] = Some(echelon.rows.len());
            echelon.unknowns.push(unknown);
            echelon.rows.push(divided(row, value));
            echelon.b.push(b / value);
        }
        echelon
    }

    /// A row of length 1 and its right side, less what the rows at hand give; `left` is memory, of zeros.
    fn reduced(&self, row: SparseRow, mut b: f64, left: &mut [f64]) -> (SparseRow, f64) {
        let mut largest = 0.0_f64;
        let mut own = BTreeSet::new();
        let mut subtract =
            |factor: f64, row: &SparseRow, left: &mut [f64], due: &mut BTreeSet<_>| {
                for (i, g) in row {
                    left[*i] -= factor * g;
                    largest = largest.max(left[*i].abs());
                    match self.row_of[*i] {
                        Some(row) => due.insert(row),
                        None => own.insert(*i),
                    };
                }
            };
        // rows to subtract, the first of them first: it has no unknowns that those before it are solved for
        let mut due = BTreeSet::new();
        subtract(-1.0, &row, left, &mut due);
        while let Some(row) = due.pop_first() {
            let factor = left[self.unknowns[row]];
            b -= factor * self.b[row];
            subtract(factor, &self.rows[row], left, &mut due);
            due.remove(&row);
        }
        let entries = own.into_iter().map(|i| (i, std::mem::take(&mut left[i])));
        let row = entries.filter(|(_, g)| g.abs() > ROUNDING * largest);
        (row.collect(), b)
    }
}

/// A row in which every index stands once, with a value that is not zero.
fn merged(row: &SparseRow) -> SparseRow {
    let mut entries: IndexMap<usize, f64> = IndexMap::new();
    row.iter()
        .for_each(|(i, g)| *entries.entry(*i).or_default() += g);
    entries.into_iter().filter(|(_, g)| *g != 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::super::sparse_rows::tests::{assert_close, chain};
    use super::*;
    use proptest::prelude::*;

    fn assert_equal(n: usize, rows: &[SparseRow]) -> IndependentRows {
        let b: Vec<f64> = (0..rows.len()).map(|k| (k as f64).sin()).collect();
        let dense = IndependentRows::dense(n, rows, &b);
        let sparse = IndependentRows::sparse(n, rows, &b).unwrap();
        assert_eq!(sparse.dependent, dense.dependent);
        assert_close(&sparse.least_norm(), &dense.least_norm());
        let direction: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).cos()).collect();
        assert_close(&sparse.free_part(&direction), &dense.free_part(&direction));
        // masses of pairs, coupled
        let indices = indices(n);
        let pairs = indices.chunks(2);
        let block = |own: &[usize]| match own.len() {
            2 => &[2.0, 0.5, 0.5, 1.0][..],
            _ => &[3.0][..],
        };
        let blocks: Vec<SymmetricBlock> = pairs.map(|own| (own, block(own))).collect();
        let [x, y] = [&sparse, &dense].map(|rows| rows.least_energy(&blocks, &direction, 1e-9));
        assert_close(&x, &y);
        sparse
    }

    /// Sums of rows, a row twice and rows of zeros.
    #[test]
    fn dependent_rows_are_those_of_the_dense_equations() {
        let n = 24;
        let mut rows = chain(n);
        assert!(assert_equal(n, &rows).dependent.is_empty());
        let sum = [rows[3].clone(), rows[8].clone()].concat();
        rows.insert(6, sum);
        rows.insert(0, vec![]);
        rows.push(rows[5].clone());
        rows.push([rows[2].clone(), rows[15].clone(), rows[11].clone()].concat());
        rows.push(vec![(3, 1.0), (3, -1.0)]);
        assert_eq!(assert_equal(n, &rows).dependent.len(), 5);
    }

    /// Rows at small angles, and sums with large factors.
    #[test]
    fn small_angles_are_not_taken_for_dependence_nor_large_factors_for_independence() {
        for (rows, dependent) in [
            // two rows at an angle of 1e-3, and a row that is a sum of them with factors of a thousand
            (
                vec![vec![(0, 0.51)], vec![(0, 0.72), (1, 1e-3)], vec![(1, 1.0)]],
                vec![2],
            ),
            // three independent rows: the last is 3e-7 outside the span of the others
            (
                vec![
                    vec![(0, 1.0)],
                    vec![(0, 1.0), (1, 0.9e-4)],
                    vec![(1, 1.0), (2, 3e-7)],
                ],
                vec![],
            ),
        ] {
            let b = vec![1.0; rows.len()];
            assert_eq!(IndependentRows::dense(3, &rows, &b).dependent, dependent);
            let sparse = IndependentRows::sparse(3, &rows, &b).unwrap();
            assert_eq!(sparse.dependent, dependent);
        }
    }

    /// Differences of neighbours in a ring add up to zero: the last of them follows from the others, wherever the ring begins.
    #[test]
    fn the_last_row_of_a_large_ring_depends_on_the_others() {
        let n = 4000;
        let mut rows: Vec<SparseRow> = (0..n)
            .map(|k| vec![(k, -1.0), ((k + 1) % n, 1.0)])
            .collect();
        for turn in [0, 1, n / 2] {
            rows.rotate_left(turn);
            let b = vec![0.0; n];
            let ring = IndependentRows::sparse(n, &rows, &b).unwrap();
            assert_eq!(ring.dependent, [n - 1]);
        }
    }

    /// A row at a sine of 1e-7 to the others is independent, one at a sine of 1e-10 is not.
    #[test]
    fn a_row_depends_on_others_up_to_a_sine_of_1e_9() {
        let n = 12;
        for (sine, dependent) in [(1e-7, vec![]), (1e-10, vec![n - 1])] {
            let mut rows = chain(n);
            let mut near = [rows[3].clone(), rows[8].clone()].concat();
            near.push((5, sine));
            rows.push(near);
            let b: Vec<f64> = (0..rows.len()).map(|k| (k as f64).sin()).collect();
            let dense = IndependentRows::dense(n, &rows, &b);
            let sparse = IndependentRows::sparse(n, &rows, &b).unwrap();
            assert_eq!([&sparse.dependent, &dense.dependent], [&dependent; 2]);
            let x = sparse.least_norm();
            let size = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (row, b) in rows
                .iter()
                .zip(&b)
                .take(n - 1 + usize::from(dependent.is_empty()))
            {
                assert!((times(row, &x) - b).abs() < 1e-14 * size, "{size}");
            }
        }
    }

    proptest! {
        /// Rows of small whole numbers, of which many depend on others.
        #[test]
        fn dependent_rows_of_whole_numbers_are_those_of_the_dense_equations(
            rows in prop::collection::vec(prop::collection::vec((0..9_usize, -2..3_i32), 0..4), 1..14)
        ) {
            let entry = |(i, g): (usize, i32)| (i, f64::from(g));
            let row = |row: Vec<(usize, i32)>| row.into_iter().map(entry).collect();
            let rows: Vec<SparseRow> = rows.into_iter().map(row).collect();
            assert_equal(9, &rows);
        }

        /// Rows of numbers of many sizes: what sparse algebra takes for independent can be solved, and gives all other rows.
        #[test]
        fn independent_rows_of_numbers_of_many_sizes_give_the_dependent_ones(
            rows in prop::collection::vec(prop::collection::vec((0..6_usize, 0..8_usize), 0..4), 1..10)
        ) {
            let sizes = [1.0, -1.0, 0.3, -7.0, 0.01, -150.0, 0.002, 0.5];
            let entry = |(i, k): (usize, usize)| (i, sizes[k]);
            let row = |row: Vec<(usize, usize)>| row.into_iter().map(entry).collect();
            let rows: Vec<SparseRow> = rows.into_iter().map(row).collect();
            let is_solved = |rows: &[SparseRow], b: &[f64], x: &[f64]| {
                let off = |(row, b): (&SparseRow, &f64)| (times(row, x) - b).abs() <= 1e-5 * square(row).sqrt();
                rows.iter().zip(b).all(off)
            };
            let x = [0.4, -1.0, 0.7, 0.2, -0.6, 0.9];
            let b: Vec<f64> = rows.iter().map(|row| times(row, &x)).collect();
            if let Some(sparse) = IndependentRows::sparse(6, &rows, &b) {
                prop_assert!(is_solved(&rows, &b, &sparse.least_norm()));
                let kept = rows.iter().enumerate().filter(|(k, _)| !sparse.dependent.contains(k));
                let rows: Vec<SparseRow> = kept.map(|(_, row)| row.clone()).collect();
                let b: Vec<f64> = (0..rows.len()).map(|k| (k as f64).cos() * square(&rows[k]).sqrt()).collect();
                let sparse = IndependentRows::sparse(6, &rows, &b);
                prop_assert!(sparse.is_some_and(|sparse| is_solved(&rows, &b, &sparse.least_norm())));
            }
        }
    }
}
