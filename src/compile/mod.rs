//! Scene -> model: shares nodes, eliminates known coordinates, leaves out what the scene does not call for.

mod drive;
mod mass;
mod numbering;
mod reactions;
mod sketch;
mod terms;

use crate::model::Model;
use crate::scene::{BodyKind, JointModel, PointRef, Scene, SceneError};

/// What determines the motion of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Ground.
    Ground,
    /// The equations of motion.
    Free,
    /// The path of a drive (in the ideal mechanism).
    Path,
    /// The ideal mechanism (in the real one).
    Driven,
}

/// Which of the two mechanisms of a scene is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    /// The scene as written.
    Real,
    /// Rigid links, ideal joints, the driven body on its path.
    Ideal,
}

/// A scene under compilation.
pub(crate) struct Compiler<'a> {
    pub scene: &'a Scene,
    pub mode: Mode,
    pub roles: Vec<Role>,
}

impl Compiler<'_> {
    /// True where the joint is ideal in this mechanism.
    pub fn is_ideal(&self, joint: usize) -> bool {
        self.mode == Mode::Ideal || matches!(self.scene.joints[joint].model, JointModel::Ideal)
    }

    pub fn is_known(&self, point: PointRef) -> bool {
        self.roles[point.body] != Role::Free
    }

    pub fn is_link(&self, body: usize) -> bool {
        matches!(self.scene.bodies[body].kind, BodyKind::Link(_))
    }

    /// An error at joint `joint`.
    pub fn joint_error(&self, joint: usize, message: String, label: &str) -> SceneError {
        self.scene
            .error(self.scene.joints[joint].span, message, label)
    }

    /// Name of a point as the user writes it.
    pub fn point_name(&self, point: PointRef) -> String {
        let body = &self.scene.bodies[point.body];
        let name = match &body.kind {
            BodyKind::Ground { points } => points[point.point].name.as_str(),
            BodyKind::Rigid(rigid) => rigid.points[point.point].name.as_str(),
            BodyKind::Link(_) => ["start", "end"][point.point],
        };
        format!("{}.{name}", body.name)
    }
}

/// Compiles a scene into the mechanism it describes.
///
/// # Errors
/// A mechanism that cannot close or be driven as asked, or whose constraints repeat each other.
pub fn compile(scene: &Scene) -> Result<Model, SceneError> {
    let ground = |b: &crate::scene::Body| matches!(b.kind, BodyKind::Ground { .. });
    let mut roles: Vec<Role> = scene
        .bodies
        .iter()
        .map(|b| if ground(b) { Role::Ground } else { Role::Free })
        .collect();
    let kinematics = match scene.drives.as_slice() {
        [] => None,
        [drive] => {
            let kinematics = drive::ideal_mechanism(scene, drive, &roles)?;
            drive::mark_driven(scene, drive, &mut roles)?;
            Some(kinematics)
        }
        [_, second, ..] => {
            let message = "a scene can have one drive that follows inverse kinematics";
            return Err(scene.error(second.span, message, "the second one"));
        }
    };
    let compiler = Compiler {
        scene,
        mode: Mode::Real,
        roles,
    };
    let numbering = numbering::number(&compiler, kinematics.as_ref().map(|k| &*k.mechanism))?;
    terms::build(&compiler, numbering, kinematics)
}
