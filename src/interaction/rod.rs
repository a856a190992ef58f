//! `type = "rod"`: a massless rigid rod holds two points at a distance.

use super::{JointEnds, JointKind, JointModel};
use crate::constraint::{Constraint, Curvature, Gradient, ROWS, WIDTH};
use crate::document::Key;
use crate::effect::Effect;
use crate::marker::Marker;
use crate::math::plane::{Vec2, dot, norm, scale, sub};
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
        let [first, second] = ends.markers;
        let length = self.length;
        let term = Distance {
            first,
            second,
            length,
        };
        let term = ConstraintTerm::Other(Box::new(term));
        JointTerms::of(ForceTerm::Constraint(terms.constrain(
            term,
            ends.owner,
            &["length"],
        )))
    }
}

/// Phi = (|r|^2 - l^2)/(2 l) with r from the first marker to the second: in metres, and the multiplier is the tension in
/// newtons.
#[derive(Debug, Clone, Copy)]
pub struct Distance {
    /// One end.
    pub first: Marker,
    /// The other.
    pub second: Marker,
    /// l \[m\].
    pub length: f64,
}

impl Distance {
    fn sides(&self) -> [(Marker, f64, usize); 2] {
        [
            (self.first, -1.0, 0),
            (self.second, 1.0, self.first.width()),
        ]
    }

    /// The difference of what a function gives for the two ends.
    fn difference(&self, of: impl Fn(&Marker) -> Vec2) -> Vec2 {
        sub(of(&self.second), of(&self.first))
    }

    fn r(&self, at: &State) -> Vec2 {
        self.difference(|m| m.position(&at.q, m.arm(&at.q)))
    }

    fn rate(&self, at: &State) -> Vec2 {
        self.difference(|m| m.velocity(&at.v, m.arm(&at.q)))
    }

    /// dr/dq in local columns, and their number.
    fn columns(&self, at: &State) -> ([Vec2; WIDTH], usize) {
        let mut columns = [[0.0; 2]; WIDTH];
        let mut count = 0;
        for (marker, sign, _) in self.sides() {
            for column in marker.columns(marker.arm(&at.q)).iter() {
                columns[count] = scale(sign, *column);
                count += 1;
            }
        }
        (columns, count)
    }
}

impl Constraint for Distance {
    fn effect(&self) -> Effect {
        "rod"
    }

    fn rows(&self) -> usize {
        1
    }

    fn coordinates(&self) -> Vec<usize> {
        [self.first.coordinates(), self.second.coordinates()].concat()
    }

    fn split(&self) -> usize {
        self.first.width()
    }

    fn value(&self, at: &State) -> [f64; ROWS] {
        // (|r| - l)(|r| + l): no digits are lost in a difference of squares
        let distance = norm(self.r(at));
        [
            (distance - self.length) * (distance + self.length) / (2.0 * self.length),
            0.0,
        ]
    }

    fn gradient(&self, at: &State) -> Gradient {
        let direction = scale(1.0 / self.length, self.r(at));
        let (columns, _) = self.columns(at);
        [columns.map(|column| dot(direction, column)), [0.0; WIDTH]]
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let s = lambda[0] / self.length;
        let (columns, count) = self.columns(at);
        for (i, row) in columns[..count].iter().enumerate() {
            for (j, column) in columns[..count].iter().enumerate() {
                out.add(i, j, s * dot(*row, *column));
            }
        }
        for (marker, sign, first) in self.sides() {
            if let Marker::OnBody { .. } = marker {
                let bend = -sign * dot(self.r(at), marker.arm(&at.q));
                out.add(first + 2, first + 2, s * bend);
            }
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        [dot(self.r(at), self.rate(at)) / self.length, 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let rate = self.rate(at);
        let second = self.difference(|m| m.acceleration(&at.v, &at.a, m.arm(&at.q)));
        [
            (dot(self.r(at), second) + dot(rate, rate)) / self.length,
            0.0,
        ]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        scale(-lambda[0] / self.length, self.r(at))
    }
}
