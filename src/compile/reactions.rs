//! The terms whose sum is the force of an eliminated joint or the torque of an actuated one.

use super::{Compiler, Role};
use crate::body::{Content, PointRef};
use crate::kinematics::Kinematics;
use crate::model::{Actuator, DrivenForce, ForceCarrier, Model, Reaction, Share, Source};
use crate::scene::{MotionKind, SceneError};
use crate::terms::{ForceTerm, JointTerms};

/// First coordinate of the slot that carries a point, and the number of coordinates there.
fn place(model: &Model, point: PointRef) -> Option<(usize, usize)> {
    let body = &model.bodies()[point.body];
    let slot = body.placed.kind.slot_of(point.point);
    let width = || body.contents[slot].names().len();
    body.moves.then(|| (body.placed.x[slot], width()))
}

/// Attachment points of a body: those whose nodes joints can share, or one point that represents all points of a rigid body.
fn attachments(c: &Compiler, model: &Model, body: usize) -> Vec<PointRef> {
    if !model.bodies()[body].moves {
        return Vec::new();
    }
    let slots = c.slots[body].iter();
    let points = slots.filter_map(|slot| match slot.content {
        Content::Pose => Some(0),
        _ => slot.point,
    });
    points.map(|point| PointRef { body, point }).collect()
}

/// The attachment point that represents a point.
fn attachment(model: &Model, point: PointRef) -> PointRef {
    let PointRef { body, point } = point;
    let placed = &model.bodies()[body];
    let point = match placed.contents.get(placed.placed.kind.slot_of(point)) {
        Some(Content::Pose) => 0,
        _ => point,
    };
    PointRef { body, point }
}

/// The shares of a term in the coordinates x .. x + width, one for each group of consecutive coordinates. A body may occur
/// twice in a term, with a point and with its direction; the direction of a rigid body is theta alone.
fn runs(
    source: Source,
    coordinates: &[usize],
    x: usize,
    width: usize,
    counts: impl Fn(usize) -> bool,
) -> Vec<Share> {
    let mut shares: Vec<Share> = Vec::new();
    for (local, &i) in coordinates.iter().enumerate() {
        if !(x..x + width).contains(&i) || !counts(local) {
            continue;
        }
        let place = i - x;
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

/// The shares of all terms that belong to `point`: its body's own, and those of joints attached there.
fn shares_of(c: &Compiler, model: &Model, own: &[JointTerms], point: PointRef) -> Vec<Share> {
    let Some((x, width)) = place(model, point) else {
        return Vec::new();
    };
    let mut shares = Vec::new();
    let mut add = |source: Source, coordinates: &[usize]| {
        shares.extend(runs(source, coordinates, x, width, |_| true));
    };
    let body = &model.bodies()[point.body];
    for i in body.inertia.clone() {
        add(Source::Inertia(i), &model.mass.parts[i].coordinates);
    }
    for i in body.elements.clone() {
        add(Source::Element(i), &model.elements[i].block.coordinates);
    }
    let mut add_owned = |source: Source, coordinates: &[usize], owners: &[usize]| {
        let own = |local: usize| owners[local] == point.body;
        shares.extend(runs(source, coordinates, x, width, own));
    };
    for (i, placed) in model.constraints.iter().enumerate() {
        add_owned(
            Source::Constraint(i),
            &placed.block.coordinates,
            &placed.owners,
        );
    }
    for (i, acting) in model.forces.iter().enumerate() {
        add_owned(Source::Force(i), &acting.block.coordinates, &acting.owners);
    }
    let mut add = |source: Source, coordinates: &[usize]| {
        shares.extend(runs(source, coordinates, x, width, |_| true));
    };
    for (joint, own) in c.scene.joints.iter().zip(own) {
        // the couple of a friction force on a rigid link acts on both ends
        let ends = [joint.bearing, joint.journal].map(|p| attachment(model, p));
        if let ForceTerm::Contact(i) = own.force
            && ends.iter().any(|end| end.body == point.body)
        {
            add(Source::Contact(i), &model.contacts[i].block.coordinates);
        }
    }
    shares
}

/// The points connected to `from` without joint `cut`, through eliminated joints and driven bodies. `None` if the ground is
/// connected to it.
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
        if c.roles[point.body] == Role::Ground {
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

/// Force and, where a drive acts on it, torque of joint `j`.
pub(super) fn joint(
    c: &Compiler,
    model: &Model,
    own: &[JointTerms],
    j: usize,
) -> Result<(ForceCarrier, Option<Actuator>), SceneError> {
    let kind = match own[j].force {
        ForceTerm::Constraint(i) => ForceCarrier::Constraint(i),
        ForceTerm::Contact(i) => ForceCarrier::Contact(i),
        ForceTerm::Eliminated => {
            let joint = &c.scene.joints[j];
            let journal_side = hanging(c, model, own, j, joint.journal).map(|side| (side, 1.0));
            let side = journal_side
                .or_else(|| hanging(c, model, own, j, joint.bearing).map(|side| (side, -1.0)));
            let Some((side, sign)) = side else {
                let message = format!(
                    "the reaction force of joint {} is undetermined, because its bodies are held by other joints as well",
                    joint.name
                );
                return Err(c.joint_error(j, message, "redundant joint"));
            };
            let mut all = Vec::new();
            let mut outboard = Vec::new();
            for &point in &side {
                let shares = shares_of(c, model, own, point);
                all.extend_from_slice(&shares);
                if let Some((x, width)) = place(model, point) {
                    outboard.push(DrivenForce {
                        x,
                        width,
                        reaction: Reaction { shares, sign: 1.0 },
                    });
                }
            }
            let turned = |m: &usize| match c.scene.motions[*m].kind {
                MotionKind::Angle { joint, .. } => joint == j,
                MotionKind::Point { .. } => false,
            };
            let actuated = c.scene.drives.iter().any(|d| d.joints.contains(&j))
                || c.roles
                    .iter()
                    .any(|r| matches!(r, Role::Turned(m) if turned(m)));
            let actuator = actuated.then(|| Actuator {
                bodies: [joint.bearing.body, joint.journal.body],
                centre: model.bodies()[joint.bearing.body]
                    .placed
                    .marker(joint.bearing.point),
                outboard,
                sign,
            });
            return Ok((
                ForceCarrier::Eliminated(Reaction { shares: all, sign }),
                actuator,
            ));
        }
    };
    Ok((kind, None))
}

/// Forces on all known coordinates that can move: those of driven bodies, and the nodes fixed to them.
pub(super) fn driven_forces(
    c: &Compiler,
    model: &Model,
    kinematics: Option<&Kinematics>,
    own: &[JointTerms],
) -> Vec<DrivenForce> {
    let mut resting: Vec<usize> = model.fixed.iter().map(|&(x, _)| x).collect();
    if let Some(kinematics) = kinematics {
        let inner = kinematics.mechanism.fixed.iter();
        resting.extend(inner.map(|&(x, _)| x + kinematics.offset));
    }
    let mut forces: Vec<DrivenForce> = Vec::new();
    let all: Vec<PointRef> = (0..c.scene.bodies.len())
        .flat_map(|b| attachments(c, model, b))
        .collect();
    for &point in &all {
        let Some((x, width)) = place(model, point) else {
            continue;
        };
        let known = x >= model.shape.unknowns && !resting.contains(&x);
        if !known || forces.iter().any(|f| f.x == x) {
            continue;
        }
        let here = all
            .iter()
            .filter(|&&p| place(model, p).map(|(x, _)| x) == Some(x));
        let shares = here.flat_map(|&p| shares_of(c, model, own, p)).collect();
        forces.push(DrivenForce {
            x,
            width,
            reaction: Reaction { shares, sign: 1.0 },
        });
    }
    forces
}
