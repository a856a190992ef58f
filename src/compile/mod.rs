//! Scene -> model: shares nodes, eliminates known coordinates, and builds only the terms that the scene has.

pub(crate) mod actuation;
pub(crate) mod assembly;
mod build;
mod drive;
pub mod drive_limit;
pub(crate) mod extent;
mod locked;
mod mass;
mod motions;
mod numbering;
mod pin;
mod places;
mod reactions;
mod rules;
mod sketch;
mod ties;

use crate::body::{Body, Known, PointRef, Slot, Ties};
use crate::interaction::JointModel;
use crate::kinematics::Kinematics;
use crate::math::plane::Vec2;
use crate::model::Model;
use crate::scene::{MotionKind, NamedBody, Scene, SceneError, SketchPoint, Sketched};
use pin::Pin;
use std::collections::HashMap;
use std::sync::Arc;

/// What determines the motion of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Nothing: it is the ground.
    Ground,
    /// The equations of motion.
    Free,
    /// A path: its own if it is a moving body, or that of a drive (in the ideal mechanism).
    Path,
    /// The prescribed motion of this index, a rotation about a point of the ground.
    Turned(usize),
    /// The ideal mechanism (in the real mechanism).
    Driven,
}

impl Role {
    /// The prescribed motion that turns the body.
    pub fn turned(&self) -> Option<usize> {
        match self {
            Role::Turned(motion) => Some(*motion),
            _ => None,
        }
    }
}

/// Which of the mechanisms of a scene is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    /// The scene as written.
    Real,
    /// Rigid links, ideal joints, the driven body on its path.
    Ideal,
    /// The scene with rigid links, and multipliers in place of its contacts: their forces press the journals at the start.
    Pressed,
}

/// A scene under compilation: its bodies and joints as they are in this mechanism.
pub(crate) struct Compiler<'a> {
    pub scene: &'a Scene,
    pub mode: Mode,
    pub roles: Vec<Role>,
    pub bodies: Vec<Arc<dyn Body>>,
    /// Coordinates of every body.
    pub slots: Vec<Vec<Slot>>,
    pub joints: Vec<Arc<dyn JointModel>>,
    /// The joints at every point, each with its other point.
    joints_at: HashMap<PointRef, Vec<(usize, PointRef)>>,
    /// The sketch.
    drawn: HashMap<Sketched, Vec2>,
    /// Of every joint, whether a body has the coordinate that it leaves.
    pub holds: Vec<bool>,
}

impl<'a> Compiler<'a> {
    fn new(scene: &'a Scene, mode: Mode, roles: Vec<Role>) -> Compiler<'a> {
        let body = |b: &NamedBody| {
            let rigid = b.kind.rigid().filter(|_| mode != Mode::Real);
            rigid.unwrap_or_else(|| b.kind.clone())
        };
        let joint = |model: &Arc<dyn JointModel>| {
            model.contact()?;
            match mode {
                Mode::Real => None,
                Mode::Ideal => model.with_contact(None),
                Mode::Pressed => Some(Pin::of(model.with_contact(None)?)),
            }
        };
        let bodies: Vec<_> = scene.bodies.iter().map(body).collect();
        let mut joints_at: HashMap<PointRef, Vec<(usize, PointRef)>> = HashMap::new();
        for (j, joint) in scene.joints.iter().enumerate() {
            let [bearing, journal] = joint.points();
            joints_at.entry(bearing).or_default().push((j, journal));
            joints_at.entry(journal).or_default().push((j, bearing));
        }
        let sketch = scene.initial.sketch.iter();
        let joints = scene.joints.iter().map(|j| &j.model);
        Compiler {
            scene,
            mode,
            roles,
            slots: bodies.iter().map(|b| b.slots()).collect(),
            bodies,
            joints_at,
            drawn: sketch.map(|s| (s.what, s.at)).collect(),
            holds: vec![false; scene.joints.len()],
            joints: joints
                .map(|j| joint(j).unwrap_or_else(|| j.clone()))
                .collect(),
        }
    }
}

impl Compiler<'_> {
    /// Gives free bodies the coordinates that they have in the mechanism of the scene.
    fn choose_coordinates(&mut self, ties: &[Ties]) {
        for (b, body) in self.bodies.iter_mut().enumerate() {
            let real = body.real(&ties[b]);
            if let Some(real) = real.filter(|_| self.roles[b] == Role::Free) {
                if let Some(hold) = real.hold() {
                    self.holds[hold.joint] = true;
                }
                self.slots[b] = real.slots();
                *body = real;
            }
        }
    }

    pub fn is_known(&self, point: PointRef) -> bool {
        self.roles[point.body] != Role::Free
    }

    /// True for a joint between bodies of known motion that this motion keeps closed: the one about which a drive turns a body,
    /// and those that inverse kinematics checks along the path.
    pub fn may_stay_closed(&self, joint: usize) -> bool {
        let sides = &self.scene.joints[joint];
        let mut roles = [sides.bearing, sides.journal]
            .map(|p| self.roles[p.body])
            .into_iter();
        let turned = |m: usize| match self.scene.motions[m].kind {
            MotionKind::Angle { joint: about, .. } => about == joint,
            MotionKind::Point { .. } => false,
        };
        self.mode == Mode::Ideal
            || roles.any(|role| match role {
                Role::Turned(m) => turned(m),
                role => role == Role::Driven,
            })
    }

    /// The slot of a point whose unknown node joints can share: of an end of a link, of a point mass.
    pub fn node(&self, point: PointRef) -> Option<usize> {
        if self.is_known(point) {
            return None;
        }
        let mut slots = self.slots[point.body].iter();
        slots.position(|slot| slot.point == Some(point.point))
    }

    /// The points of an entry of the sketch: both sides of a joint, or the point itself.
    pub fn sketched_points(&self, sketch: &SketchPoint) -> Vec<PointRef> {
        match sketch.what {
            Sketched::Joint(j) => vec![self.scene.joints[j].bearing, self.scene.joints[j].journal],
            Sketched::Point(point) => vec![point],
        }
    }

    /// Name of an entry of the sketch in error messages.
    pub fn sketched_name(&self, sketch: &SketchPoint) -> String {
        match sketch.what {
            Sketched::Joint(j) => format!("joint {}", self.scene.joints[j].name),
            Sketched::Point(point) => format!("point {}", self.point_name(point)),
        }
    }

    /// The joints at a point, each with its other point.
    pub fn joints_at(&self, point: PointRef) -> &[(usize, PointRef)] {
        self.joints_at.get(&point).map_or(&[], Vec::as_slice)
    }

    /// Position of a joint or a point in the sketch.
    pub fn drawn(&self, what: Sketched) -> Option<Vec2> {
        self.drawn.get(&what).copied()
    }

    /// The error for a sketch that is too far from the closed mechanism.
    pub fn far_from_sketch(&self, sketch: &SketchPoint, at: Vec2) -> SceneError {
        let message = format!(
            "{} closes at ({:.4}, {:.4}) m, far from its sketch: draw it closer to the branch you mean",
            self.sketched_name(sketch),
            at.x,
            at.y
        );
        let error = self.scene.error(sketch.span, message, "the sketch");
        error.with_help(format!("or check the lengths{}", self.longest()))
    }

    /// The longest link, for advice; a length in another unit stands out.
    pub fn longest(&self) -> String {
        let bodies = self.scene.bodies.iter();
        let links = bodies.filter_map(|body| Some((&body.name, body.kind.length()?)));
        let longest = links.max_by(|a, b| a.1.total_cmp(&b.1));
        longest.map_or(String::new(), |(name, length)| {
            format!(
                " (the longest is that of {name}, {} m)",
                numbers::exact(length)
            )
        })
    }

    /// An error at joint `joint`.
    pub fn joint_error(&self, joint: usize, message: String, label: &str) -> SceneError {
        self.scene
            .error(self.scene.joints[joint].span, message, label)
    }

    /// Name of a point as the user writes it.
    pub fn point_name(&self, point: PointRef) -> String {
        let body = &self.scene.bodies[point.body];
        format!("{}.{}", body.name, body.kind.points()[point.point].name)
    }
}

/// True of a scene that is its own ideal mechanism: rigid links and joints without clearance.
pub(crate) fn is_ideal(scene: &Scene) -> bool {
    let mut bodies = scene.bodies.iter();
    let mut joints = scene.joints.iter();
    bodies.all(|body| body.kind.is_rigid()) && joints.all(|joint| joint.contact().is_none())
}

/// Roles that a scene gives directly: ground, bodies on paths, rigid bodies turned about a point of the ground.
fn known_roles(scene: &Scene) -> Vec<Role> {
    let role = |b: &NamedBody| match b.kind.known() {
        Some(Known::Fixed) => Role::Ground,
        Some(Known::Path(_)) => Role::Path,
        None => Role::Free,
    };
    let mut roles: Vec<Role> = scene.bodies.iter().map(role).collect();
    for (m, motion) in scene.motions.iter().enumerate() {
        let MotionKind::Angle { joint, .. } = motion.kind else {
            continue;
        };
        let joint = &scene.joints[joint];
        let (i, j) = (joint.bearing.body, joint.journal.body);
        let turned = match (roles[i], roles[j]) {
            (Role::Ground, Role::Free) => j,
            (Role::Free, Role::Ground) => i,
            _ => continue,
        };
        let body = &scene.bodies[turned].kind;
        if body.is_rigid() && body.turns() && joint.contact().is_none() {
            roles[turned] = Role::Turned(m);
        }
    }
    // a body that another joint holds as well shares its load with the drive
    for (j, joint) in scene.joints.iter().enumerate() {
        let sides = joint.points().map(|point| point.body);
        let turns = |b: usize| {
            let motion = roles[b].turned().map(|m| &scene.motions[m].kind);
            matches!(motion, Some(MotionKind::Angle { joint, .. }) if *joint == j)
        };
        let is_held = sides.iter().all(|b| roles[*b] != Role::Free);
        if joint.model.coincides() && is_held && !sides.iter().any(|b| turns(*b)) {
            for b in sides {
                if roles[b].turned().is_some() {
                    roles[b] = Role::Free;
                }
            }
        }
    }
    roles
}

/// A mechanism, and the ideal one that it follows if inverse kinematics drives it.
#[derive(Debug)]
pub struct Compiled {
    /// The mechanism of the scene.
    pub model: Model,
    /// The ideal rigid mechanism.
    pub kinematics: Option<Arc<Kinematics>>,
}

/// Compiles a scene into the mechanism it describes.
///
/// # Errors
/// A mechanism that cannot close or follow its drives, or whose constraints depend on each other.
pub fn compile(scene: &Scene) -> Result<Compiled, SceneError> {
    compile_as(scene, Mode::Real)
}

/// Compiles the mechanism whose multipliers stand for the contacts of a scene.
///
/// # Errors
/// As [`compile`].
pub(crate) fn compile_pressed(scene: &Scene) -> Result<Compiled, SceneError> {
    compile_as(scene, Mode::Pressed)
}

fn compile_as(scene: &Scene, mode: Mode) -> Result<Compiled, SceneError> {
    let mut roles = known_roles(scene);
    let kinematics = match scene.drives.as_slice() {
        [] => None,
        [drive] => {
            let kinematics = drive::ideal_mechanism(scene, drive, &roles)?;
            drive::mark_driven(scene, drive, &mut roles)?;
            Some(kinematics)
        }
        [_, second, ..] => {
            let message = "a scene can have only one drive of type \"inverse_kinematics\"";
            return Err(scene.error(second.span, message, "the second one"));
        }
    };
    let mut compiler = Compiler::new(scene, mode, roles);
    let ties = ties::of_bodies(&compiler)?;
    compiler.choose_coordinates(&ties);
    let numbering = numbering::number(&compiler, kinematics.as_ref().map(|k| &*k.mechanism))?;
    let kinematics = kinematics.map(|kinematics| {
        Arc::new(Kinematics {
            offset: numbering.offset,
            ..kinematics
        })
    });
    let model = build::build(&compiler, numbering, kinematics.as_ref())?;
    Ok(Compiled { model, kinematics })
}
