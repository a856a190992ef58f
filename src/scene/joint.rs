//! Joints of a scene, and their contacts.

use super::body::PointRef;
use super::error::Span;
use crate::contact::Slip;
use crate::contact::normal::{NormalLaw, NormalLawKind, NormalParameters};

/// `[joints.NAME]`: a joint between two points.
#[derive(Debug, Clone)]
pub struct Joint {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// The point that carries the bearing (i of eq. 19), the guide, or the first side of a weld.
    pub bearing: PointRef,
    /// The point that carries the journal (j of eq. 19), the slider, or the second side of a weld.
    pub journal: PointRef,
    /// What it allows.
    pub model: JointModel,
}

impl Joint {
    /// Geometry and laws of its contact, where it has clearance.
    pub fn contact(&self) -> Option<&Contact> {
        match &self.model {
            JointModel::Clearance(contact) => Some(contact),
            _ => None,
        }
    }
}

/// The smallest clearance of some joints \[m\]; none where no joint has clearance.
pub(crate) fn smallest_clearance<'a>(joints: impl Iterator<Item = &'a Joint>) -> Option<f64> {
    let contacts = joints.filter_map(Joint::contact);
    contacts.map(|contact| contact.clearance).reduce(f64::min)
}

/// How a joint connects its two points.
#[derive(Debug, Clone)]
pub enum JointModel {
    /// The points coincide.
    Ideal,
    /// The journal moves inside the bearing and touches it.
    Clearance(Contact),
    /// The points coincide and the bodies keep their relative angle.
    Weld {
        /// Direction of the second body relative to the first \[rad\].
        angle: f64,
        /// What of the slope of a flexible end is held.
        slope: SlopeClamp,
    },
    /// The second point stays on a line of the first body.
    Prismatic {
        /// Direction of the line in the frame of the first body \[rad\].
        direction: f64,
        /// Angle of the second body relative to the first \[rad\]; absent for a pin in a slot.
        locked: Option<f64>,
    },
}

/// What a weld holds of the slope r' of a flexible end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SlopeClamp {
    /// Its direction: the stretch is free.
    Direction,
    /// Direction and stretch.
    Vector,
}

/// Geometry and laws of a loose joint.
#[derive(Debug, Clone)]
pub struct Contact {
    /// Bearing radius R_i \[m\].
    pub bearing_radius: f64,
    /// Radial clearance c = R_i - R_j \[m\].
    pub clearance: f64,
    /// Normal law.
    pub law: &'static NormalLawKind,
    /// Contact stiffness K \[N/m^exponent\], typed or from eq. 25.
    pub stiffness: f64,
    /// Exponent n.
    pub exponent: f64,
    /// Restitution coefficient c_e as typed; 1 for Hertz.
    pub restitution: f64,
    /// Smallest impact velocity that the damping term divides by \[m/s\].
    pub impact_velocity_floor: f64,
    /// Friction, absent when the scene names none.
    pub friction: Option<Friction>,
}

impl Contact {
    /// The normal law with its parameters.
    pub fn normal_law(&self) -> Box<dyn NormalLaw> {
        (self.law.build)(&NormalParameters {
            stiffness: self.stiffness,
            exponent: self.exponent,
            restitution: self.restitution,
            impact_velocity_floor: self.impact_velocity_floor,
        })
    }
}

/// Friction of eq. 26.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient c_f.
    pub coefficient: f64,
    /// Slip below which there is no friction \[m/s\].
    pub v0: f64,
    /// Slip above which friction is full \[m/s\].
    pub v1: f64,
    /// Which slip velocity enters.
    pub slip: Slip,
}
