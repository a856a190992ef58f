//! The rows of many linear equations that do not depend on those before them, in a time that grows little faster than their number where
//! few of them depend on others. [`super::dense`] decides what is not certain here.

use super::dense::{Added, Equations};
use super::groups::Groups;
use super::sparse_rows::{SparseRow, SparseRows, SymmetricBlock, full_row, square};
use indexmap::{IndexMap, IndexSet};
use std::collections::HashMap;

/// Rows are certainly independent if the square of the sine of each to the span of those eliminated before it is larger than this: far
/// above the rounding of a square, and above every row that [`super::dense`] takes for dependent.
const INDEPENDENT: f64 = 1e-10;
/// What is added to these squares where they may be zero: above their rounding, far below [`INDEPENDENT`].
const SHIFT: f64 = 1e-13;
/// A row takes part in a sum of rows if its term is larger than this fraction of the sum: above the rounding of the terms, far
/// below what [`super::dense`] takes for dependent.
const TAKES_PART: f64 = 1e-11;

/// Rows, of which some may depend on those before them.
#[derive(Debug)]
pub struct IndependentRows {
    n: usize,
    /// The rows that depend on those before them, ascending.
    pub dependent: Vec<usize>,
    /// The factors of the others, with M = I.
    factors: SparseRows,
}

impl IndependentRows {
    /// None where it is not certain which rows are independent.
    pub fn new(n: usize, rows: &[SparseRow]) -> Option<IndependentRows> {
        if let Some(factors) = certainly_independent(n, rows) {
            return Some(IndependentRows {
                n,
                dependent: Vec::new(),
                factors,
            });
        }
        let dependent = dependent(rows)?;
        let factors = certainly_independent(n, &without(&dependent, rows))?;
        Some(IndependentRows {
            n,
            dependent,
            factors,
        })
    }

    /// What belongs to the independent rows, of `all` rows.
    pub fn chosen<T: Clone>(&self, all: &[T]) -> Vec<T> {
        without(&self.dependent, all)
    }

    /// The x of least norm that satisfies the independent equations of G x = b.
    pub fn least_norm(&self, b: &[f64]) -> Vec<f64> {
        self.factors.solve(&vec![0.0; self.n], &self.chosen(b))
    }

    /// The part of x that no equation sees.
    pub fn free_part(&self, x: &[f64]) -> Vec<f64> {
        self.factors.solve(x, &vec![0.0; self.factors.count()])
    }
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
    rows.iter().enumerate().all(is_far).then_some(factors)
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

/// The same of a part of the rows. Every row that may depend on others is a sum of rows that are certainly independent; the rows of
/// such sums are compared with each other by [`super::dense`].
fn dependent_of(all: &[SparseRow], part: &[usize]) -> Option<Vec<usize>> {
    let (rows, n) = local(all, part);
    let shifted = SparseRows::factor_shifted(n, &rows, &identity(&indices(n)), SHIFT)?;
    let doubtful =
        |k: &usize| shifted.squared_distance(*k) <= (INDEPENDENT + SHIFT) * square(&rows[*k]);
    let doubtful: Vec<usize> = (0..rows.len()).filter(doubtful).collect();
    let certain = without(&doubtful, &indices(rows.len()));
    let factors = certainly_independent(n, &without(&doubtful, &rows))?;
    let zero = vec![0.0; certain.len()];
    let mut sums = Groups::new(rows.len());
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
        for (&other, part) in certain.iter().zip(&parts) {
            if part.abs() * square(&rows[other]).sqrt() > TAKES_PART * size {
                sums.unite(k, other);
            }
        }
    }
    let mut found = Vec::new();
    for sum in several(sums) {
        let (rows, n) = local(&rows, &sum);
        let mut equations = Equations::default();
        let rows = sum.iter().zip(&rows);
        let depends = rows.filter(|(_, row)| {
            let added = equations.add(&full_row(n, row), 0.0);
            added != Added::Independent
        });
        found.extend(depends.map(|(&k, _)| part[k]));
    }
    Some(found)
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
    use super::super::sparse_rows::tests::{assert_close, chain, dense};
    use super::*;
    use proptest::prelude::*;

    fn assert_equal(n: usize, rows: &[SparseRow]) -> IndependentRows {
        let b: Vec<f64> = (0..rows.len()).map(|k| (k as f64).sin()).collect();
        let (equations, dependent) = dense(n, rows, &b);
        let sparse = IndependentRows::new(n, rows).unwrap();
        assert_eq!(sparse.dependent, dependent);
        let direction: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).cos()).collect();
        assert_close(&sparse.least_norm(&b), &equations.least_norm(n));
        assert_close(
            &sparse.free_part(&direction),
            &equations.free_part(&direction),
        );
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

    /// A row at a sine of 1e-7 to the others is independent, but not by these means.
    #[test]
    fn nearly_dependent_rows_are_not_certain() {
        let n = 12;
        let mut rows = chain(n);
        let mut near = [rows[3].clone(), rows[8].clone()].concat();
        near.push((5, 1e-7));
        rows.push(near);
        assert!(IndependentRows::new(n, &rows).is_none());
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
    }
}
