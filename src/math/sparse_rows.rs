//! Many linear equations with few entries each: ranks and least-norm solutions in a time that is proportional to their number where
//! they are those of chains and trees. [`super::dense`] decides what is not certain here.

use super::lu::Symbolic;

/// Rows are certainly independent if the square of the sine of each to the span of those before it is larger than this: far above
/// the rounding of a square, and above every row that [`super::dense`] takes for dependent.
const INDEPENDENT: f64 = 1e-10;

/// A row as its entries (index, value); an index may stand twice.
pub type SparseRow = Vec<(usize, f64)>;

/// A symmetric block of a positive definite matrix on some indices, row by row.
pub type SymmetricBlock<'a> = (&'a [usize], &'a [f64]);

/// The factors of [M G^T; G 0] for rows G.
#[derive(Debug)]
pub struct SparseRows {
    n: usize,
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl SparseRows {
    /// With M = I for n unknowns. None unless all rows are certainly independent: the pivot of a row is minus the square of its
    /// distance from the span of the rows that were eliminated before it.
    pub fn independent(n: usize, rows: &[SparseRow]) -> Option<SparseRows> {
        let identity: Vec<usize> = (0..n).collect();
        let identity: Vec<SymmetricBlock> = identity.chunks(1).map(|i| (i, &[1.0][..])).collect();
        let factors = SparseRows::factor(n, rows, &identity)?;
        let is_far = |(k, row): (usize, &SparseRow)| {
            let distance = -factors.symbolic.pivot(&factors.values, n + k);
            distance > INDEPENDENT * row.iter().map(|(_, g)| g * g).sum::<f64>()
        };
        rows.iter().enumerate().all(is_far).then_some(factors)
    }

    /// With M the sum of some blocks. None where a pivot is too small.
    pub fn factor(n: usize, rows: &[SparseRow], blocks: &[SymmetricBlock]) -> Option<SparseRows> {
        let size = n + rows.len();
        let mut after = vec![Vec::new(); size];
        let mut cliques: Vec<Vec<usize>> = blocks.iter().map(|(own, _)| own.to_vec()).collect();
        for (k, row) in rows.iter().enumerate() {
            let mut own: Vec<usize> = row.iter().map(|(i, _)| *i).collect();
            own.sort_unstable();
            own.dedup();
            // a row is eliminated after its unknowns
            after[n + k].clone_from(&own);
            own.push(n + k);
            cliques.push(own);
        }
        let symbolic = Symbolic::analyse(size, &cliques, &after);
        let mut values = vec![0.0; symbolic.len()];
        let mut add =
            |i: usize, j: usize, value: f64| values[symbolic.slot(i, j) as usize] += value;
        for (own, block) in blocks {
            for (i, row) in own.iter().zip(block.chunks(own.len())) {
                own.iter()
                    .zip(row)
                    .for_each(|(j, value)| add(*i, *j, *value));
            }
        }
        for (k, row) in rows.iter().enumerate() {
            for (i, g) in row {
                add(n + k, *i, *g);
                add(*i, n + k, *g);
            }
        }
        symbolic.factor(&mut values).ok()?;
        Some(SparseRows {
            n,
            symbolic,
            values,
        })
    }

    /// The x with G x = b that minimises 1/2 x . M x - c . x.
    pub fn solve(&self, c: &[f64], b: &[f64]) -> Vec<f64> {
        let mut x = [c, b].concat();
        self.symbolic.solve(&self.values, &mut x);
        x.truncate(self.n);
        x
    }
}

/// A row with all its n entries.
pub fn full_row(n: usize, row: &SparseRow) -> Vec<f64> {
    let mut full = vec![0.0; n];
    row.iter().for_each(|(i, value)| full[*i] += value);
    full
}

#[cfg(test)]
mod tests {
    use super::super::dense::{Added, Equations};
    use super::*;
    use faer::Mat;

    /// Differences of neighbours in a chain of n unknowns, each with a third unknown.
    fn chain(n: usize) -> Vec<SparseRow> {
        let row = |k: usize| {
            vec![
                (k, -1.0),
                (k + 1, 1.0),
                ((7 * k) % n, 0.3 + 0.01 * k as f64),
            ]
        };
        (0..n - 1).map(row).collect()
    }

    fn dense(n: usize, rows: &[SparseRow], b: &[f64]) -> (Equations, usize) {
        let mut equations = Equations::default();
        let mut dependent = 0;
        for (row, b) in rows.iter().zip(b) {
            let added = equations.add(&full_row(n, row), *b);
            dependent += usize::from(added != Added::Independent);
        }
        (equations, dependent)
    }

    #[test]
    fn solutions_are_those_of_the_dense_equations() {
        let n = 30;
        let rows = chain(n);
        let b: Vec<f64> = (0..n - 1).map(|k| (k as f64).sin()).collect();
        let (equations, dependent) = dense(n, &rows, &b);
        assert_eq!(dependent, 0);
        let close = |x: &[f64], y: &[f64]| {
            let size = y.iter().fold(1.0_f64, |m, y| m.max(y.abs()));
            let off = x
                .iter()
                .zip(y)
                .map(|(x, y)| (x - y).abs())
                .fold(0.0, f64::max);
            // rounding times a condition number of some thousand
            assert!(off < 1e-11 * size, "{off} {size}");
        };
        let sparse = SparseRows::independent(n, &rows).unwrap();
        close(&sparse.solve(&vec![0.0; n], &b), &equations.least_norm(n));
        // least energy: masses of pairs, coupled
        let pairs: Vec<usize> = (0..n).collect();
        let block = [2.0, 0.5, 0.5, 1.0];
        let blocks: Vec<SymmetricBlock> = pairs.chunks(2).map(|own| (own, &block[..])).collect();
        let energy = Mat::from_fn(n, n, |i, j| match (i / 2 == j / 2, i == j) {
            (true, true) => [2.0, 1.0][i % 2],
            (true, false) => 0.5,
            _ => 0.0,
        });
        let c: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).cos()).collect();
        let minus: Vec<f64> = c.iter().map(|c| -c).collect();
        let sparse = SparseRows::factor(n, &rows, &blocks).unwrap();
        close(
            &sparse.solve(&minus, &b),
            &equations.least_energy(&energy, &c),
        );
    }

    #[test]
    fn dependent_rows_are_never_certain() {
        let n = 12;
        let mut rows = chain(n);
        assert!(SparseRows::independent(n, &rows).is_some());
        // the sum of two of them
        let sum = [rows[3].clone(), rows[8].clone()].concat();
        rows.push(sum);
        assert!(SparseRows::independent(n, &rows).is_none());
        rows.pop();
        rows.push(vec![]);
        assert!(
            SparseRows::independent(n, &rows).is_none(),
            "a row of zeros"
        );
    }
}
