//! Constant distance of two nodes (eq. 2).

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::math::plane::{Vec2, pair};
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
    #[inline]
    fn difference(&self, x: &[f64]) -> Vec2 {
        pair(x, self.j) - pair(x, self.i)
    }
}

impl Constraint for Length {
    fn effect(&self) -> Effect {
        "length_constraint"
    }

    fn rows(&self) -> usize {
        1
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.i, self.j].map(|x| vec![x, x + 1])
    }

    #[inline]
    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let d = self.difference(&at.q);
        let u = 1.0 / self.length * d;
        gradient[0][..4].copy_from_slice(&[-u.x, -u.y, u.x, u.y]);
        // (|d|^2 - l^2) as a product of nearly equal numbers' difference: |d| - l is what matters
        let distance = d.norm();
        [
            (distance - self.length) * (distance + self.length) / (2.0 * self.length),
            0.0,
        ]
    }

    /// lambda/l (\[I, -I\], \[-I, I\]).
    #[inline]
    fn curvature(&self, _: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let s = lambda[0] / self.length;
        for i in 0..4 {
            out.add(i, i, s);
            out.add(i, (i + 2) % 4, -s);
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let rate = self.difference(&at.q).dot(&self.difference(&at.v));
        [rate / self.length, 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let [d, rate, second] = [&at.q, &at.v, &at.a].map(|x| self.difference(x));
        [(d.dot(&second) + rate.dot(&rate)) / self.length, 0.0]
    }
}
