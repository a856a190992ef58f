//! A compiled mechanism: immutable lists of what the scene calls for, and nothing else.

mod assemble;
mod block;
mod measure;
mod reaction;

pub use block::{Block, Border};
pub use measure::{Energies, Pose};
pub(crate) use reaction::{DrivenForce, Source};
pub use reaction::{Reaction, Share};

use crate::constraint::{Coincide, Length};
use crate::force::{ClearanceJoint, FrictionalJoint};
use crate::kinematics::Kinematics;
use crate::link::AncfCable;
use crate::marker::Marker;
use crate::math::lu::Symbolic;
use crate::motion::Path;
use crate::system::{Shape, State};

/// A mechanism ready to be integrated.
#[derive(Debug)]
pub struct Model {
    pub(crate) shape: Shape,
    pub(crate) symbolic: Symbolic,
    /// Names of the unknowns, then of the multipliers.
    pub(crate) names: Vec<String>,
    pub(crate) mass: Mass,
    pub(crate) elements: Vec<Element>,
    pub(crate) lengths: Vec<Placed<Length>>,
    pub(crate) coincidences: Vec<Placed<Coincide>>,
    pub(crate) loose: Vec<Contacting<ClearanceJoint>>,
    pub(crate) frictional: Vec<Contacting<FrictionalJoint>>,
    /// Weight: (coordinate, force on the left side of the equations of motion) \[N\].
    pub(crate) weight: Vec<(usize, f64)>,
    /// Known coordinates that never change, with their values.
    pub(crate) fixed: Vec<(usize, f64)>,
    pub(crate) path: Option<PathRule>,
    pub(crate) kinematics: Option<Kinematics>,
    /// Forces on known coordinates that move.
    pub(crate) driven: Vec<DrivenForce>,
    /// Known nodes that ride on a known rigid body.
    pub(crate) riders: Vec<Rider>,
    /// Bodies of the scene, in its order.
    pub(crate) bodies: Vec<BodyPlace>,
    /// Joints of the scene, in its order.
    pub(crate) joints: Vec<JointPlace>,
}

/// Indices into [`crate::system::Work::tally`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Elastic force of an ANCF element.
    Elastic = 0,
    /// Length of a rigid link.
    Length = 1,
    /// Ideal joint as a constraint.
    Coincidence = 2,
    /// Normal contact law.
    Contact = 3,
    /// Friction law.
    Friction = 4,
    /// Weight.
    Gravity = 5,
    /// Inverse kinematics of the ideal rigid mechanism.
    InverseKinematics = 6,
}

impl Effect {
    /// All effects, with their names in reports.
    pub const ALL: [(Effect, &'static str); 7] = [
        (Effect::Elastic, "ancf_elastic_force"),
        (Effect::Length, "length_constraint"),
        (Effect::Coincidence, "ideal_joint_constraint"),
        (Effect::Contact, "contact_law"),
        (Effect::Friction, "friction_law"),
        (Effect::Gravity, "gravity"),
        (Effect::InverseKinematics, "inverse_kinematics"),
    ];
}

/// A path-driven rigid body whose coordinates start at `x`.
#[derive(Debug)]
pub(crate) struct PathRule {
    pub x: usize,
    pub path: Box<dyn Path>,
}

/// A known node at `x` that follows a marker on a known body.
#[derive(Debug)]
pub(crate) struct Rider {
    pub x: usize,
    pub marker: Marker,
}

/// A constraint with its place in the equations.
#[derive(Debug)]
pub(crate) struct Placed<T> {
    pub term: T,
    /// Index of its first multiplier among the multipliers.
    pub row: usize,
    pub block: Block,
    pub border: Vec<Border>,
}

/// A loose joint with its place in the equations.
#[derive(Debug)]
pub(crate) struct Contacting<T> {
    pub term: T,
    /// Index of its memory.
    pub contact: usize,
    pub block: Block,
}

/// An ANCF element with its place in the equations.
#[derive(Debug)]
pub(crate) struct Element {
    pub kernel: AncfCable,
    pub block: Block,
}

/// Masses: the parts as they belong to bodies, and their constant sum.
#[derive(Debug, Default)]
pub(crate) struct Mass {
    pub parts: Vec<Inertia>,
    /// Sum over the parts, row by row, over all coordinates.
    pub row_start: Vec<usize>,
    pub columns: Vec<usize>,
    pub values: Vec<f64>,
    /// The sum over unknowns in the layout of the tangent.
    pub tangent: Vec<f64>,
}

/// A mass matrix on some coordinates, row by row.
#[derive(Debug)]
pub(crate) struct Inertia {
    pub coordinates: Vec<usize>,
    pub values: Vec<f64>,
    /// Gravity field on these coordinates: g on positions, zero on slopes and angles \[m/s2\].
    pub field: Vec<f64>,
}

/// Where a body of the scene lives among the coordinates.
#[derive(Debug, Clone)]
pub struct BodyPlace {
    /// The name the user wrote.
    pub name: String,
    /// Its coordinates.
    pub coordinates: BodyCoordinates,
    /// Its coordinates in the ideal mechanism that the drive follows, for the driven body.
    pub prescribed: Option<usize>,
}

/// Coordinates of a body.
#[derive(Debug, Clone)]
pub enum BodyCoordinates {
    /// Points that do not move.
    Ground {
        /// First coordinate of each point.
        points: Vec<usize>,
    },
    /// x, y, theta from this index.
    Rigid {
        /// Index of x.
        x: usize,
    },
    /// Two ends.
    RigidLink {
        /// First coordinates of the ends.
        ends: [usize; 2],
    },
    /// Nodes with slopes.
    FlexibleLink {
        /// First coordinate of each node's position.
        nodes: Vec<usize>,
        /// First coordinate of each node's slope.
        slopes: Vec<usize>,
        /// Indices of its elements in the model.
        elements: std::ops::Range<usize>,
        /// Length of one element \[m\].
        element_length: f64,
    },
}

/// Where a joint of the scene lives.
#[derive(Debug)]
pub struct JointPlace {
    /// The name the user wrote.
    pub name: String,
    /// How its force is found.
    pub kind: JointKind,
    /// Present when a drive actuates it and it moves a body.
    pub actuator: Option<Actuator>,
}

/// How a joint appears in the equations.
#[derive(Debug)]
pub enum JointKind {
    /// Two constraint rows: index into the coincidences.
    Constraint(usize),
    /// Contact without friction: index into the loose joints.
    Loose(usize),
    /// Contact with friction: index into the frictional joints.
    Frictional(usize),
    /// Shared or known coordinates: the force is a sum over what hangs on one side.
    Eliminated(Reaction),
}

/// An actuated joint: its centre, and the known coordinates that turn with it.
#[derive(Debug, Clone)]
pub struct Actuator {
    /// Index of the bearing's and the journal's body; the angle is that of the journal relative to the bearing.
    pub bodies: [usize; 2],
    /// Centre of the joint.
    pub centre: Marker,
    /// Forces on the coordinates outboard: nodes and rigid bodies.
    pub(crate) outboard: Vec<DrivenForce>,
    /// -1 where the bearing is the side that the joint moves.
    pub sign: f64,
}

impl Model {
    /// Sizes.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Names of the effects present and their indices in the tally.
    pub fn effects(&self) -> Vec<(Effect, &'static str)> {
        let present = |effect: Effect| match effect {
            Effect::Elastic => !self.elements.is_empty(),
            Effect::Length => !self.lengths.is_empty(),
            Effect::Coincidence => !self.coincidences.is_empty(),
            Effect::Contact => self.shape.contacts > 0,
            Effect::Friction => !self.frictional.is_empty(),
            Effect::Gravity => !self.weight.is_empty(),
            Effect::InverseKinematics => self.kinematics.is_some(),
        };
        Effect::ALL
            .into_iter()
            .filter(|(effect, _)| present(*effect))
            .collect()
    }

    /// Names of the unknown coordinates, then of the multipliers.
    pub fn unknown_names(&self) -> &[String] {
        &self.names
    }

    /// Bodies in the order of the scene.
    pub fn bodies(&self) -> &[BodyPlace] {
        &self.bodies
    }

    /// Joints in the order of the scene.
    pub fn joints(&self) -> &[JointPlace] {
        &self.joints
    }
}

impl Model {
    /// A state with the fixed coordinates in place and everything else zero.
    pub(crate) fn blank_state(&self) -> State {
        let mut state = State::zeros(self.shape);
        for &(i, value) in &self.fixed {
            state.q[i] = value;
        }
        state
    }
}
