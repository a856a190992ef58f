//! A prescribed coordinate of a point.

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::marker::Marker;
use crate::math::plane::Vec2;
use crate::motion::{Function, Knot};
use crate::system::State;

/// Phi = n . r - f(t), one row: the coordinate of a point along the constant unit vector n follows a function of time. The
/// multiplier is the force that the point exerts along n \[N\].
#[derive(Debug)]
pub struct Place {
    /// The point.
    pub marker: Marker,
    /// n.
    pub direction: Vec2,
    /// f(t) \[m\].
    pub value: Function,
}

impl Constraint for Place {
    fn effect(&self) -> Effect {
        "prescribed_coordinate"
    }

    fn rows(&self) -> usize {
        1
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [vec![], self.marker.coordinates()]
    }

    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let arm = self.marker.arm(&at.q);
        for (g, column) in gradient[0].iter_mut().zip(self.marker.columns(arm).iter()) {
            *g = self.direction.dot(column);
        }
        let along = self.direction.dot(&self.marker.position(&at.q, arm));
        [along - self.value.at(at.t)[0], 0.0]
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        if let Marker::OnBody { .. } = self.marker {
            let bend = -self.direction.dot(&self.marker.arm(&at.q));
            out.add(2, 2, lambda[0] * bend);
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let velocity = self.marker.velocity(&at.v, self.marker.arm(&at.q));
        [self.direction.dot(&velocity) - self.value.at(at.t)[1], 0.0]
    }

    fn drift(&self, at: &State) -> f64 {
        -self.value.at(at.t)[1]
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.value.knots(until)
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let arm = self.marker.arm(&at.q);
        let acceleration = self.marker.acceleration(&at.v, &at.a, arm);
        [
            self.direction.dot(&acceleration) - self.value.at(at.t)[2],
            0.0,
        ]
    }

    fn force(&self, _: &State, lambda: [f64; ROWS]) -> Vec2 {
        -lambda[0] * self.direction
    }
}
