//! Prescribed relative angle of two directions: welds, guides that do not turn, driven joints.

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::marker::Spin;
use crate::math::plane::{Rotation, Vec2, quarter_turn, rotation};
use crate::motion::{Function, Knot};
use crate::system::State;

/// Phi = s (R(phi(t)) d_1) x d_2 with directions d of two bodies, R the rotation by the prescribed angle of the second
/// relative to the first, and s = 1/(|d_1| |d_2|) of the undeformed bodies.
///
/// One row. For a slope it asks for the direction of the tangent, r'_y = 0 along a fixed first side, and leaves the
/// stretch free. The second zero, d_2 turned by half a turn, is excluded when the mechanism is assembled.
#[derive(Debug)]
pub struct Align {
    /// The first direction.
    pub first: Spin,
    /// The second.
    pub second: Spin,
    /// phi(t) \[rad\].
    pub angle: Function,
    /// 1/(|d_1| |d_2|) \[1 over the units of the directions\].
    pub scale: f64,
}

/// Everything about both directions at one instant.
struct Directions {
    /// d_1.
    first: Vec2,
    /// R.
    turn: Rotation,
    /// R d_1 and d_2.
    d: [Vec2; 2],
}

impl Align {
    fn directions(&self, at: &State) -> Directions {
        let turn = rotation(self.angle.at(at.t)[0]);
        let first = self.first.vector(&at.q);
        let d = [turn * first, self.second.vector(&at.q)];
        Directions { first, turn, d }
    }

    /// cos of the angle error times |d_1| |d_2|.
    fn along(&self, at: &State) -> f64 {
        let Directions { d, .. } = self.directions(at);
        d[0].dot(&d[1])
    }
}

impl Constraint for Align {
    fn effect(&self) -> Effect {
        "direction_constraint"
    }

    fn unit(&self) -> &'static str {
        "rad"
    }

    fn rows(&self) -> usize {
        1
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.first.coordinates(), self.second.coordinates()]
    }

    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let Directions { first, turn, d } = self.directions(at);
        let (first, second) = (self.first.columns(first), self.second.columns(d[1]));
        for (g, column) in gradient[0].iter_mut().zip(first.iter()) {
            *g = self.scale * (turn * column).perp(&d[1]);
        }
        for (g, column) in gradient[0][first.len()..].iter_mut().zip(second.iter()) {
            *g = self.scale * d[0].perp(column);
        }
        [self.scale * d[0].perp(&d[1]), 0.0]
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let Directions { first, turn, d } = self.directions(at);
        let (first, second) = (self.first.columns(first), self.second.columns(d[1]));
        let s = lambda[0] * self.scale;
        for (i, a) in first.iter().enumerate() {
            for (j, b) in second.iter().enumerate() {
                let mixed = s * (turn * a).perp(b);
                out.add(i, first.len() + j, mixed);
                out.add(first.len() + j, i, mixed);
            }
        }
        // the second derivative of a unit direction by its angle is minus itself
        let bend = -s * d[0].perp(&d[1]);
        if let Spin::Angle { .. } = self.first {
            out.add(0, 0, bend);
        }
        if let Spin::Angle { .. } = self.second {
            out.add(first.len(), first.len(), bend);
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let Directions { first, turn, d } = self.directions(at);
        let turning = self.angle.at(at.t)[1];
        let first = turn * self.first.vector_rate(&at.v, first) + turning * quarter_turn(d[0]);
        let second = self.second.vector_rate(&at.v, d[1]);
        [self.scale * (first.perp(&d[1]) + d[0].perp(&second)), 0.0]
    }

    /// s phi_t (J R d_1 x d_2), J the quarter turn.
    fn drift(&self, at: &State) -> f64 {
        -self.scale * self.angle.at(at.t)[1] * self.along(at)
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.angle.knots(until)
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let Directions { first, turn, d } = self.directions(at);
        let [_, turning, growing] = self.angle.at(at.t);
        let rate = turn * self.first.vector_rate(&at.v, first);
        let first_dot = rate + turning * quarter_turn(d[0]);
        let first_ddot = turn * self.first.vector_acceleration(&at.v, &at.a, first)
            + 2.0 * turning * quarter_turn(rate)
            + growing * quarter_turn(d[0])
            - turning * turning * d[0];
        let second_dot = self.second.vector_rate(&at.v, d[1]);
        let second_ddot = self.second.vector_acceleration(&at.v, &at.a, d[1]);
        let sum =
            first_ddot.perp(&d[1]) + 2.0 * first_dot.perp(&second_dot) + d[0].perp(&second_ddot);
        [self.scale * sum, 0.0]
    }

    fn half_turn(&self, at: &State) -> bool {
        self.along(at) < 0.0
    }

    /// -lambda dPhi/d(angle of the second direction).
    fn couple(&self, at: &State, lambda: [f64; ROWS]) -> f64 {
        -lambda[0] * self.scale * self.along(at)
    }
}
