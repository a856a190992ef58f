//! `type = "weld"`: two points coincide, and their bodies keep their relative angle.

use super::revolute::coincidence;
use super::{JointEnds, JointKind, JointModel};
use crate::constraint::{Align, ClampSlope};
use crate::document::Key;
use crate::marker::Spin;
use crate::math::plane::Rotation;
use crate::motion::Function;
use crate::terms::{ConstraintTerm, CoupleTerm, JointTerms, Owner, Terms};
use std::sync::Arc;

pub(super) static KIND: JointKind = JointKind {
    name: "weld",
    keys: &[
        Key::point("first", "the point of one body"),
        Key::point("second", "the point of the other"),
        Key::number(
            "angle",
            "rad",
            "the direction of the second body relative to the first",
        )
        .or("0"),
        Key::word(
            "slope",
            &["direction", "vector"],
            "what is held of the slope r' of a flexible end",
        )
        .or("`\"direction\"`"),
    ],
    read: |table, _| {
        Ok(Arc::new(Weld {
            angle: table.optional_number("angle")?.unwrap_or(0.0),
            slope: match table.optional_word("slope")? {
                Some(1) => SlopeClamp::Vector,
                _ => SlopeClamp::Direction,
            },
        }))
    },
};

/// A weld.
#[derive(Debug, Clone, Copy)]
pub struct Weld {
    /// Direction of the second body relative to the first \[rad\].
    pub angle: f64,
    /// What of the slope of a flexible end is held.
    pub slope: SlopeClamp,
}

/// What a weld holds of the slope r' of a flexible end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlopeClamp {
    /// Its direction: the stretch is free.
    Direction,
    /// Direction and stretch.
    Vector,
}

impl JointModel for Weld {
    fn coincides(&self) -> bool {
        true
    }

    fn angle(&self) -> Option<f64> {
        Some(self.angle)
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        let force = coincidence(ends, terms);
        // a slope is held relative to the other side, on either side of the joint
        let held = match (self.slope, ends.spins) {
            (SlopeClamp::Vector, [_, Spin::Slope { x }]) => Some((0, x, self.angle)),
            (SlopeClamp::Vector, [Spin::Slope { x }, _]) => Some((1, x, -self.angle)),
            _ => None,
        };
        let couple = match held {
            None => alignment(self.angle, ends, terms),
            Some((other, slope, angle)) => {
                let clamp = ClampSlope {
                    first: ends.spins[other],
                    slope,
                    turn: Rotation::new(angle),
                    scale: ends.inverse_sizes[other],
                    sign: if other == 0 { 1.0 } else { -1.0 },
                };
                let sides = [ends.owner.sides[other], ends.owner.sides[1 - other]];
                let owner = Owner {
                    sides,
                    ..ends.owner
                };
                let term = ConstraintTerm::Other(Box::new(clamp));
                terms.constrain(term, owner, &["slope x", "slope y"])
            }
        };
        JointTerms {
            couple: Some(CoupleTerm::Constraint(couple)),
            ..JointTerms::of(force)
        }
    }
}

/// The constraint that holds the relative angle of two bodies.
pub(super) fn alignment(angle: f64, ends: &JointEnds, terms: &mut Terms) -> usize {
    let align = Align {
        first: ends.spins[0],
        second: ends.spins[1],
        angle: Function::Constant(angle),
        scale: ends.inverse_sizes.iter().product(),
    };
    let term = ConstraintTerm::Other(Box::new(align));
    terms.constrain(term, ends.owner, &["angle"])
}
