//! A slope vector held in full: the second kind of clamp of a flexible end.

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::marker::Spin;
use crate::math::plane::{Rotation, Vec2, pair};
use crate::system::State;

/// Phi = r' - s R d_1, two rows: direction and stretch of the slope r' of the second side follow the direction d_1 of the
/// first, turned by a constant angle; s = 1/|d_1| of the undeformed body.
///
/// With a bending energy EI/2 r''.r'' this is another boundary condition than holding the direction alone, with another
/// limit under mesh refinement.
#[derive(Debug, Clone, Copy)]
pub struct ClampSlope {
    /// The first direction.
    pub first: Spin,
    /// Index of the first coordinate of r'.
    pub slope: usize,
    /// R.
    pub turn: Rotation,
    /// 1/|d_1|.
    pub scale: f64,
    /// -1 where the slope is on the first side of the joint: its couple is that of the first side on the second.
    pub sign: f64,
}

impl ClampSlope {
    fn turned(&self, x: Vec2) -> Vec2 {
        self.scale * (self.turn * x)
    }

    fn slope(&self, x: &[f64]) -> Vec2 {
        pair(x, self.slope)
    }
}

impl Constraint for ClampSlope {
    fn effect(&self) -> Effect {
        "direction_constraint"
    }

    fn unit(&self) -> &'static str {
        "rad"
    }

    fn rows(&self) -> usize {
        2
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.first.coordinates(), vec![self.slope, self.slope + 1]]
    }

    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let d = self.first.vector(&at.q);
        let columns = self.first.columns(d);
        for (c, column) in columns.iter().enumerate() {
            let turned = self.turned(*column);
            gradient[0][c] = -turned.x;
            gradient[1][c] = -turned.y;
        }
        let slope = columns.len();
        gradient[0][slope..slope + 2].copy_from_slice(&[1.0, 0.0]);
        gradient[1][slope..slope + 2].copy_from_slice(&[0.0, 1.0]);
        (self.slope(&at.q) - self.turned(d)).into()
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        if let Spin::Angle { .. } = self.first {
            let d = self.turned(self.first.vector(&at.q));
            out.add(0, 0, Vec2::from(lambda).dot(&d));
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let first = self.first.vector_rate(&at.v, self.first.vector(&at.q));
        (self.slope(&at.v) - self.turned(first)).into()
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let d = self.first.vector(&at.q);
        let first = self.first.vector_acceleration(&at.v, &at.a, d);
        (self.slope(&at.a) - self.turned(first)).into()
    }

    /// -lambda . dr'/d(angle) with r' turned as a whole; the part of lambda along r' holds the stretch and has none.
    fn couple(&self, at: &State, lambda: [f64; ROWS]) -> f64 {
        -self.sign * self.slope(&at.q).perp(&Vec2::from(lambda))
    }
}
