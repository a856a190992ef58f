//! What the user writes: a planar mechanism, in SI units, every number explicit.
//!
//! A [`Scene`] is plain data with every name resolved and every number checked; the spans point back into the
//! text so that a later error (a mechanism that cannot close) still names file, line and field.

mod file;
mod integrator;
mod kinds;
pub mod language;
mod motion;
mod plausibility;
mod reader;

pub use crate::body::PointRef;
pub use crate::document::{SceneError, Span};
pub use crate::interaction::{Contact, Friction, Joint, NamedForce};
use crate::math::plane::Vec2;
use crate::motion::{Function, Path};
pub use crate::stepper::Method;
pub use file::read_file;
use indexmap::IndexMap;

use crate::body::{Body, Deformation, Material};
use crate::document::Sources;
use crate::table::Format;
use serde::Serialize;
use std::collections::HashMap;
use std::sync::Arc;

/// A complete description of one simulation.
#[derive(Debug, Clone)]
pub struct Scene {
    /// One line that says what the scene is.
    pub title: String,
    /// Duration and gravity.
    pub simulation: SimulationTable,
    /// Time integration.
    pub integrator: Integrator,
    /// What is recorded.
    pub output: Output,
    /// Materials by name.
    pub materials: IndexMap<String, Material>,
    /// Bodies in the order of the file; `ground` is one of them.
    pub bodies: Vec<NamedBody>,
    /// Joints in the order of the file.
    pub joints: Vec<Joint>,
    /// Motions prescribed by inverse kinematics.
    pub drives: Vec<Drive>,
    /// Motions prescribed directly.
    pub motions: Vec<PrescribedMotion>,
    /// Springs and loads.
    pub forces: Vec<NamedForce>,
    /// Where the motion starts.
    pub initial: Initial,
    /// Values that the source of the scene does not give.
    pub assumptions: Vec<Assumption>,
    /// What is remarkable about its numbers.
    pub notes: Vec<String>,
    sources: Sources,
}

/// What is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Analysis {
    /// Motion over time.
    Dynamic,
    /// Equilibrium under loads that grow with t from 0 to the duration.
    Static,
}

/// `[simulation]`
#[derive(Debug, Clone)]
pub struct SimulationTable {
    /// Motion or equilibrium.
    pub analysis: Analysis,
    /// Simulated time \[s\]; of a static analysis the t of the full load.
    pub duration: f64,
    /// Gravity vector \[m/s2\], absent when the scene names none.
    pub gravity: Option<[f64; 2]>,
    /// True where a static analysis goes on along its path where the load cannot grow.
    pub follows_limits: bool,
}

/// What `integrator.method` says where a run chooses the scheme.
pub const AUTO: &str = "auto";

/// `[integrator]`
#[derive(Debug, Clone)]
pub struct Integrator {
    /// Scheme and its parameters.
    pub method: Method,
    /// True with `method = "auto"`: a run chooses the scheme, and `method` is only the first candidate until then.
    pub automatic: bool,
    /// What the length of a step follows.
    pub pace: Pace,
    /// Largest error that Newton's method may leave in a velocity \[m/s\] (slope rates 1/s, angular velocities rad/s), where the
    /// scene gives it; [`Integrator::newton_tolerance_for`] has the default.
    pub newton_tolerance: Option<f64>,
    /// Largest |delta| of a located contact onset \[m\].
    pub onset_tolerance: f64,
    /// True where a step is cut at a contact onset or loss; false to see what it costs not to.
    pub locate_onsets: bool,
    /// True where a step of a method of high order ends at every knot of a spline.
    pub ends_at_knots: bool,
    /// Where `integrator.method` stands.
    pub method_span: Span,
    /// Where `integrator.step` or `integrator.accuracy` stands.
    pub pace_span: Span,
}

/// What the length of a step follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pace {
    /// Every step this long \[s\].
    Step(f64),
    /// An estimate of the error.
    Accuracy(Accuracy),
}

/// `integrator.accuracy`
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// Error that may gather in the position of any point \[m\]
    pub position: f64,
    /// and, where asked for, error that may gather in the balance of energies \[J\] ...
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<f64>,
    /// ... over this time \[s\].
    pub horizon: f64,
}

impl std::fmt::Display for Accuracy {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{:e} m", self.position)?;
        if let Some(energy) = self.energy {
            write!(f, " and {energy:e} J")?;
        }
        write!(f, " over {} s", self.horizon)
    }
}

impl Integrator {
    /// The step \[s\], where every step has the same length.
    pub fn step(&self) -> Option<f64> {
        match self.pace {
            Pace::Step(step) => Some(step),
            Pace::Accuracy(_) => None,
        }
    }

    /// Largest error that Newton's method may leave in a velocity \[m/s\] of a mechanism of this size \[m\]. Unless the scene gives
    /// it, a step moves a point by 1e-13 of the size with it, some hundred roundings of a position; with an accuracy, the errors of a
    /// horizon add up to a ten-thousandth of it at most.
    pub fn newton_tolerance_for(&self, size: f64) -> f64 {
        self.newton_tolerance.unwrap_or(match self.pace {
            _ if self.method.scheme.is_explicit => 0.0,
            Pace::Step(step) => 1e-13 * size / step,
            Pace::Accuracy(Accuracy {
                position, horizon, ..
            }) => 1e-4 * position / horizon,
        })
    }

    /// Method, and step or accuracy, as captions of pictures say it.
    pub fn description(&self) -> String {
        let pace = match self.pace {
            Pace::Step(step) => format!("step {}", numbers::si(step, "s")),
            Pace::Accuracy(accuracy) => format!("accuracy {accuracy}"),
        };
        format!("{}, {pace}", self.method_name())
    }

    /// What `integrator.method` says.
    pub fn method_name(&self) -> &'static str {
        match self.automatic {
            true => AUTO,
            false => self.method.name(),
        }
    }
}

/// `[output]`
#[derive(Debug, Clone)]
pub struct Output {
    /// Time between recorded rows \[s\], a whole multiple of the step.
    pub interval: f64,
    /// Channel names; `*` stands for any run of characters.
    pub channels: Vec<ChannelPattern>,
    /// How tables are written.
    pub format: &'static Format,
    /// True where the motion is stored for a viewer.
    pub motion: bool,
    /// The time from which extremes count \[s\].
    pub extremes_from: f64,
}

/// One entry of `output.channels`.
#[derive(Debug, Clone)]
pub struct ChannelPattern {
    /// A channel name or a pattern with `*`.
    pub pattern: String,
    /// Where it stands.
    pub span: Span,
}

/// `[drives.NAME]`: the joints follow the inverse kinematics of the ideal rigid mechanism while the body follows the path.
#[derive(Debug, Clone)]
pub struct Drive {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// Actuated joints: indices into [`Scene::joints`].
    pub joints: Vec<usize>,
    /// Driven body: index into [`Scene::bodies`], a rigid body.
    pub body: usize,
    /// Path of its reference point and its angle.
    pub path: Arc<dyn Path>,
    /// Where the path stands.
    pub path_span: Span,
}

/// `[drives.NAME]` of type `angle` or `point`: a motion prescribed directly.
#[derive(Debug, Clone)]
pub struct PrescribedMotion {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// What is prescribed.
    pub kind: MotionKind,
}

/// What a motion prescribes.
#[derive(Debug, Clone)]
pub enum MotionKind {
    /// The angle of the journal's body relative to the bearing's in a revolute joint \[rad\].
    Angle {
        /// Index into [`Scene::joints`].
        joint: usize,
        /// The angle \[rad\].
        angle: Function,
    },
    /// Coordinates of a point relative to the ground \[m\].
    Point {
        /// The point.
        point: PointRef,
        /// x and y, each free when absent.
        coordinates: [Option<Function>; 2],
    },
}

/// `[bodies.NAME]`
#[derive(Debug, Clone)]
pub struct NamedBody {
    /// The name the user wrote.
    pub name: String,
    /// Where the table stands.
    pub span: Span,
    /// What it is.
    pub kind: Arc<dyn Body>,
}

/// `[initial]`
#[derive(Debug, Clone)]
pub struct Initial {
    /// Approximate positions of joints and points \[m\]: they choose the branch.
    pub sketch: Vec<SketchPoint>,
    /// Exact states by the indices of their bodies, for mechanisms without a drive.
    pub bodies: IndexMap<usize, BodyState>,
    /// Single velocities; the others follow with the least kinetic energy.
    pub velocities: Vec<GivenVelocity>,
    /// The start is an equilibrium under the loads at t = 0.
    pub equilibrium: Option<Rest>,
    /// Where journals start in their bearings.
    pub journals: Journals,
    /// Where the table stands.
    pub span: Span,
}

/// Where journals start in their bearings.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Journals {
    /// Where the assembly or the given poses put them, in an assembled mechanism in the middle.
    #[default]
    Centred,
    /// Pressed against the bearings by the forces of the ideal joints.
    Pressed,
}

impl Initial {
    /// The state that the scene gives to a body.
    pub(crate) fn state_of(&self, body: usize) -> Option<&BodyState> {
        self.bodies.get(&body)
    }
}

/// Which equilibrium a motion starts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rest {
    /// The one that is reached downhill.
    Stable,
    /// The nearest, stable or not.
    Nearest,
}

/// The approximate position of a joint or a point at t = 0.
#[derive(Debug, Clone)]
pub struct SketchPoint {
    /// What is sketched.
    pub what: Sketched,
    /// Approximate position \[m\].
    pub at: Vec2,
    /// Where it stands.
    pub span: Span,
}

/// What an entry of the sketch places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sketched {
    /// A joint, by its index in [`Scene::joints`].
    Joint(usize),
    /// A point of a body.
    Point(PointRef),
}

/// Position and velocity of a body at t = 0: those of its centre of mass, and its angle.
#[derive(Debug, Clone)]
pub struct BodyState {
    /// Index into [`Scene::bodies`].
    pub body: usize,
    /// x, y \[m\], theta \[rad\].
    pub position: [f64; 3],
    /// vx, vy \[m/s\], omega \[rad/s\]; rest when the scene gives none.
    pub velocity: [f64; 3],
    /// False when the scene leaves the velocity out.
    pub velocity_given: bool,
    /// How it is deformed.
    pub deformation: Deformation,
    /// Where it stands.
    pub span: Span,
}

/// One velocity at t = 0.
#[derive(Debug, Clone, Copy)]
pub struct GivenVelocity {
    /// Index into [`Scene::bodies`].
    pub body: usize,
    /// 0, 1, 2 for vx, vy of the centre of mass \[m/s\], omega \[rad/s\].
    pub component: usize,
    /// Its value.
    pub value: f64,
    /// Where it stands.
    pub span: Span,
}

/// A value that the source of the scene does not give.
#[derive(Debug, Clone)]
pub struct Assumption {
    /// Path of the field.
    pub path: String,
    /// Its value as written.
    pub value: String,
    /// Why this value.
    pub reason: String,
}

impl Scene {
    /// Hexadecimal SHA-256 of the scene text and the overrides.
    pub fn hash(&self) -> String {
        self.sources.hash()
    }

    /// The scene text as it was read, without the overrides.
    pub fn text(&self) -> &str {
        self.sources.text(0)
    }

    /// The overrides in the order they were applied.
    pub fn overrides(&self) -> impl Iterator<Item = &str> {
        self.sources.overrides()
    }

    /// An error that points at `span`.
    pub fn error(
        &self,
        span: Span,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> SceneError {
        SceneError::new(&self.sources, span, message, label)
    }

    /// An error that points at a span, and at another one that contradicts it, if there is one.
    pub(crate) fn contradiction(
        &self,
        message: String,
        (span, label): (Span, &str),
        other: Option<(Span, &str)>,
    ) -> SceneError {
        let error = self.error(span, message, label);
        match other {
            Some((span, label)) => error.against(&self.sources, span, label),
            None => error,
        }
    }

    /// The smallest clearance of its joints \[m\]; none where no joint has clearance.
    pub fn smallest_clearance(&self) -> Option<f64> {
        smallest_clearance(self.joints.iter())
    }

    /// The angles that drives prescribe in joints.
    pub(crate) fn prescribed_angles(&self) -> HashMap<usize, &Function> {
        let angles = self.motions.iter().filter_map(|motion| match &motion.kind {
            MotionKind::Angle { joint, angle } => Some((*joint, angle)),
            MotionKind::Point { .. } => None,
        });
        angles.collect()
    }

    /// Index of the body with this name.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|b| b.name == name)
    }

    /// Index of the joint with this name.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|j| j.name == name)
    }
}

/// The smallest clearance of some joints \[m\]; none where no joint has clearance.
fn smallest_clearance<'a>(joints: impl Iterator<Item = &'a Joint>) -> Option<f64> {
    let contacts = joints.filter_map(Joint::contact);
    contacts.map(|contact| contact.clearance).reduce(f64::min)
}
