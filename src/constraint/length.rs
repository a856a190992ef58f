//! Constant distance of two nodes (eq. 2).

use crate::math::plane::{Vec2, dot, scale};
use crate::system::State;

/// Phi = (|r_j - r_i|^2 - l^2)/(2 l).
///
/// Eq. 2 divided by 2 l: the same zero, in metres, and the multiplier is the axial force in newtons, positive for
/// tension.
#[derive(Debug, Clone, Copy)]
pub struct Length {
    /// Index of the first coordinate of r_i.
    pub i: usize,
    /// Index of the first coordinate of r_j.
    pub j: usize,
    /// l \[m\].
    pub length: f64,
}

impl Length {
    /// The coordinates in local order.
    pub fn coordinates(&self) -> [usize; 4] {
        [self.i, self.i + 1, self.j, self.j + 1]
    }

    #[inline]
    fn difference(&self, x: &[f64]) -> Vec2 {
        [x[self.j] - x[self.i], x[self.j + 1] - x[self.i + 1]]
    }

    /// Phi \[m\].
    #[inline]
    pub fn value(&self, q: &[f64]) -> f64 {
        let d = self.difference(q);
        // (|d|^2 - l^2) as a product of nearly equal numbers' difference: |d| - l is what matters
        let distance = dot(d, d).sqrt();
        (distance - self.length) * (distance + self.length) / (2.0 * self.length)
    }

    /// Phi_q in local order.
    #[inline]
    pub fn gradient(&self, q: &[f64]) -> [f64; 4] {
        let d = scale(1.0 / self.length, self.difference(q));
        [-d[0], -d[1], d[0], d[1]]
    }

    /// d(Phi_q^T lambda)/dq = lambda/l (\[I, -I\], \[-I, I\]): the number before the identity blocks.
    #[inline]
    pub fn curvature(&self, lambda: f64) -> f64 {
        lambda / self.length
    }

    /// Phi_q v.
    pub fn velocity(&self, at: &State) -> f64 {
        dot(self.difference(&at.q), self.difference(&at.v)) / self.length
    }

    /// Phi_q a + d(Phi_q)/dt v.
    pub fn acceleration(&self, at: &State) -> f64 {
        let rate = self.difference(&at.v);
        (dot(self.difference(&at.q), self.difference(&at.a)) + dot(rate, rate)) / self.length
    }
}
