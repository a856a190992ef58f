//! `type = "rod"`: a massless rigid rod holds two points at a distance.

use super::{JointEnds, JointKind, JointModel};
use crate::constraint::{Constraint, Curvature, Gradient, ROWS};
use crate::document::Key;
use crate::effect::Effect;
use crate::marker::Separation;
use crate::math::plane::Vec2;
use crate::system::State;
use crate::terms::{ConstraintTerm, ForceTerm, JointTerms, Terms};
use std::sync::Arc;

pub(super) static KIND: JointKind = JointKind {
    name: "rod",
    keys: &[
        Key::point("first", "one end"),
        Key::point("second", "the other end"),
        Key::positive("length", "m", "the distance of the two ends"),
    ],
    read: |table, _| {
        let length = table.number("length")?;
        Ok(Arc::new(Rod { length }))
    },
};

/// A massless rod between two points.
#[derive(Debug, Clone, Copy)]
pub struct Rod {
    /// Its length \[m\].
    pub length: f64,
}

impl JointModel for Rod {
    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        let [from, to] = ends.markers;
        let distance = Distance {
            ends: Separation { from, to },
            length: self.length,
        };
        let term = ConstraintTerm::Other(Box::new(distance));
        let row = terms.constrain(term, ends.owner, &["length"]);
        JointTerms::of(ForceTerm::Constraint(row))
    }
}

/// Phi = (|e|^2 - l^2)/(2 l) with e from one end to the other: in metres, and the multiplier is the tension in newtons.
#[derive(Debug, Clone, Copy)]
pub struct Distance {
    /// Its ends.
    pub ends: Separation,
    /// l \[m\].
    pub length: f64,
}

impl Distance {
    /// e, and the arms of both ends.
    fn vector(&self, at: &State) -> (Vec2, [Vec2; 2]) {
        let arms = self.ends.arms(&at.q);
        (self.ends.vector(&at.q, arms), arms)
    }
}

impl Constraint for Distance {
    fn effect(&self) -> Effect {
        "rod"
    }

    fn rows(&self) -> usize {
        1
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        self.ends.sides()
    }

    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let (e, arms) = self.vector(at);
        let direction = 1.0 / self.length * e;
        for (g, column) in gradient[0].iter_mut().zip(self.ends.columns(arms).iter()) {
            *g = direction.dot(column);
        }
        // (|e| - l)(|e| + l): no digits are lost in a difference of squares
        let (distance, l) = (e.norm(), self.length);
        [(distance - l) * (distance + l) / (2.0 * l), 0.0]
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let (e, arms) = self.vector(at);
        let (s, columns) = (lambda[0] / self.length, self.ends.columns(arms));
        for (i, row) in columns.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                out.add(i, j, s * row.dot(column));
            }
        }
        for (theta, _, bend) in self.ends.bends(arms) {
            out.add(theta, theta, s * e.dot(&bend));
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let (e, arms) = self.vector(at);
        [e.dot(&self.ends.rate(&at.v, arms)) / self.length, 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let (e, arms) = self.vector(at);
        let rate = self.ends.rate(&at.v, arms);
        let second = self.ends.acceleration(&at.v, &at.a, arms);
        [(e.dot(&second) + rate.dot(&rate)) / self.length, 0.0]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        -lambda[0] / self.length * self.vector(at).0
    }
}
