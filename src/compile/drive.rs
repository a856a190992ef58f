//! The drive: compiles the ideal rigid mechanism, closes it at the start, and follows its path to the end.

use super::assembly::position;
use super::extent::{FITS, extent};
use super::sketch::close;
use super::{Compiler, Mode, Role, build, numbering};
use crate::body::{PointRef, RigidLink};
use crate::kinematics::{Dyad, Kinematics};
use crate::model::Model;
use crate::scene::{Drive, Scene, SceneError};
use crate::system::State;

/// Coordinates that a path prescribes: x, y and theta.
const PATH: isize = 3;

/// Compiles the ideal mechanism of a drive and checks that it can follow the path for the whole duration.
pub(super) fn ideal_mechanism(
    scene: &Scene,
    drive: &Drive,
    roles: &[Role],
) -> Result<Kinematics, SceneError> {
    let (compiler, kinematics, start) = at_start(scene, drive, roles)?;
    sweep(&compiler, drive, &kinematics, &start)?;
    Ok(kinematics)
}

/// The ideal mechanism of a drive, closed at the start of its path.
pub(super) fn at_start<'s>(
    scene: &'s Scene,
    drive: &Drive,
    roles: &[Role],
) -> Result<(Compiler<'s>, Kinematics, State), SceneError> {
    let mut roles = roles.to_vec();
    roles[drive.body] = Role::Path;
    let compiler = Compiler::new(scene, Mode::Ideal, roles);
    let numbering = numbering::number(&compiler, None)?;
    let mechanism = build::build(&compiler, numbering, None)?;
    let shape = mechanism.shape();
    if shape.unknowns != shape.multipliers {
        let surplus = shape.unknowns as isize - shape.multipliers as isize;
        return Err(undetermined(scene, drive, &mechanism, surplus));
    }
    let dyads = find_dyads(&compiler, &mechanism);
    let moves = |i: &usize| mechanism.fixed.iter().all(|(j, _)| i != j);
    let mut kinematics = Kinematics {
        size: extent(scene),
        lengths: mechanism.lengths(),
        moving: (0..shape.coordinates).filter(moves).collect(),
        mechanism: Box::new(mechanism),
        offset: 0,
        dyads,
        start: Vec::new(),
        period: drive.path.sweep(scene.simulation.duration).0,
        duration: scene.simulation.duration,
    };
    let start = close(&compiler, drive, &kinematics)?;
    kinematics.start.clone_from(&start.q);
    Ok((compiler, kinematics, start))
}

/// The error of a path that leaves so many coordinates free, or prescribes so many too many where the number is negative.
fn undetermined(scene: &Scene, drive: &Drive, mechanism: &Model, surplus: isize) -> SceneError {
    let shape = mechanism.shape();
    let body = &scene.bodies[drive.body].name;
    let counts = format!(
        "the ideal mechanism, which has {} unknown coordinates and {} constraints",
        shape.unknowns, shape.multipliers
    );
    let (does, label, advice) = match (surplus > 0, PATH + surplus) {
        (true, _) => (
            "does not determine the pose of",
            "some bodies stay free to move",
            "add the joint that holds them, or a spring and no inverse kinematics".to_owned(),
        ),
        (false, left @ 1..) => (
            "overdetermines",
            "prescribes too much",
            format!(
                "without this drive it has {left} of the {PATH} freedoms x, y and theta that a path prescribes: prescribe x and y alone \
                 with a drive of type \"point\", or add a joint in which {body} turns freely"
            ),
        ),
        (false, _) => {
            let joints = scene.joints.iter();
            let own = joints.filter(|j| j.points().iter().any(|p| p.body == drive.body));
            let own: Vec<&str> = own.map(|joint| &*joint.name).collect();
            (
                "overdetermines",
                "it cannot move",
                format!(
                    "its joints hold it without this drive: remove one, perhaps of {}",
                    own.join(", ")
                ),
            )
        }
    };
    let message = format!("drive {}: the path of {body} {does} {counts}", drive.name);
    let error = scene.error(drive.span, message, label);
    error.with_help(advice)
}

/// Follows the path over the whole duration, pose by pose, and checks that joints between known points stay closed.
fn sweep(
    c: &Compiler,
    drive: &Drive,
    kinematics: &Kinematics,
    start: &State,
) -> Result<(), SceneError> {
    let mut inner = kinematics.work();
    let (mut from, mut to) = (start.clone(), start.clone());
    let (horizon, poses) = drive.path.sweep(c.scene.simulation.duration);
    for k in 0..=poses {
        to.t = horizon * k as f64 / poses as f64;
        let solved = kinematics.solve_at(&from, &mut to, &mut inner);
        solved.map_err(|e| {
            let message = format!("drive {}: {e}", drive.name);
            let label = "this path is out of reach";
            c.scene.error(drive.path_span, message, label)
        })?;
        for (j, joint) in c.scene.joints.iter().enumerate() {
            if joint.points().iter().all(|&p| c.is_known(p)) {
                let at = |p| position(&kinematics.mechanism, &to, p);
                let [a, b] = joint.points().map(at);
                let distance = (a - b).norm();
                if distance > FITS * extent(c.scene) {
                    let message = format!(
                        "drive {}: the path pulls joint {} apart, by {} at t = {} s",
                        drive.name,
                        joint.name,
                        numbers::si(distance, "m"),
                        to.t
                    );
                    return Err(c.joint_error(j, message, "both of its points are prescribed"));
                }
            }
        }
        from.copy_from(&to);
    }
    Ok(())
}

/// Unknown nodes between two links whose other ends are known.
fn find_dyads(c: &Compiler, mechanism: &Model) -> Vec<Dyad> {
    let n = mechanism.shape().unknowns;
    let far_ends = |x: usize| {
        let of = |b: usize| {
            let ends = &mechanism.bodies()[b].placed.x;
            let link = &c.bodies[b].get::<RigidLink>()?.link;
            let near = ends.iter().position(|&e| e == x)?;
            Some((b, 1 - near, ends[1 - near], link.length))
        };
        (0..c.scene.bodies.len()).filter_map(of).collect::<Vec<_>>()
    };
    let joint_at = |body: usize, end: usize| {
        let point = PointRef { body, point: end };
        let mut joints = c.scene.joints.iter();
        let joint = joints.find(|joint| joint.points().contains(&point));
        joint.map_or_else(|| c.point_name(point), |j| j.name.clone())
    };
    let mut dyads = Vec::new();
    for x in 0..n {
        let far = far_ends(x);
        if let [(b1, e1, x1, l1), (b2, e2, x2, l2)] = far[..]
            && x1 >= n
            && x2 >= n
        {
            let name = |b: usize| c.scene.bodies[b].name.clone();
            dyads.push(Dyad {
                ends: [(x1, joint_at(b1, e1)), (x2, joint_at(b2, e2))],
                links: [(name(b1), l1), (name(b2), l2)],
            });
        }
    }
    dyads
}

/// Marks the bodies that actuated joints move, outward from the ground.
pub(super) fn mark_driven(
    scene: &Scene,
    drive: &Drive,
    roles: &mut [Role],
) -> Result<(), SceneError> {
    let mut waiting: Vec<usize> = drive.joints.clone();
    while !waiting.is_empty() {
        let before = waiting.len();
        let mut fault = None;
        waiting.retain(|&j| {
            let joint = &scene.joints[j];
            let (i, k) = (joint.bearing.body, joint.journal.body);
            let moved = match (roles[i] != Role::Free, roles[k] != Role::Free) {
                (true, false) => k,
                (false, true) => i,
                (true, true) => {
                    fault = Some((j, "its two bodies are already driven"));
                    return false;
                }
                (false, false) => return true,
            };
            if !scene.bodies[moved].kind.is_rigid() {
                let why = "the body it moves is flexible; a driven body must be rigid";
                fault = Some((j, why));
            } else if joint.contact().is_some() {
                fault = Some((j, "it has clearance; an actuated joint must be ideal"));
            }
            roles[moved] = Role::Driven;
            false
        });
        let why = "no chain of actuated joints connects it to the ground";
        let stuck = (waiting.len() == before).then(|| (waiting[0], why));
        if let Some((j, why)) = fault.or(stuck) {
            let message = format!(
                "drive {} cannot actuate joint {}: {why}",
                drive.name, scene.joints[j].name
            );
            return Err(scene.error(scene.joints[j].span, message, "this joint"));
        }
    }
    Ok(())
}
