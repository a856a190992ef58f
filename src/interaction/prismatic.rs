//! `type = "prismatic"`: a point of one body stays on a line of another.

use super::weld::alignment;
use super::{Freedom, JointEnds, JointKind, JointModel};
use crate::document::{Fields, Key, SceneError};
use crate::terms::{ConstraintTerm, CoupleTerm, ForceTerm, JointTerms, Terms};
use std::sync::Arc;

pub(super) static KIND: JointKind = JointKind {
    name: "prismatic",
    keys: &[
        Key::point(
            "guide",
            "the point on the line, of the body that carries it",
        ),
        Key::point("slider", "the point that slides"),
        DIRECTION,
        Key::word(
            "rotation",
            &["free", "locked"],
            "whether the sliding body turns freely, as a pin in a slot, or keeps its angle relative to the other",
        ),
        Key::number(
            "angle",
            "rad",
            "of a locked rotation: the angle of the sliding body relative to the other",
        )
        .or("0"),
    ],
    read: |table, _| {
        let direction = direction(table)?;
        let locked = table.word("rotation")? == 1;
        if let Some(angle) = table.optional("angle").filter(|_| !locked) {
            let message = format!(
                "`{}` is the angle of a locked rotation, but this rotation is free",
                angle.path
            );
            return Err(angle.key_fault(message, "remove this, or lock the rotation"));
        }
        let angle = table.optional_number("angle")?.unwrap_or(0.0);
        let locked = locked.then_some(angle);
        Ok(Arc::new(Prismatic { direction, locked }))
    },
};

/// The direction of a line.
pub(super) const DIRECTION: Key = Key::vector(
    "direction",
    "",
    "[dx, dy]",
    "the direction of the line in the frame of that body, of any length but 0",
);

/// The angle of `direction` \[rad\].
pub(super) fn direction(table: &Fields) -> Result<f64, SceneError> {
    let field = table.field("direction")?;
    let [dx, dy] = field.numbers("[dx, dy]")?;
    match dx == 0.0 && dy == 0.0 {
        true => Err(field.must("not be zero")),
        false => Ok(dy.atan2(dx)),
    }
}

/// A prismatic joint.
#[derive(Debug, Clone, Copy)]
pub struct Prismatic {
    /// Direction of the line in the frame of the first body \[rad\].
    pub direction: f64,
    /// Angle of the second body relative to the first \[rad\]; absent for a pin in a slot.
    pub locked: Option<f64>,
}

impl JointModel for Prismatic {
    fn angle(&self) -> Option<f64> {
        self.locked
    }

    fn line(&self) -> Option<f64> {
        Some(self.direction)
    }

    fn leaves(&self) -> Option<Freedom> {
        let direction = self.direction;
        self.locked.map(|angle| Freedom::Slide { direction, angle })
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        let slide = ends.slide(self.direction);
        if ends.eliminated {
            return JointTerms {
                couple: self.locked.map(|_| CoupleTerm::Eliminated),
                slide: Some(slide),
                ..JointTerms::of(ForceTerm::Eliminated)
            };
        }
        let term = ConstraintTerm::Other(Box::new(slide));
        let row = terms.constrain(term, ends.owner, &["line"]);
        JointTerms {
            couple: self
                .locked
                .map(|angle| CoupleTerm::Constraint(alignment(angle, ends, terms))),
            slide: Some(slide),
            ..JointTerms::of(ForceTerm::Constraint(row))
        }
    }
}
