//! A point on a line: the guide of a prismatic joint, a pin in a slot.

use super::{Constraint, Curvature, Gradient, ROWS, WIDTH};
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
    /// Direction of the line relative to that of the spin \[rad\].
    pub angle: f64,
    /// 1/|d| of the spin's undeformed direction.
    pub scale: f64,
}

/// u and e, and their rates.
struct SlideVectors {
    u: Vec2,
    e: Vec2,
    u_dot: Vec2,
    e_dot: Vec2,
}

impl Slide {
    fn turned(&self, x: Vec2) -> Vec2 {
        self.scale * (Rotation::new(self.angle) * x)
    }

    /// u and e.
    fn at(&self, at: &State) -> (Vec2, Vec2) {
        let u = self.turned(self.spin.vector(&at.q));
        (u, self.ends.vector(&at.q))
    }

    fn vectors(&self, at: &State) -> SlideVectors {
        let (u, e) = self.at(at);
        SlideVectors {
            u,
            e,
            u_dot: self.turned(self.spin.vector_rate(&at.q, &at.v)),
            e_dot: self.ends.rate(&at.q, &at.v),
        }
    }

    /// Distance along the line from the guide's point to the slider \[m\] and its rate \[m/s\].
    pub fn travel(&self, at: &State) -> [f64; 2] {
        let SlideVectors { u, e, u_dot, e_dot } = self.vectors(at);
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

    fn value(&self, at: &State) -> [f64; ROWS] {
        let (u, e) = self.at(at);
        [u.perp(&e), 0.0]
    }

    fn gradient(&self, at: &State) -> Gradient {
        let (u, e) = self.at(at);
        let (turning, moving) = (self.spin.columns(&at.q), self.ends.columns(&at.q));
        let turning = turning.iter().map(|d| self.turned(*d).perp(&e));
        let moving = moving.iter().map(|column| u.perp(column));
        let mut gradient = [[0.0; WIDTH]; ROWS];
        for (g, x) in gradient[0].iter_mut().zip(turning.chain(moving)) {
            *g = x;
        }
        gradient
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let (u, e) = self.at(at);
        let (s, first) = (lambda[0], self.spin.width());
        for (i, d) in self.spin.columns(&at.q).iter().enumerate() {
            let d = self.turned(*d);
            for (j, column) in self.ends.columns(&at.q).iter().enumerate() {
                let mixed = s * d.perp(column);
                out.add(i, first + j, mixed);
                out.add(first + j, i, mixed);
            }
        }
        if let Spin::Angle { .. } = self.spin {
            out.add(0, 0, -s * u.perp(&e));
        }
        for (theta, _, bend) in self.ends.bends(&at.q) {
            out.add(first + theta, first + theta, s * u.perp(&bend));
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let SlideVectors { u, e, u_dot, e_dot } = self.vectors(at);
        [u_dot.perp(&e) + u.perp(&e_dot), 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let SlideVectors { u, e, u_dot, e_dot } = self.vectors(at);
        let u_ddot = self.turned(self.spin.vector_acceleration(&at.q, &at.v, &at.a));
        let e_ddot = self.ends.acceleration(&at.q, &at.v, &at.a);
        let sum = u_ddot.perp(&e) + 2.0 * u_dot.perp(&e_dot) + u.perp(&e_ddot);
        [sum, 0.0]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        let (u, _) = self.at(at);
        -lambda[0] * quarter_turn(u)
    }
}
