//! `type = "rod"`: a massless rigid rod holds two points at a distance.

use super::{JointEnds, JointKind, JointModel};
use crate::constraint::{Constraint, Curvature, Gradient, ROWS, WIDTH};
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

    fn value(&self, at: &State) -> [f64; ROWS] {
        // (|e| - l)(|e| + l): no digits are lost in a difference of squares
        let (distance, l) = (self.ends.vector(&at.q).norm(), self.length);
        [(distance - l) * (distance + l) / (2.0 * l), 0.0]
    }

    fn gradient(&self, at: &State) -> Gradient {
        let direction = 1.0 / self.length * self.ends.vector(&at.q);
        let mut gradient = [[0.0; WIDTH]; ROWS];
        for (g, column) in gradient[0].iter_mut().zip(self.ends.columns(&at.q).iter()) {
            *g = direction.dot(column);
        }
        gradient
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let (s, e) = (lambda[0] / self.length, self.ends.vector(&at.q));
        let columns = self.ends.columns(&at.q);
        for (i, row) in columns.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                out.add(i, j, s * row.dot(column));
            }
        }
        for (theta, _, bend) in self.ends.bends(&at.q) {
            out.add(theta, theta, s * e.dot(&bend));
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let (e, rate) = (self.ends.vector(&at.q), self.ends.rate(&at.q, &at.v));
        [e.dot(&rate) / self.length, 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let (e, rate) = (self.ends.vector(&at.q), self.ends.rate(&at.q, &at.v));
        let second = self.ends.acceleration(&at.q, &at.v, &at.a);
        [(e.dot(&second) + rate.dot(&rate)) / self.length, 0.0]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        -lambda[0] / self.length * self.ends.vector(&at.q)
    }
}
