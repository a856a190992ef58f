//! What acts between bodies, one kind a file: joints, springs and dampers, applied forces and torques.

pub mod contact;
mod joint;
pub mod loose_guide;
mod maxwell;
mod names;
pub mod point_force;
pub mod point_law;
pub mod prismatic;
pub mod revolute;
pub mod rod;
pub mod spring_damper;
pub mod torque;
pub mod torsion_spring;
pub mod weld;

pub use contact::{Contact, Friction};
pub use joint::{Freedom, Joint, JointEnds, JointKind, JointModel};
pub use maxwell::{Maxwell, MaxwellModel};
pub(crate) use names::NO_DIRECTION;
pub use names::Names;
pub use point_force::{PointForce, PointForceModel};
pub use point_law::{ForceByLaw, PointLaw, PointLoad};
pub use prismatic::Prismatic;
pub use revolute::Revolute;
pub use spring_damper::{SpringDamper, SpringDamperModel};
pub use torque::{Torque, TorqueModel};
pub use torsion_spring::{TorsionSpring, TorsionSpringModel};
pub use weld::{SlopeClamp, Weld};

use crate::body::{Body, Content, PointRef};
use crate::document::{Fields, Kind, SceneError, Span};
use crate::force::Force;
use crate::marker::{Marker, Spin};
use crate::motion::Function;
use crate::system::InternalState;
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// The kinds of joint that a scene can name.
pub static JOINTS: [&JointKind; 5] = [
    &revolute::KIND,
    &prismatic::KIND,
    &loose_guide::KIND,
    &weld::KIND,
    &rod::KIND,
];

/// The kinds of force that a scene can name.
pub static FORCES: [&ForceKind; 5] = [
    &spring_damper::KIND,
    &maxwell::KIND,
    &torsion_spring::KIND,
    &point_force::KIND,
    &torque::KIND,
];

/// A kind of force.
pub type ForceKind = Kind<fn(&Fields, &Names) -> Result<Arc<dyn ForceModel>, SceneError>>;

/// `[forces.NAME]`: a spring or a load of a scene.
#[derive(Debug, Clone)]
pub struct NamedForce {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// What acts.
    pub kind: Arc<dyn ForceModel>,
}

/// A force as a scene describes it.
pub trait ForceModel: Any + Debug + Send + Sync {
    /// The points that it names.
    fn points(&self) -> Vec<PointRef>;
    /// The joint whose angle it takes with its full turns, of a force that counts them.
    fn turning_joint(&self) -> Option<usize> {
        None
    }
    /// Its internal states.
    fn states(&self) -> Vec<InternalState> {
        Vec::new()
    }
    /// Numbers of memory that it needs.
    fn slots(&self) -> usize {
        0
    }
    /// The term of the equations, and the bodies of its two sides.
    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]);
}

impl dyn ForceModel {
    /// The force as one of this kind, if it is one.
    pub fn get<T: ForceModel>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }
}

/// A body and the index of the first coordinate of each of its slots.
#[derive(Debug, Clone)]
pub struct Placed {
    /// The body.
    pub kind: Arc<dyn Body>,
    /// Indices of the coordinates.
    pub x: Vec<usize>,
}

impl Placed {
    /// A point of the body.
    pub fn marker(&self, point: usize) -> Marker {
        self.kind.marker(point, &self.x)
    }

    /// The direction of the body at a point.
    pub fn spin(&self, point: usize) -> Spin {
        self.kind.spin(point, &self.x)
    }

    /// Its coordinates that are angles and slopes, each with the largest distance by which a unit of it moves a point \[m\]; the
    /// contents are those of its slots.
    pub fn levers(
        &self,
        contents: impl Iterator<Item = Content>,
    ) -> impl Iterator<Item = (usize, f64)> {
        let slots = self.x.iter().enumerate().zip(contents);
        slots.flat_map(|((slot, x), content)| {
            let lever = self.kind.lever(slot);
            let own = match content {
                Content::Slope => *x..x + 2,
                content => content
                    .angle()
                    .map_or(0..0, |angle| x + angle..x + angle + 1),
            };
            own.map(move |x| (x, lever))
        })
    }
}

/// Where a force finds what it acts on.
#[derive(Debug)]
pub struct Ends<'a> {
    /// All bodies.
    pub bodies: &'a [Placed],
    /// All joints.
    pub joints: &'a [Joint],
    /// In a static analysis the t of the full load \[s\].
    pub full_load: Option<f64>,
    /// Index of the first number of its memory.
    pub memory: usize,
    /// Indices of its internal states.
    pub states: &'a [usize],
}

impl Ends<'_> {
    /// A point as a function of the coordinates.
    pub fn marker(&self, p: PointRef) -> Marker {
        self.bodies[p.body].marker(p.point)
    }

    /// The direction of a body at a point.
    pub fn spin(&self, p: PointRef) -> Spin {
        self.bodies[p.body].spin(p.point)
    }

    /// The load as it acts: in a static analysis a constant grows in proportion to t.
    pub fn load(&self, f: &Function) -> Function {
        match (self.full_load, f) {
            (Some(duration), Function::Constant(value)) => {
                Function::Polynomial(vec![0.0, value / duration])
            }
            _ => f.clone(),
        }
    }
}
