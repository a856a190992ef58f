//! Many linear equations with few entries each, in a time that is proportional to their number where they are those of chains and trees.

use super::lu::Symbolic;

/// Corrections of a solution.
const CORRECTIONS: usize = 2;

/// A row as its entries (index, value); an index may stand twice.
pub type SparseRow = Vec<(usize, f64)>;

/// A symmetric block of a positive definite matrix on some indices, row by row.
pub type SymmetricBlock<'a> = (&'a [usize], &'a [f64]);

/// The factors of [M G^T; G 0] for rows G.
#[derive(Debug)]
pub struct SparseRows {
    n: usize,
    rows: Vec<SparseRow>,
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl SparseRows {
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
            rows: rows.to_vec(),
            symbolic,
            values,
        })
    }

    /// With M = I, the square of the distance of row k from the span of the rows that were eliminated before it.
    pub fn squared_distance(&self, k: usize) -> f64 {
        -self.symbolic.pivot(&self.values, self.n + k)
    }

    /// [`Symbolic::smallest_tie`].
    pub fn smallest_tie(&self) -> f64 {
        self.symbolic.smallest_tie(&self.values)
    }

    /// The rows G.
    pub fn rows(&self) -> &[SparseRow] {
        &self.rows
    }

    /// The x with G x = b that minimises 1/2 x . M x - c . x.
    pub fn solve(&self, c: &[f64], b: &[f64]) -> Vec<f64> {
        let [mut x, _] = self.solve_both(c, b);
        let zero = vec![0.0; self.n];
        // the pivots are squares of distances, so G x = b holds to half of the digits at worst, and to all after some corrections
        for _ in 0..CORRECTIONS {
            let rest = self.rows.iter().zip(b).map(|(row, b)| b - times(row, &x));
            let [more, _] = self.solve_both(&zero, &rest.collect::<Vec<f64>>());
            x.iter_mut().zip(more).for_each(|(x, d)| *x += d);
        }
        x
    }

    /// The same, and the multipliers of G x = b: M x + G^T mu = c.
    fn solve_both(&self, c: &[f64], b: &[f64]) -> [Vec<f64>; 2] {
        let mut x = [c, b].concat();
        self.symbolic.solve(&self.values, &mut x);
        let mu = x.split_off(self.n);
        [x, mu]
    }
}

/// The product of a row and x.
pub fn times(row: &SparseRow, x: &[f64]) -> f64 {
    row.iter().map(|(i, g)| g * x[*i]).sum()
}

/// The sum of the squares of the entries of a row: the square of its length, where every index stands once.
pub fn square(row: &SparseRow) -> f64 {
    row.iter().map(|(_, g)| g * g).sum()
}

/// A row with all its n entries.
pub fn full_row(n: usize, row: &SparseRow) -> Vec<f64> {
    let mut full = vec![0.0; n];
    row.iter().for_each(|(i, value)| full[*i] += value);
    full
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Differences of neighbours in a chain of n unknowns, each with a third unknown.
    pub fn chain(n: usize) -> Vec<SparseRow> {
        let row = |k: usize| {
            vec![
                (k, -1.0),
                (k + 1, 1.0),
                ((7 * k) % n, 0.3 + 0.01 * k as f64),
            ]
        };
        (0..n - 1).map(row).collect()
    }

    pub fn assert_close(x: &[f64], y: &[f64]) {
        let size = y.iter().fold(1.0_f64, |m, y| m.max(y.abs()));
        let pairs = x.iter().zip(y);
        let off = pairs.fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
        // rounding times a condition number of some thousand
        assert!(off < 1e-11 * size, "{off} {size}");
    }

    /// A pendulum of pendulums whose every angle is given: the condition number of G G^T is beyond ten digits.
    #[test]
    fn ill_conditioned_equations_are_satisfied_to_rounding() {
        let n = 400;
        let rows: Vec<SparseRow> = (0..n)
            .map(|k| match k {
                0 => vec![(0, 1.0)],
                1 => vec![(0, -2.0), (1, 1.0)],
                _ => vec![(k - 2, 1.0), (k - 1, -2.0), (k, 1.0)],
            })
            .collect();
        let b: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
        let blocks: Vec<usize> = (0..n).collect();
        let blocks: Vec<SymmetricBlock> = blocks.chunks(1).map(|i| (i, &[1.0][..])).collect();
        let factors = SparseRows::factor(n, &rows, &blocks).unwrap();
        let x = factors.solve(&vec![0.0; n], &b);
        let size = x.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for (row, b) in rows.iter().zip(&b) {
            // a few roundings of the numbers that are added
            assert!((times(row, &x) - b).abs() < 1e-14 * size, "{size}");
        }
    }
}
