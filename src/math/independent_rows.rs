//! The rows of linear equations that do not depend on those before them, and solutions of their equations: by [`super::dense`] where
//! they are few; otherwise in a time that grows little faster than their number, where few of them depend on others.

use super::dense::{DEPENDENT, Equations, norm};
use super::generic;
use super::groups::Groups;
use super::sparse_rows::{SparseRow, SparseRows, SymmetricBlock, full_row, square, times};
use faer::Mat;
use indexmap::{IndexMap, IndexSet};
use std::collections::{BTreeMap, HashMap};

/// From this number of unknowns and rows on, sparse algebra is used. Dense algebra takes some milliseconds there.
const LARGE: usize = 300;
/// Rows are certainly independent if the squared sine of each to the span of those eliminated before it is larger than this, and if
/// their equations can be solved: the squared sine of a sum of rows times large factors may be above it by rounding.
const INDEPENDENT: f64 = 1e-10;
/// Error of the solution of such equations, as a part of the length of a row: far above what corrections leave, far below the error
/// where one of some million rows depends on the others.
const SOLVED: f64 = 1e-6;
/// What is added to the squared sines where they may be zero: above their rounding.
const SHIFT: f64 = 1e-13;
/// Rows may depend on others up to this squared sine. That of a sum of rows times factors is the shift times the squares of the factors.
const DOUBTFUL: f64 = 1e-8;
/// A row takes part in a sum of rows if its term is larger than this fraction of the sum: above the rounding of the terms, far
/// below what [`super::dense`] takes for dependent.
const TAKES_PART: f64 = 1e-11;

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
        let (dependent, factors) = match certainly_independent(n, rows) {
            Some(factors) => (Vec::new(), factors),
            None => {
                let dependent = dependent(rows)?;
                let factors = certainly_independent(n, &without(&dependent, rows))?;
                (dependent, factors)
            }
        };
        let b = without(&dependent, b);
        Some(IndependentRows {
            n,
            dependent,
            solver: RowSolver::Sparse(Box::new(factors), b),
        })
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
    let factors = SparseRows::factor(n, rows, &identity(&indices(n)))?;
    let is_far = |(k, row)| factors.squared_distance(k) > INDEPENDENT * square(row);
    if !rows.iter().enumerate().all(is_far) {
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

/// All but the elements with some indices, which ascend.
fn without<T: Clone>(indices: &[usize], all: &[T]) -> Vec<T> {
    let kept = (0..all.len()).filter(|k| indices.binary_search(k).is_err());
    kept.map(|k| all[k].clone()).collect()
}

/// The rows that depend on those before them.
fn dependent(rows: &[SparseRow]) -> Option<Vec<usize>> {
    let rows: Vec<SparseRow> = rows.iter().map(merged).collect();
    let is_zero = |k: &usize| rows[*k].is_empty();
    let mut found: Vec<usize> = (0..rows.len()).filter(is_zero).collect();
    // rows that are connected through unknowns which they share
    let mut parts = Groups::new(rows.len());
    let mut first_with: HashMap<usize, usize> = HashMap::new();
    for (k, row) in rows.iter().enumerate() {
        for (i, _) in row {
            parts.unite(k, *first_with.entry(*i).or_insert(k));
        }
    }
    for part in several(parts) {
        found.extend(dependent_of(&rows, &part)?);
    }
    found.sort_unstable();
    Some(found)
}

/// The groups of two and more.
fn several(groups: Groups) -> impl Iterator<Item = Vec<usize>> {
    groups.all().into_iter().filter(|group| group.len() > 1)
}

/// Some rows with unknowns counted among themselves, and the number of these.
fn local(rows: &[SparseRow], part: &[usize]) -> (Vec<SparseRow>, usize) {
    let mut unknowns = IndexSet::new();
    let row = |&k: &usize| {
        let entries = rows[k].iter();
        let entries = entries.map(|(i, g)| (unknowns.insert_full(*i).0, *g));
        entries.collect()
    };
    let rows = part.iter().map(row).collect();
    (rows, unknowns.len())
}

/// The rows of a part that depend on those before them. None where it is not certain which rows are independent.
///
/// Every row that may depend on others is a sum of rows that certainly do not: a relation between rows.
fn dependent_of(all: &[SparseRow], part: &[usize]) -> Option<Vec<usize>> {
    let (rows, n) = local(all, part);
    let shifted = SparseRows::factor_shifted(n, &rows, &identity(&indices(n)), SHIFT)?;
    let doubtful = |k: &usize| shifted.squared_distance(*k) <= DOUBTFUL * square(&rows[*k]);
    let doubtful: Vec<usize> = (0..rows.len()).filter(doubtful).collect();
    let certain = without(&doubtful, &indices(rows.len()));
    let factors = certainly_independent(n, &without(&doubtful, &rows))?;
    let zero = vec![0.0; certain.len()];
    let mut relations = Vec::new();
    for &k in &doubtful {
        let size = square(&rows[k]).sqrt();
        let mut rest = full_row(n, &rows[k]);
        let mut parts = vec![0.0; certain.len()];
        // twice for the sake of rounding
        for _ in 0..2 {
            let [_, more] = factors.solve_both(&rest, &zero);
            for ((&other, part), more) in certain.iter().zip(&mut parts).zip(more) {
                *part += more;
                rows[other].iter().for_each(|(i, g)| rest[*i] -= more * g);
            }
        }
        let rest = norm(&rest) / size;
        if rest <= DEPENDENT {
            let others = certain.iter().zip(&parts);
            let others = others.map(|(&j, part)| (j, -part * square(&rows[j]).sqrt() / size));
            let mut row_factors: BTreeMap<usize, f64> =
                others.filter(|(_, x)| x.abs() > TAKES_PART).collect();
            row_factors.insert(k, 1.0);
            relations.push(Relation { row_factors, rest });
        }
    }
    let found = last_rows(relations)?.into_iter().map(|k| part[k]);
    Some(found.collect())
}

/// A sum of rows of length 1 times factors that is zero.
#[derive(Debug)]
struct Relation {
    row_factors: BTreeMap<usize, f64>,
    /// The length of the sum.
    rest: f64,
}

/// The rows that follow from those before them by some relations: the last row of each, after the last rows of the others have been
/// eliminated from it. None where the sum is not zero compared with the factor of this row.
fn last_rows(relations: Vec<Relation>) -> Option<Vec<usize>> {
    let mut found: BTreeMap<usize, Relation> = BTreeMap::new();
    for mut relation in relations {
        while let Some((last, factor)) = relation.row_factors.pop_last() {
            let Some(other) = found.get(&last) else {
                if relation.rest > DEPENDENT * factor.abs() {
                    return None;
                }
                relation.row_factors.insert(last, factor);
                found.insert(last, relation);
                break;
            };
            let ratio = factor / other.row_factors[&last];
            let sizes = relation.row_factors.values().map(|x| x.abs());
            let size = sizes.fold(factor.abs(), f64::max);
            for (row, x) in other.row_factors.range(..last) {
                *relation.row_factors.entry(*row).or_default() -= ratio * x;
            }
            relation.rest += ratio.abs() * other.rest;
            relation
                .row_factors
                .retain(|_, x| x.abs() > TAKES_PART * size);
        }
    }
    Some(found.into_keys().collect())
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

    /// The last rows of relations that share rows, with factors of any size.
    #[test]
    fn the_last_rows_of_relations_follow_from_those_before_them() {
        let relation = |row_factors: &[(usize, f64)], rest: f64| Relation {
            row_factors: row_factors.iter().copied().collect(),
            rest,
        };
        let relations = || {
            vec![
                relation(&[(0, 3.0), (2, -1.0), (7, 1.0)], 0.0),
                // less three times the first one: rows 0, 2 and 5
                relation(&[(2, 1.0), (5, 0.25), (7, 3.0)], 0.0),
                // less ten times what is left of the second one: rows 0 and 2
                relation(&[(0, -1.0), (5, 2.5), (2, 0.5)], 0.0),
            ]
        };
        assert_eq!(last_rows(relations()), Some(vec![2, 5, 7]));
        // a length far below the factors, but not below that of the last row
        let small = |rest: f64| last_rows(vec![relation(&[(0, 1.0), (4, 1e-4)], rest)]);
        assert_eq!(small(1e-14), Some(vec![4]));
        assert_eq!(small(1e-12), None);
        let mut inherited = relations();
        inherited[0].rest = 1e-9;
        assert_eq!(last_rows(inherited), None);
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
            // what is not certain is left to dense algebra
            if let Some(sparse) = IndependentRows::sparse(3, &rows, &b) {
                assert_eq!(sparse.dependent, dependent);
            }
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

    /// A row at a sine of 1e-7 to the others is independent, but not by these means.
    #[test]
    fn nearly_dependent_rows_are_not_certain() {
        let n = 12;
        let mut rows = chain(n);
        let mut near = [rows[3].clone(), rows[8].clone()].concat();
        near.push((5, 1e-7));
        rows.push(near);
        let b = vec![0.0; rows.len()];
        assert!(IndependentRows::sparse(n, &rows, &b).is_none());
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
                let rows = without(&sparse.dependent, &rows);
                let b: Vec<f64> = (0..rows.len()).map(|k| (k as f64).cos() * square(&rows[k]).sqrt()).collect();
                let sparse = IndependentRows::sparse(6, &rows, &b);
                prop_assert!(sparse.is_some_and(|sparse| is_solved(&rows, &b, &sparse.least_norm())));
            }
        }
    }
}
