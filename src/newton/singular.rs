//! The acceleration level where constraints lose rank, as in a parallelogram whose bars lie in one line.
//!
//! With S = G M^-1 G^T, G = Phi_q, the projection of v takes dv = -M^-1 G^T S^-1 G v, and lambda = S^-1 (G M^-1 (-r) + phi).
//! Close to such a pose one eigenvalue of S is the square of the distance from it, and rounding determines its eigenvector.
//! Dividing by this eigenvalue could throw the mechanism off its branch. The direction is left out: the mechanism moves on
//! unconstrained in it until a later stage, where the constraints have full rank again.

use faer::Mat;
use faer::linalg::solvers::Solve;

/// Pivots and eigenvalues below this part of the largest belong to a singular pose. For bars of 1 m it corresponds to a
/// distance of 1e-5 m, at which rounding turns the direction by 1e-6.
pub const SINGULAR: f64 = 1e-10;

/// M^-1 G^T and the pseudo-inverse of S.
#[derive(Debug)]
pub struct Truncated {
    n: usize,
    spread: Mat<f64>,
    inverse: Mat<f64>,
    mass: faer::linalg::solvers::Llt<f64>,
    gradient: Mat<f64>,
}

impl Truncated {
    /// From the acceleration-level matrix of n coordinates; `None` without a positive definite mass matrix.
    pub fn new(dense: &Mat<f64>, n: usize) -> Option<Truncated> {
        let m = dense.nrows() - n;
        let mass = Mat::from_fn(n, n, |i, j| dense[(i, j)]);
        let mass = mass.llt(faer::Side::Lower).ok()?;
        let gradient = Mat::from_fn(m, n, |i, j| dense[(n + i, j)]);
        let spread = mass.solve(gradient.transpose());
        let s = &gradient * &spread;
        // the equation of a row left out as redundant is lambda = 0
        let kept = |i: usize| dense[(n + i, n + i)] == 0.0;
        let size = Mat::from_fn(
            m,
            1,
            |i, _| if kept(i) { 1.0 / s[(i, i)].sqrt() } else { 0.0 },
        );
        let scaled = Mat::from_fn(m, m, |i, j| size[(i, 0)] * s[(i, j)] * size[(j, 0)]);
        let eigen = scaled.self_adjoint_eigen(faer::Side::Lower).ok()?;
        let (vectors, values) = (eigen.U(), eigen.S());
        let largest = (0..m).fold(0.0_f64, |l, k| l.max(values[k]));
        let mut inverse = Mat::zeros(m, m);
        for k in (0..m).filter(|&k| values[k] > SINGULAR * largest) {
            for i in 0..m {
                for j in 0..m {
                    inverse[(i, j)] +=
                        size[(i, 0)] * vectors[(i, k)] * vectors[(j, k)] * size[(j, 0)] / values[k];
                }
            }
        }
        Some(Truncated {
            n,
            spread,
            inverse,
            mass,
            gradient,
        })
    }

    /// The change of v that removes the violation phi of the velocity constraints.
    pub fn projection(&self, phi: &[f64]) -> Vec<f64> {
        let phi = Mat::from_fn(phi.len(), 1, |i, _| phi[i]);
        let change = &self.spread * (&self.inverse * phi);
        (0..self.n).map(|i| -change[(i, 0)]).collect()
    }

    /// (a, lambda) of M a + G^T lambda = -r, G a = -phi.
    pub fn accelerations(&self, r: &[f64], phi: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let right = Mat::from_fn(self.n, 1, |i, _| -r[i]);
        let free = self.mass.solve(&right);
        let phi = Mat::from_fn(phi.len(), 1, |i, _| phi[i]);
        let lambda = &self.inverse * (&self.gradient * &free + &phi);
        let a = &free - &self.spread * &lambda;
        (
            (0..self.n).map(|i| a[(i, 0)]).collect(),
            (0..phi.nrows()).map(|i| lambda[(i, 0)]).collect(),
        )
    }
}
