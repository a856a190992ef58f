//! Small dense linear algebra for what happens once, before a run: ranks, least-norm solutions.

use faer::Mat;
use faer::linalg::solvers::Solve;

/// Rows whose part outside the rows before them is smaller than this part of the row depend on them.
pub(super) const DEPENDENT: f64 = 1e-9;

/// Linear equations a . x = b, kept as orthonormal rows.
#[derive(Debug, Clone, Default)]
pub struct Equations {
    rows: Vec<(Vec<f64>, f64)>,
}

impl Equations {
    /// Adds a . x = b by Gram and Schmidt's method, twice for the sake of rounding, unless a depends on the rows before it. True if it
    /// was added.
    pub fn add(&mut self, a: &[f64], b: f64) -> bool {
        let size = norm(a);
        let (mut row, mut right) = (a.to_vec(), b);
        for _ in 0..2 {
            for (q, beta) in &self.rows {
                let along: f64 = q.iter().zip(&row).map(|(x, y)| x * y).sum();
                row.iter_mut().zip(q).for_each(|(r, q)| *r -= along * q);
                right -= along * beta;
            }
        }
        let rest = norm(&row);
        if rest <= DEPENDENT * size {
            return false;
        }
        row.iter_mut().for_each(|r| *r /= rest);
        self.rows.push((row, right / rest));
        true
    }

    /// The x of least norm that satisfies them.
    pub fn least_norm(&self, n: usize) -> Vec<f64> {
        let mut x = vec![0.0; n];
        for (q, beta) in &self.rows {
            x.iter_mut().zip(q).for_each(|(x, q)| *x += beta * q);
        }
        x
    }

    /// The part of x that no equation sees.
    pub fn free_part(&self, x: &[f64]) -> Vec<f64> {
        let mut rest = x.to_vec();
        for _ in 0..2 {
            for (q, _) in &self.rows {
                let along: f64 = q.iter().zip(&rest).map(|(x, y)| x * y).sum();
                rest.iter_mut().zip(q).for_each(|(r, q)| *r -= along * q);
            }
        }
        rest
    }

    /// The x that satisfies them and minimises 1/2 x . M x + c . x for a symmetric positive definite M.
    pub fn least_energy(&self, m: &Mat<f64>, c: &[f64]) -> Vec<f64> {
        let (n, k) = (m.nrows(), self.rows.len());
        let size = n + k;
        let matrix = Mat::from_fn(size, size, |i, j| match (i < n, j < n) {
            (true, true) => m[(i, j)],
            (true, false) => self.rows[j - n].0[i],
            (false, true) => self.rows[i - n].0[j],
            (false, false) => 0.0,
        });
        let right = Mat::from_fn(
            size,
            1,
            |i, _| {
                if i < n { -c[i] } else { self.rows[i - n].1 }
            },
        );
        let x = matrix.partial_piv_lu().solve(&right);
        (0..n).map(|i| x[(i, 0)]).collect()
    }
}

pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equations() -> Equations {
        let mut e = Equations::default();
        assert!(e.add(&[1.0, 2.0, 0.0], 3.0));
        assert!(e.add(&[0.0, 1.0, 1.0], 1.0));
        e
    }

    #[test]
    fn dependent_equations_are_left_out() {
        let mut e = equations();
        // the sum of both, and zero
        assert!(!e.add(&[1.0, 3.0, 1.0], 4.25));
        assert!(!e.add(&[0.0; 3], 1.0));
        assert_eq!(e.rows.len(), 2);
    }

    #[test]
    fn solutions_satisfy_the_equations() {
        let e = equations();
        let energy = Mat::from_fn(3, 3, |i, j| if i == j { 1.0 + i as f64 } else { 0.2 });
        for x in [e.least_norm(3), e.least_energy(&energy, &[0.1, -0.3, 0.2])] {
            assert!((x[0] + 2.0 * x[1] - 3.0).abs() < 1e-14);
            assert!((x[1] + x[2] - 1.0).abs() < 1e-14);
        }
        let free = e.free_part(&[1.0, 0.0, 0.0]);
        assert!((free[0] + 2.0 * free[1]).abs() < 1e-15 && (free[1] + free[2]).abs() < 1e-15);
        // gradient of the energy has no part along what is free
        let x = e.least_energy(&energy, &[0.1, -0.3, 0.2]);
        let c = [0.1, -0.3, 0.2];
        let slope: f64 = (0..3)
            .map(|i| free[i] * (c[i] + (0..3).map(|j| energy[(i, j)] * x[j]).sum::<f64>()))
            .sum();
        assert!(slope.abs() < 1e-14);
    }
}
