//! `type = "revolute"`: two points coincide, or a journal moves inside a bearing and touches it.

use super::{Contact, Freedom, JointEnds, JointKind, JointModel};
use crate::constraint::Coincide;
use crate::contact::geometry::CircleInCircle;
use crate::document::Key;
use crate::terms::{ConstraintTerm, ForceTerm, JointTerms, Terms};
use std::sync::Arc;

pub(super) static KIND: JointKind = JointKind {
    name: "revolute",
    keys: &[
        Key::point("bearing", "the point that carries the bearing"),
        Key::point("journal", "the point that carries the journal"),
        Key::word(
            "model",
            &["ideal", "clearance"],
            "how the joint connects: its points coincide, or the journal moves inside the bearing",
        ),
        Key::name_in(
            "contact",
            "contacts",
            "the name of a contact; an ideal joint does not use it",
        )
        .or("required with clearance"),
    ],
    read: |table, contacts| {
        let loose = table.word("model")? == 1;
        let name = match loose {
            true => Some(table.field("contact")?),
            false => table.optional("contact"),
        };
        let contact = name
            .map(|name| name.lookup("contact", contacts))
            .transpose()?;
        let Some((_, contact)) = contact.filter(|_| loose) else {
            return Ok(Arc::new(Revolute { contact: None }));
        };
        if contact.bearing_radius.is_none() {
            let name = table.field("contact")?;
            let message = format!("the contact {} has no `bearing_radius`", name.written());
            return Err(name.fault(message, "not the contact of a bearing"));
        }
        let contact = Some(contact.clone());
        Ok(Arc::new(Revolute { contact }))
    },
};

/// A revolute joint.
#[derive(Debug, Clone)]
pub struct Revolute {
    /// Present where it has clearance.
    pub contact: Option<Contact>,
}

impl JointModel for Revolute {
    fn coincides(&self) -> bool {
        self.contact.is_none()
    }

    fn is_revolute(&self) -> bool {
        true
    }

    fn leaves(&self) -> Option<Freedom> {
        self.contact.is_none().then_some(Freedom::Turn)
    }

    fn contact(&self) -> Option<&Contact> {
        self.contact.as_ref()
    }

    fn with_contact(&self, contact: Option<Contact>) -> Option<Arc<dyn JointModel>> {
        Some(Arc::new(Revolute { contact }))
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        JointTerms::of(match &self.contact {
            None => coincidence(ends, terms),
            Some(contact) => {
                let [bearing, journal] = ends.markers;
                let geometry = CircleInCircle {
                    bearing,
                    journal,
                    bearing_radius: contact.bearing_radius.unwrap_or(f64::NAN),
                    clearance: contact.clearance,
                };
                let pair = contact.pair(geometry, ends.spins, ends.states);
                terms.contacts.push(pair);
                ForceTerm::Contact(terms.contacts.len() - 1)
            }
        })
    }
}

/// Two points that coincide, by a constraint where no coordinate is shared.
pub(super) fn coincidence(ends: &JointEnds, terms: &mut Terms) -> ForceTerm {
    if ends.eliminated {
        return ForceTerm::Eliminated;
    }
    let [bearing, journal] = ends.markers;
    let term = ConstraintTerm::Coincide(Coincide { bearing, journal });
    ForceTerm::Constraint(terms.constrain(term, ends.owner, &["x", "y"]))
}
