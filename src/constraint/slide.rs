//! A point on a line: the guide of a prismatic joint, a pin in a slot.

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::marker::{Separation, Spin};
use crate::math::plane::{Rotation, Vec2, quarter_turn};
use crate::system::State;

/// Phi = u x e with e from the guide's point to the slider and the unit direction u of the line, one row: the distance of the
/// slider from the line \[m\].
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// From the guide's point to the slider.
    pub ends: Separation,
    /// The body that carries the line.
    pub spin: Spin,
    /// From the direction of the spin to that of the line.
    pub turn: Rotation,
    /// 1/|d| of the spin's undeformed direction.
    pub scale: f64,
}

/// The direction d of the spin, the arms of the ends, u and e.
struct SlideVectors {
    d: Vec2,
    arms: [Vec2; 2],
    u: Vec2,
    e: Vec2,
}

impl Slide {
    fn turned(&self, x: Vec2) -> Vec2 {
        self.scale * (self.turn * x)
    }

    fn vectors(&self, at: &State) -> SlideVectors {
        let (d, arms) = (self.spin.vector(&at.q), self.ends.arms(&at.q));
        SlideVectors {
            d,
            arms,
            u: self.turned(d),
            e: self.ends.vector(&at.q, arms),
        }
    }

    /// The rates of u and e.
    fn rates(&self, at: &State, vectors: &SlideVectors) -> [Vec2; 2] {
        let u_dot = self.turned(self.spin.vector_rate(&at.v, vectors.d));
        [u_dot, self.ends.rate(&at.v, vectors.arms)]
    }

    /// Distance along the line from the guide's point to the slider \[m\] and its rate \[m/s\].
    pub fn travel(&self, at: &State) -> [f64; 2] {
        let vectors = self.vectors(at);
        let [u_dot, e_dot] = self.rates(at, &vectors);
        let SlideVectors { u, e, .. } = vectors;
        // the slope of a flexible guide is longer than 1 where the link is stretched
        let (size, along) = (u.norm(), u.dot(&e));
        let stretching = u.dot(&u_dot) / (size * size);
        [
            along / size,
            (u.dot(&e_dot) + u_dot.dot(&e) - along * stretching) / size,
        ]
    }
}

impl Constraint for Slide {
    fn effect(&self) -> Effect {
        "sliding_constraint"
    }

    fn rows(&self) -> usize {
        1
    }

    /// The spin stands before both points.
    fn sides(&self) -> [Vec<usize>; 2] {
        let [guide, slider] = self.ends.sides();
        [[self.spin.coordinates(), guide].concat(), slider]
    }

    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let SlideVectors { d, arms, u, e } = self.vectors(at);
        let (turning, moving) = (self.spin.columns(d), self.ends.columns(arms));
        let turning = turning.iter().map(|column| self.turned(*column).perp(&e));
        let moving = moving.iter().map(|column| u.perp(column));
        for (g, x) in gradient[0].iter_mut().zip(turning.chain(moving)) {
            *g = x;
        }
        [u.perp(&e), 0.0]
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let SlideVectors { d, arms, u, e } = self.vectors(at);
        let (s, first) = (lambda[0], self.spin.width());
        let moving = self.ends.columns(arms);
        for (i, turning) in self.spin.columns(d).iter().enumerate() {
            let turning = self.turned(*turning);
            for (j, column) in moving.iter().enumerate() {
                let mixed = s * turning.perp(column);
                out.add(i, first + j, mixed);
                out.add(first + j, i, mixed);
            }
        }
        if let Spin::Angle { .. } = self.spin {
            out.add(0, 0, -s * u.perp(&e));
        }
        for (theta, _, bend) in self.ends.bends(arms) {
            out.add(first + theta, first + theta, s * u.perp(&bend));
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let vectors = self.vectors(at);
        let [u_dot, e_dot] = self.rates(at, &vectors);
        [u_dot.perp(&vectors.e) + vectors.u.perp(&e_dot), 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let vectors = self.vectors(at);
        let [u_dot, e_dot] = self.rates(at, &vectors);
        let SlideVectors { d, arms, u, e } = vectors;
        let u_ddot = self.turned(self.spin.vector_acceleration(&at.v, &at.a, d));
        let e_ddot = self.ends.acceleration(&at.v, &at.a, arms);
        let sum = u_ddot.perp(&e) + 2.0 * u_dot.perp(&e_dot) + u.perp(&e_ddot);
        [sum, 0.0]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        -lambda[0] * quarter_turn(self.vectors(at).u)
    }
}
