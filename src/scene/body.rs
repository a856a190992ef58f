//! Bodies of a scene.

use super::BodyState;
use super::error::Span;
use crate::math::plane::{Vec2, perp, scale, sub};
use crate::motion::Path;
use std::sync::Arc;

/// `[bodies.NAME]`
#[derive(Debug, Clone)]
pub struct Body {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// What the body is.
    pub kind: BodyKind,
}

/// The kinds of body.
#[derive(Debug, Clone)]
pub enum BodyKind {
    /// Points that do not move.
    Ground {
        /// Named points \[m\].
        points: Vec<Point>,
    },
    /// A slender uniform link with the points `start` (index 0), `end` (index 1) and, if flexible, points at its nodes.
    Link(Link),
    /// A rigid body with the reference point in its centre of mass.
    Rigid(RigidBody),
    /// A point with mass; its only point is `center`.
    PointMass {
        /// Mass \[kg\].
        mass: f64,
    },
    /// A body without mass of its own that follows a path.
    Moving {
        /// Path of its reference point and its angle.
        path: Arc<dyn Path>,
        /// Named points relative to the reference point at theta = 0 \[m\].
        points: Vec<Point>,
    },
}

impl BodyKind {
    /// Its mass \[kg\]; of the ground and of a moving body none.
    pub fn mass(&self) -> Option<f64> {
        match self {
            BodyKind::Link(link) => Some(link.density * link.area * link.length),
            BodyKind::Rigid(rigid) => Some(rigid.mass),
            BodyKind::PointMass { mass } => Some(*mass),
            BodyKind::Ground { .. } | BodyKind::Moving { .. } => None,
        }
    }
}

/// A named point.
#[derive(Debug, Clone)]
pub struct Point {
    /// The name the user wrote.
    pub name: String,
    /// Coordinates in the frame of the body \[m\].
    pub at: [f64; 2],
}

/// A slender uniform link.
#[derive(Debug, Clone)]
pub struct Link {
    /// Length l \[m\].
    pub length: f64,
    /// Cross-section A \[m2\].
    pub area: f64,
    /// Second moment of area I about the axis normal to the plane \[m4\].
    pub second_moment: f64,
    /// Density \[kg/m3\].
    pub density: f64,
    /// Rigid or flexible.
    pub model: LinkModel,
    /// Named points of a flexible link between its ends, each at a node.
    pub points: Vec<LinkPoint>,
    /// Structural damping, absent when the scene names none.
    pub damping: Option<Damping>,
}

impl Link {
    /// Where point `index` of the link is, as a share of its length.
    pub fn share(&self, index: usize) -> f64 {
        match (index, self.model) {
            (0, _) => 0.0,
            (1, _) | (_, LinkModel::Rigid) => 1.0,
            (inner, LinkModel::Flexible { elements, .. }) => {
                self.points[inner - 2].node as f64 / elements as f64
            }
        }
    }

    /// Position \[m\] and velocity \[m/s\] of its `start` in a state: half the length behind the centre of mass, the link
    /// being straight.
    pub(crate) fn start(&self, state: &BodyState) -> [Vec2; 2] {
        let ([x, y, theta], [vx, vy, omega]) = (state.position, state.velocity);
        let half = scale(0.5 * self.length, [theta.cos(), theta.sin()]);
        [sub([x, y], half), sub([vx, vy], scale(omega, perp(half)))]
    }
}

/// A named inner point of a flexible link.
#[derive(Debug, Clone)]
pub struct LinkPoint {
    /// The name the user wrote.
    pub name: String,
    /// Index of the node, counted from `start`.
    pub node: usize,
}

/// Structural damping of a flexible link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Damping {
    /// Retardation time of the strain rates \[s\]: Kelvin-Voigt, or the second half of Rayleigh's.
    pub strain: f64,
    /// Damping proportional to mass \[1/s\], the first half of Rayleigh's.
    pub mass: f64,
}

/// How a link deforms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinkModel {
    /// Natural coordinates, constant length.
    Rigid,
    /// Planar cubic ANCF elements.
    Flexible {
        /// Number of equal elements.
        elements: usize,
        /// Young's modulus \[Pa\].
        youngs_modulus: f64,
    },
}

/// A rigid body in reference-point coordinates (x, y, theta).
#[derive(Debug, Clone)]
pub struct RigidBody {
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia about the centre of mass \[kg m2\].
    pub inertia: f64,
    /// Named points relative to the centre of mass at theta = 0 \[m\].
    pub points: Vec<Point>,
}

/// A point of a body: indices into [`super::Scene::bodies`] and into the points of that body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PointRef {
    /// Index of the body.
    pub body: usize,
    /// Index of the point; of a link 0 is `start`, 1 is `end`.
    pub point: usize,
}
