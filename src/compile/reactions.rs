//! The terms whose sum is the force of an eliminated joint or the torque of an actuated one.

use super::{Compiler, Role};
use crate::body::PointRef;
use crate::kinematics::Kinematics;
use crate::model::{Actuator, Grip, Model, PlacedJoint, Reaction, Share, Source};
use crate::scene::{MotionKind, SceneError};
use crate::terms::{ForceTerm, JointTerms};
use std::collections::HashSet;

/// The coordinates of a point that takes forces: x, y of a node, or x, y, theta of a rigid body.
fn place(model: &Model, point: PointRef) -> Option<Vec<usize>> {
    let body = &model.bodies()[point.body];
    // joints and forces name points
    let has_points = !body.points.is_empty();
    (body.moves && has_points).then(|| body.placed.marker(point.point).coordinates())
}

/// The points of a body that take forces: those whose nodes joints can share, or one that stands for a rigid body.
fn attachments(c: &Compiler, model: &Model, body: usize) -> Vec<PointRef> {
    if !model.bodies()[body].moves {
        return Vec::new();
    }
    let mut points: Vec<PointRef> = Vec::new();
    for slot in &c.slots[body] {
        let stands = slot.content.angle().map(|_| c.bodies[body].carrier(0));
        let point = stands.or(slot.point);
        let point = point.map(|point| PointRef { body, point });
        points.extend(point.filter(|point| !points.contains(point)));
    }
    points
}

/// The point that takes the forces at a point.
fn attachment(model: &Model, point: PointRef) -> PointRef {
    let PointRef { body, point } = point;
    let point = model.bodies()[body].placed.kind.carrier(point);
    PointRef { body, point }
}

/// The shares of a term with these coordinates in those of a point, one for each group of consecutive coordinates. A body may occur
/// twice in a term, with a point and with its direction; the direction of a rigid body is theta alone.
fn runs(
    source: Source,
    coordinates: &[usize],
    point: &[Option<usize>],
    counts: impl Fn(usize) -> bool,
) -> Vec<Share> {
    let mut shares: Vec<Share> = Vec::new();
    for (local, &i) in coordinates.iter().enumerate() {
        let place = point.iter().position(|x| *x == Some(i));
        let Some(place) = place.filter(|_| counts(local)) else {
            continue;
        };
        match shares.last_mut() {
            Some(run) if run.local + run.count == local && run.place + run.count == place => {
                run.count += 1;
            }
            _ => shares.push(Share {
                source,
                local,
                place,
                count: 1,
            }),
        }
    }
    shares
}

/// The force of all terms that belong to `point`: its body's own, and those of joints attached there.
fn grip(c: &Compiler, model: &Model, own: &[JointTerms], point: PointRef) -> Option<Grip> {
    let coordinates = place(model, point)?;
    // a joint exerts nothing on the coordinate that it leaves to the body that it holds
    let is_held = model.bodies()[point.body].placed.kind.hold().is_some();
    let taken = coordinates.iter().map(|&x| {
        let is_left = is_held && x < model.shape.unknowns;
        (!is_left).then_some(x)
    });
    let taken: Vec<Option<usize>> = taken.collect();
    let mut shares = Vec::new();
    let mut add = |source: Source, coordinates: &[usize], owners: Option<&[usize]>| {
        let counts = |local: usize| owners.is_none_or(|owners| owners[local] == point.body);
        shares.extend(runs(source, coordinates, &taken, counts));
    };
    let body = &model.bodies()[point.body];
    for i in body.inertia.clone() {
        add(Source::Inertia(i), &model.mass.parts[i].coordinates, None);
    }
    for i in body.eccentric.clone() {
        let coordinates = &model.eccentric[i].mass.pose;
        add(Source::Eccentric(i), coordinates, None);
    }
    for i in body.elements.clone() {
        let coordinates = &model.elements[i].block.coordinates;
        add(Source::Element(i), coordinates, None);
    }
    for (i, c) in model.constraints.iter().enumerate() {
        add(Source::Constraint(i), &c.block.coordinates, Some(&c.owners));
    }
    for (i, f) in model.forces.iter().enumerate() {
        add(Source::Force(i), &f.block.coordinates, Some(&f.owners));
    }
    for (joint, own) in c.scene.joints.iter().zip(own) {
        // the couple of a friction force on a rigid link acts on both ends
        if let ForceTerm::Contact(i) = own.force
            && joint.points().iter().any(|end| end.body == point.body)
        {
            let coordinates = &model.contacts[i].block.coordinates;
            add(Source::Contact(i), coordinates, None);
        }
    }
    Some(Grip {
        coordinates,
        shares,
    })
}

/// The points connected to `from` without joint `cut`, through eliminated joints and driven bodies. `None` if the ground or a
/// body on a path is connected to it.
fn hanging(
    c: &Compiler,
    model: &Model,
    own: &[JointTerms],
    cut: usize,
    from: PointRef,
) -> Option<Vec<PointRef>> {
    let mut found = vec![attachment(model, from)];
    let mut next = 0;
    while next < found.len() {
        let point = found[next];
        next += 1;
        if matches!(c.roles[point.body], Role::Ground | Role::Path) {
            return None;
        }
        let mut reached = Vec::new();
        if matches!(c.roles[point.body], Role::Driven | Role::Turned(_)) {
            reached.extend(attachments(c, model, point.body));
        }
        for (j, joint) in c.scene.joints.iter().enumerate() {
            if j != cut && matches!(own[j].force, ForceTerm::Eliminated) {
                let ends = [joint.bearing, joint.journal].map(|p| attachment(model, p));
                for (near, far) in [(0, 1), (1, 0)] {
                    if ends[near] == point {
                        reached.push(ends[far]);
                    }
                }
            }
        }
        for point in reached {
            if !found.contains(&point) {
                found.push(point);
            }
        }
    }
    Some(found)
}

/// Joint `j` with its force and, where a drive acts on it, its torque.
pub(super) fn joint(
    c: &Compiler,
    model: &Model,
    own: &[JointTerms],
    j: usize,
) -> Result<PlacedJoint, SceneError> {
    let joint = &c.scene.joints[j];
    let mut placed = PlacedJoint {
        name: joint.name.clone(),
        terms: own[j],
        reaction: None,
        actuator: None,
    };
    if !matches!(own[j].force, ForceTerm::Eliminated) {
        return Ok(placed);
    }
    let side = |point, sign| Some((hanging(c, model, own, j, point)?, sign));
    let Some((points, sign)) = side(joint.journal, 1.0).or_else(|| side(joint.bearing, -1.0))
    else {
        let message = format!(
            "the reaction force of joint {} is undetermined, because its bodies are held by other joints as well",
            joint.name
        );
        return Err(c.joint_error(j, message, "redundant joint"));
    };
    let points = points.into_iter();
    let outboard: Vec<Grip> = points.filter_map(|p| grip(c, model, own, p)).collect();
    let shares = outboard.iter().flat_map(|grip| &grip.shares);
    let shares = shares.copied().collect();
    placed.reaction = Some(Reaction { shares, sign });
    if is_actuated(c, j) {
        placed.actuator = Some(Actuator {
            bodies: [joint.bearing.body, joint.journal.body],
            centre: model.bodies()[joint.bearing.body]
                .placed
                .marker(joint.bearing.point),
            outboard,
            sign,
        });
    }
    Ok(placed)
}

/// True of a joint that inverse kinematics or a prescribed angle moves.
fn is_actuated(c: &Compiler, j: usize) -> bool {
    let turned = |m: usize| match c.scene.motions[m].kind {
        MotionKind::Angle { joint, .. } => joint == j,
        MotionKind::Point { .. } => false,
    };
    let mut roles = c.roles.iter();
    c.scene.drives.iter().any(|drive| drive.joints.contains(&j))
        || roles.any(|role| matches!(role, Role::Turned(m) if turned(*m)))
}

/// What acts on all known points that can move: those of driven bodies, and the nodes fixed to them.
pub(super) fn driven(
    c: &Compiler,
    model: &Model,
    kinematics: Option<&Kinematics>,
    own: &[JointTerms],
) -> Vec<Grip> {
    let mut resting: HashSet<usize> = model.fixed.iter().map(|&(x, _)| x).collect();
    if let Some(kinematics) = kinematics {
        let inner = kinematics.mechanism.fixed.iter();
        resting.extend(inner.map(|&(x, _)| x + kinematics.offset));
    }
    let mut grips: Vec<Grip> = Vec::new();
    let bodies = 0..c.scene.bodies.len();
    for point in bodies.flat_map(|b| attachments(c, model, b)) {
        let known = |x: usize| x >= model.shape.unknowns && !resting.contains(&x);
        if !place(model, point).is_some_and(|x| known(x[0])) {
            continue;
        }
        let Some(grip) = grip(c, model, own, point) else {
            continue;
        };
        match grips
            .iter_mut()
            .find(|other| other.position() == grip.position())
        {
            Some(other) => other.shares.extend(grip.shares),
            None => grips.push(grip),
        }
    }
    grips
}
