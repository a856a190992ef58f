//! What every joint has: two points on different bodies, and a model of what it allows.

use super::Contact;
use crate::body::PointRef;
use crate::constraint::Slide;
use crate::document::{Fields, Kind, SceneError, Span};
use crate::marker::{Marker, Separation, Spin};
use crate::math::plane::Rotation;
use crate::system::InternalState;
use crate::terms::{JointTerms, Owner, Terms};
use indexmap::IndexMap;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// A kind of joint. The first two of its keys are the points of its two sides.
pub type JointKind =
    Kind<fn(&Fields, &IndexMap<String, Contact>) -> Result<Arc<dyn JointModel>, SceneError>>;

/// `[joints.NAME]`: a joint between two points.
#[derive(Debug, Clone)]
pub struct Joint {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// The point that carries the bearing (i of eq. 19), the guide, or the first side.
    pub bearing: PointRef,
    /// The point that carries the journal (j of eq. 19), the slider, or the second side.
    pub journal: PointRef,
    /// What it allows.
    pub model: Arc<dyn JointModel>,
}

impl Joint {
    /// Its two points.
    pub fn points(&self) -> [PointRef; 2] {
        [self.bearing, self.journal]
    }

    /// The point that it joins to this one, if this is one of its two.
    pub fn partner(&self, point: PointRef) -> Option<PointRef> {
        match point {
            _ if point == self.bearing => Some(self.journal),
            _ if point == self.journal => Some(self.bearing),
            _ => None,
        }
    }

    /// Geometry and laws of its contact, where it has clearance.
    pub fn contact(&self) -> Option<&Contact> {
        self.model.contact()
    }
}

/// The ends of a joint as functions of the coordinates.
#[derive(Debug)]
pub struct JointEnds<'a> {
    /// Its two points.
    pub markers: [Marker; 2],
    /// The directions of its bodies there.
    pub spins: [Spin; 2],
    /// 1/|d| of their undeformed directions.
    pub inverse_sizes: [f64; 2],
    /// Its name, bodies and place in the scene.
    pub owner: Owner<'a>,
    /// Indices of its internal states.
    pub states: &'a [usize],
    /// True where shared or known coordinates keep its points together, so that no constraint is needed for it.
    pub eliminated: bool,
}

impl JointEnds<'_> {
    /// The second point on a line through the first, whose direction is given in the frame of the first body \[rad\].
    pub fn slide(&self, direction: f64) -> Slide {
        let [from, to] = self.markers;
        Slide {
            ends: Separation { from, to },
            spin: self.spins[0],
            turn: Rotation::new(direction),
            scale: self.inverse_sizes[0],
        }
    }
}

/// The coordinate that a joint leaves a body relative to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Freedom {
    /// The angle about the point that both bodies share.
    Turn,
    /// The distance of the second point along a line of the first body, without a rotation.
    Slide {
        /// The direction of the line in the frame of the first body \[rad\].
        direction: f64,
        /// The angle of the second body relative to the first \[rad\].
        angle: f64,
    },
}

/// What a joint allows.
pub trait JointModel: Any + Debug + Send + Sync {
    /// True where its two points coincide, so that the nodes of two bodies can be one.
    fn coincides(&self) -> bool {
        false
    }
    /// True of a joint that only holds two points together: its bodies turn freely, and a drive can turn them.
    fn is_revolute(&self) -> bool {
        false
    }
    /// Angle of the second body relative to the first, if the joint holds it \[rad\].
    fn angle(&self) -> Option<f64> {
        None
    }
    /// Direction in the frame of the first body of a line on which the second point stays \[rad\].
    fn line(&self) -> Option<f64> {
        None
    }
    /// The one coordinate that it leaves a rigid body on a side of known motion, if it leaves one. Where it holds a body so,
    /// [`JointEnds::eliminated`] is true, and it adds no constraint.
    fn leaves(&self) -> Option<Freedom> {
        None
    }
    /// Which of its sides need a body with a direction.
    fn needs_direction(&self) -> [bool; 2] {
        [
            self.line().is_some() || self.angle().is_some(),
            self.angle().is_some(),
        ]
    }
    /// Geometry and laws of its contact, where it has clearance.
    fn contact(&self) -> Option<&Contact> {
        None
    }
    /// The same joint with another contact, or with none.
    fn with_contact(&self, _contact: Option<Contact>) -> Option<Arc<dyn JointModel>> {
        None
    }
    /// Its internal states: those of its contact.
    fn states(&self) -> Vec<InternalState> {
        self.contact().map_or_else(Vec::new, Contact::states)
    }
    /// Adds its terms.
    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms;
}

impl dyn JointModel {
    /// The model as one of this kind, if it is one.
    pub fn get<T: JointModel>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}
