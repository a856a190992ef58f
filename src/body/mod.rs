//! Bodies, one kind a file: coordinates, masses, elastic elements, points and directions as functions of the coordinates.

mod centred_link;
mod disc;
mod flexible_link;
mod ground;
mod held_body;
mod link;
mod materials;
mod moving;
mod point_mass;
mod points;
mod rigid_body;
mod rigid_link;
mod strain;

pub use centred_link::CentredLink;
pub use flexible_link::{Damping, FlexibleLink};
pub use ground::Ground;
pub use held_body::{HeldBody, Hold, HoldingLine, Ties};
pub use link::{Link, RAYLEIGH};
pub use materials::{MATERIAL, Material, Materials, SECTION, Section};
pub use moving::Moving;
pub use point_mass::PointMass;
pub use points::{POLAR, Point};
pub use rigid_body::{PLATES, RigidBody};
pub use rigid_link::{LinkCoordinates, RigidLink};
pub use strain::Strain;

use crate::document::{Fields, Kind, SceneError};
use crate::marker::{Marker, Spin};
use crate::math::plane::{pair, quarter_turn, unit};
use crate::motion::Path;
pub use crate::motion::Pose;
use crate::terms::{Owner, Terms};
use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

/// The kinds that a scene can name.
pub static KINDS: [&BodyKind; 6] = [
    &ground::KIND,
    &link::KIND,
    &rigid_body::KIND,
    &disc::KIND,
    &point_mass::KIND,
    &moving::KIND,
];

/// A kind of body.
pub type BodyKind = Kind<fn(&Fields, &Materials) -> Result<Arc<dyn Body>, SceneError>>;

/// A point of a body: indices into the bodies of a scene and into the points of that body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PointRef {
    /// Index of the body.
    pub body: usize,
    /// Index of the point.
    pub point: usize,
}

/// What the motion of a body is known to be.
#[derive(Debug, Clone, Copy)]
pub enum Known<'a> {
    /// It does not move.
    Fixed,
    /// It follows a path.
    Path(&'a Arc<dyn Path>),
}

/// A group of coordinates of a body.
#[derive(Debug, Clone)]
pub struct Slot {
    /// What follows the name of the body in the names of the coordinates, such as `.end`; empty for the pose.
    pub label: String,
    /// What it is.
    pub content: Content,
    /// The point whose position it is, if joints can share it.
    pub point: Option<usize>,
    /// What is known of it in a body that moves freely.
    pub held: Option<HeldSlot>,
}

/// A slot of a free body that is known, because a joint holds the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeldSlot {
    /// A coordinate that never changes.
    At(f64),
    /// The position of the point on the other side of the joint.
    Partner,
}

/// What a slot holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// x, y of a point.
    Position,
    /// x, y of a slope.
    Slope,
    /// x, y, theta.
    Pose,
    /// x of a point alone.
    X,
    /// y of a point alone.
    Y,
    /// theta alone.
    Angle,
}

impl Content {
    /// Names of the coordinates.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Content::Position | Content::Slope => &["x", "y"],
            Content::Pose => &["x", "y", "theta"],
            Content::X => &["x"],
            Content::Y => &["y"],
            Content::Angle => &["theta"],
        }
    }

    /// Which of the coordinates is the angle of a rigid body, if one is.
    pub fn angle(self) -> Option<usize> {
        match self {
            Content::Pose => Some(2),
            Content::Angle => Some(0),
            Content::Position | Content::Slope | Content::X | Content::Y => None,
        }
    }
}

impl Slot {
    /// The position of a point, which joints can share.
    pub fn node(name: &str, point: usize) -> Slot {
        Slot {
            label: format!(".{name}"),
            content: Content::Position,
            point: Some(point),
            held: None,
        }
    }

    /// Coordinates of the body alone.
    pub fn own(label: String, content: Content) -> Slot {
        Slot {
            label,
            content,
            point: None,
            held: None,
        }
    }
}

/// Positions, velocities and accelerations of all coordinates.
pub type Levels<'a> = [&'a [f64]; 3];

/// Position and velocity of the frame in which the points of a body are given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// x, y \[m\], theta \[rad\].
    pub position: [f64; 3],
    /// vx, vy \[m/s\], omega \[rad/s\].
    pub velocity: [f64; 3],
}

/// How a body is deformed at the start.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deformation {
    /// Axial strain (r'.r' - 1)/2.
    pub strain: f64,
    /// Rate of r'' normal to the link, uniform along it \[1/(m s)\].
    pub bending_rate: f64,
}

impl Deformation {
    /// |r'|: length over undeformed length.
    pub fn stretch(&self) -> f64 {
        (1.0 + 2.0 * self.strain).sqrt()
    }

    /// Velocity normal to a link of this length, and its derivative along the link, at a distance xi from its middle, due to
    /// bending: kappa_dot (xi^2/2 - l^2/24), which has neither momentum nor moment of momentum.
    pub fn bending(&self, length: f64, xi: f64) -> [f64; 2] {
        let shape = 0.5 * xi * xi - length * length / 24.0;
        [self.bending_rate * shape, self.bending_rate * xi]
    }
}

impl Pose {
    /// The pose with x, y and theta at these indices.
    pub fn of(pose: [usize; 3], levels: Levels) -> Pose {
        let [position, velocity, acceleration] = levels.map(|l| pose.map(|i| l[i]));
        Pose {
            position,
            velocity,
            acceleration,
        }
    }
}

/// A body. Its coordinates come in slots; `x` is the index of the first coordinate of each. Without methods of its own it has the
/// coordinates x, y, theta of a frame that carries its points.
pub trait Body: Any + Debug + Send + Sync {
    /// Its points, in its frame.
    fn points(&self) -> &[Point];
    /// Its coordinates.
    fn slots(&self) -> Vec<Slot> {
        vec![Slot::own(String::new(), Content::Pose)]
    }
    /// What its motion is known to be.
    fn known(&self) -> Option<Known<'_>> {
        None
    }
    /// Its mass \[kg\], if it has one.
    fn mass(&self) -> Option<f64> {
        None
    }
    /// Dimensions of a slender body between two ends, which are its points 0 and 1.
    fn link(&self) -> Option<&Link> {
        None
    }
    /// True of a body that does not deform.
    fn is_rigid(&self) -> bool {
        true
    }
    /// False of a point, which has no direction.
    fn turns(&self) -> bool {
        true
    }
    /// The largest dimension that its mass gives it \[m\].
    fn size(&self) -> f64 {
        0.0
    }
    /// Its radius, if it is round about the origin of its frame \[m\].
    fn radius(&self) -> Option<f64> {
        None
    }
    /// A point as a function of the coordinates.
    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        let s = self.points()[point].at;
        Marker::OnBody { pose: pose(x), s }
    }
    /// The direction of the material at a point.
    fn spin(&self, _point: usize, x: &[usize]) -> Spin {
        Spin::Angle { theta: x[0] + 2 }
    }
    /// Magnitude of its undeformed direction.
    fn direction_size(&self) -> f64 {
        1.0
    }
    /// The point that takes the forces at a point: itself, where joints can share its node, or one that stands for the whole rigid
    /// body.
    fn carrier(&self, _point: usize) -> usize {
        0
    }
    /// Distance by which a unit change of the last coordinate of a slot, an angle or slope, moves a point of the body at most \[m\].
    fn lever(&self, _slot: usize) -> f64 {
        1.0
    }
    /// Adds its masses, elements, constraints and damping.
    fn terms(&self, x: &[usize], owner: Owner, terms: &mut Terms);
    /// Pose of its centre of mass; angles of links in (-pi, pi].
    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        Pose::of(pose(x), levels)
    }
    /// The frame of its points, undeformed, where its centre of mass has this position and velocity.
    fn frame(&self, position: [f64; 3], velocity: [f64; 3]) -> Frame {
        Frame { position, velocity }
    }
    /// The frame of its points in a state of the rigid mechanism.
    fn frame_at(&self, x: &[usize], q: &[f64], v: &[f64]) -> Option<Frame> {
        let Pose {
            position, velocity, ..
        } = self.pose(x, [q, v, v]);
        Some(self.frame(position, velocity))
    }
    /// The values of all slots of the undeformed body in a frame, and their rates.
    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        vec![[frame.position, frame.velocity]]
    }
    /// The same of a body that is deformed; a rigid one is not.
    fn place_deformed(&self, frame: &Frame, _: &Deformation) -> Vec<[[f64; 3]; 2]> {
        self.place(frame)
    }
    /// A velocity of the body (0, 1: of its centre of mass, 2: angular) as a sum of velocities of coordinates times factors.
    fn velocity(&self, component: usize, x: &[usize], _q: &[f64]) -> Option<Vec<(usize, f64)>> {
        Some(vec![(x[0] + component, 1.0)])
    }
    /// The body in the ideal mechanism, where it does not deform; none for a body that is the same there.
    fn rigid(&self) -> Option<Arc<dyn Body>> {
        None
    }
    /// The body in the mechanism of the scene, where it has other coordinates than in the ideal one. None for a body that is the same
    /// in both.
    fn real(&self, _ties: &Ties) -> Option<Arc<dyn Body>> {
        None
    }
    /// How a joint holds it, of a body that has the coordinate which this joint leaves.
    fn hold(&self) -> Option<Hold> {
        None
    }
    /// The largest strains of a body that deforms, sampled at eleven points of every element.
    fn strain(&self, _x: &[usize], _q: &[f64]) -> Option<Strain> {
        None
    }
    /// The slot of the slope at a point, of a body that has slopes.
    fn slope_slot(&self, _point: usize) -> Option<usize> {
        None
    }
}

impl dyn Body {
    /// The body as one of this kind, if it is one.
    pub fn get<T: Body>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }

    /// Length \[m\] of a body between two ends.
    pub fn length(&self) -> Option<f64> {
        self.link().map(|link| link.length)
    }
}

/// The coordinates of a body whose first slot holds x, y, theta.
fn pose(x: &[usize]) -> [usize; 3] {
    [x[0], x[0] + 1, x[0] + 2]
}

/// Position and velocity of the point at this distance along the x axis of a frame.
fn carried(frame: &Frame, along: f64) -> [[f64; 3]; 2] {
    let ([.., theta], [.., omega]) = (frame.position, frame.velocity);
    let direction = unit(theta);
    let turning = omega * quarter_turn(direction);
    let position = pair(&frame.position, 0) + along * direction;
    let velocity = pair(&frame.velocity, 0) + along * turning;
    [position, velocity].map(|x| x.push(0.0).into())
}
