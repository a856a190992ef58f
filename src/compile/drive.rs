//! The drive: compiles the ideal rigid mechanism, closes it at the start, and follows its path to the end.

use super::{Compiler, Mode, Role, numbering, terms};
use crate::kinematics::{Dyad, Kinematics};
use crate::marker::Marker;
use crate::math::plane::{cross, dot, norm, sub};
use crate::model::{BodyCoordinates, Model};
use crate::scene::{BodyKind, Drive, Link, LinkModel, PointRef, Scene, SceneError};
use crate::system::State;

/// Poses tried along the path before the simulation, so that a path out of reach is found at once.
const SWEEP: usize = 2000;

/// Compiles the ideal mechanism of a drive and checks that it can follow the path for the whole duration.
pub(super) fn ideal_mechanism(
    scene: &Scene,
    drive: &Drive,
    roles: &[Role],
) -> Result<Kinematics, SceneError> {
    let mut roles = roles.to_vec();
    roles[drive.body] = Role::Path;
    let compiler = Compiler {
        scene,
        mode: Mode::Ideal,
        roles,
    };
    let numbering = numbering::number(&compiler, None)?;
    let mechanism = terms::build(&compiler, numbering, None)?;
    let shape = mechanism.shape();
    if shape.unknowns != shape.multipliers {
        let body = &scene.bodies[drive.body].name;
        let free = shape.unknowns as isize - shape.multipliers as isize;
        let message = format!(
            "drive {}: the path of {body} does not determine the ideal mechanism: {} unknown coordinates, {} constraints",
            drive.name, shape.unknowns, shape.multipliers
        );
        let label = if free > 0 {
            "some bodies stay free to move"
        } else {
            "the mechanism is overdetermined"
        };
        return Err(scene.error(drive.span, message, label));
    }
    let dyads = find_dyads(&compiler, &mechanism);
    let mut kinematics = Kinematics {
        mechanism: Box::new(mechanism),
        offset: 0,
        dyads,
        start: Vec::new(),
    };
    let start = close(&compiler, drive, &kinematics)?;
    sweep(scene, drive, &kinematics, &start)?;
    kinematics.start = start.q;
    Ok(kinematics)
}

/// Closes the mechanism at t = 0 from the sketch.
fn close(c: &Compiler, drive: &Drive, kinematics: &Kinematics) -> Result<State, SceneError> {
    let mechanism = &*kinematics.mechanism;
    let mut inner = kinematics.work();
    mechanism.follow_path(&mut inner.state);
    mechanism.ride(&mut inner.state);
    let guessed = guess(c, mechanism, &mut inner.state)?;
    kinematics.solve(&mut inner, 60).map_err(|e| {
        c.scene.error(
            drive.span,
            format!("drive {}: {e}", drive.name),
            "the mechanism of this drive",
        )
    })?;
    for (x, sketch) in guessed {
        let found = [inner.state.q[x], inner.state.q[x + 1]];
        let (drawn, joint) = (
            &c.scene.initial.sketch[sketch],
            &c.scene.joints[c.scene.initial.sketch[sketch].joint],
        );
        let lengths =
            [joint.bearing, joint.journal].map(|p| link(c, p).map_or(f64::INFINITY, |l| l.length));
        let shortest = lengths[0].min(lengths[1]);
        if norm(sub(found, drawn.at)) > 0.25 * shortest {
            let message = format!(
                "joint {} closes at ({:.4}, {:.4}) m, far from its sketch: draw it closer to the branch you mean",
                joint.name, found[0], found[1]
            );
            return Err(c.scene.error(drawn.span, message, "the sketch"));
        }
    }
    Ok(inner.state)
}

fn marker(c: &Compiler, mechanism: &Model, point: PointRef) -> Marker {
    c.marker(&mechanism.bodies()[point.body].coordinates, point)
}

fn link<'a>(c: &Compiler<'a>, point: PointRef) -> Option<&'a Link> {
    match &c.scene.bodies[point.body].kind {
        BodyKind::Link(link) => Some(link),
        _ => None,
    }
}

/// Puts the sketched positions into the unknown nodes and fits the unknown rigid bodies to them; returns the nodes
/// with the index of their sketch.
fn guess(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
) -> Result<Vec<(usize, usize)>, SceneError> {
    let n = mechanism.shape().unknowns;
    let mut known = vec![false; state.q.len()];
    known[n..].fill(true);
    let mut guessed = Vec::new();
    for (k, sketch) in c.scene.initial.sketch.iter().enumerate() {
        let joint = &c.scene.joints[sketch.joint];
        for point in [joint.bearing, joint.journal] {
            if let Marker::Node { x } = marker(c, mechanism, point) {
                if x < n {
                    state.q[x..x + 2].copy_from_slice(&sketch.at);
                    guessed.push((x, k));
                }
                known[x] = true;
            }
        }
    }
    for (b, body) in c.scene.bodies.iter().enumerate() {
        match (&mechanism.bodies()[b].coordinates, &body.kind) {
            (BodyCoordinates::RigidLink { ends }, _) => {
                if let Some(end) = (0..2).find(|&e| !known[ends[e]]) {
                    let name = c.point_name(PointRef {
                        body: b,
                        point: end,
                    });
                    let message = format!(
                        "the sketch does not say where {name} is: give the position of a joint there"
                    );
                    return Err(c.scene.error(body.span, message, "this body"));
                }
            }
            (BodyCoordinates::Rigid { x }, BodyKind::Rigid(rigid)) if *x < n => {
                let pairs: Vec<_> = (0..rigid.points.len())
                    .filter_map(|point| sketch_of(c, mechanism, state, PointRef { body: b, point }))
                    .collect();
                if pairs.len() < 2 {
                    let message = format!(
                        "the sketch must give the positions of two joints of {}",
                        body.name
                    );
                    return Err(c.scene.error(body.span, message, "this body"));
                }
                let pose = fit(&pairs);
                state.q[*x..x + 3].copy_from_slice(&pose);
            }
            _ => {}
        }
    }
    Ok(guessed)
}

/// (point in the body, approximate position) of a point of a rigid body, from a sketch or from a known partner.
fn sketch_of(c: &Compiler, mechanism: &Model, state: &State, point: PointRef) -> Option<Pair> {
    let BodyKind::Rigid(rigid) = &c.scene.bodies[point.body].kind else {
        return None;
    };
    let local = rigid.points[point.point].at;
    c.scene.joints.iter().enumerate().find_map(|(j, joint)| {
        let partner = match () {
            () if joint.bearing == point => joint.journal,
            () if joint.journal == point => joint.bearing,
            () => return None,
        };
        let drawn = c
            .scene
            .initial
            .sketch
            .iter()
            .find(|s| s.joint == j)
            .map(|s| s.at);
        let known = || {
            c.is_known(partner)
                .then(|| mechanism.position(&marker(c, mechanism, partner), state))
        };
        drawn.or_else(known).map(|at| (local, at))
    })
}

/// A point in the frame of its body and its approximate position.
type Pair = ([f64; 2], [f64; 2]);

/// The pose (x, y, theta) that carries points of a body closest to given positions.
fn fit(pairs: &[Pair]) -> [f64; 3] {
    let count = pairs.len() as f64;
    let mean = |pick: fn(&Pair) -> [f64; 2]| {
        let sum = pairs
            .iter()
            .map(pick)
            .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        [sum[0] / count, sum[1] / count]
    };
    let (local, global) = (mean(|p| p.0), mean(|p| p.1));
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (s, r) in pairs {
        let (s, r) = (sub(*s, local), sub(*r, global));
        sine += cross(s, r);
        cosine += dot(s, r);
    }
    let theta = f64::atan2(sine, cosine);
    let turned = crate::math::plane::rotate(theta.cos(), theta.sin(), local);
    [global[0] - turned[0], global[1] - turned[1], theta]
}

/// Follows the path over the whole duration.
fn sweep(
    scene: &Scene,
    drive: &Drive,
    kinematics: &Kinematics,
    start: &State,
) -> Result<(), SceneError> {
    let mut inner = kinematics.work();
    let (mut from, mut to) = (start.clone(), start.clone());
    for k in 1..=SWEEP {
        to.t = scene.simulation.duration * k as f64 / SWEEP as f64;
        kinematics
            .prescribe(&from, &mut to, &mut inner)
            .map_err(|e| {
                scene.error(
                    drive.path_span,
                    format!("drive {}: {e}", drive.name),
                    "this path is out of reach",
                )
            })?;
        from.copy_from(&to);
    }
    Ok(())
}

/// Unknown nodes between two links whose other ends are known.
fn find_dyads(c: &Compiler, mechanism: &Model) -> Vec<Dyad> {
    let n = mechanism.shape().unknowns;
    let far_ends = |x: usize| {
        let of = |b: usize| match (&mechanism.bodies()[b].coordinates, &c.scene.bodies[b].kind) {
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
                let near = ends.iter().position(|&e| e == x)?;
                Some((b, 1 - near, ends[1 - near], link.length))
            }
            _ => None,
        };
        (0..c.scene.bodies.len()).filter_map(of).collect::<Vec<_>>()
    };
    let joint_at = |body: usize, end: usize| {
        let point = PointRef { body, point: end };
        let joint = c
            .scene
            .joints
            .iter()
            .find(|j| j.bearing == point || j.journal == point);
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
            let flexible =
                matches!(&scene.bodies[moved].kind, BodyKind::Link(l) if l.model != LinkModel::Rigid);
            if flexible {
                fault = Some((j, "the body it moves is flexible; a driven body must be rigid"));
            } else if !matches!(joint.model, crate::scene::JointModel::Ideal) {
                fault = Some((j, "it has clearance; an actuated joint must be ideal"));
            }
            roles[moved] = Role::Driven;
            false
        });
        let stuck = (waiting.len() == before)
            .then(|| (waiting[0], "no driven chain of bodies leads to it"));
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
