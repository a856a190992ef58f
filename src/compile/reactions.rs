//! The terms whose sum is the force of an eliminated joint or the torque of an actuated one.

use super::{Compiler, Role};
use crate::body::PointRef;
use crate::kinematics::Kinematics;
use crate::model::{Actuator, Grip, Model, PlacedJoint, Reaction, Share, Source};
use crate::scene::{MotionKind, SceneError};
use crate::terms::{ForceTerm, JointTerms};
use indexmap::IndexMap;
use indexmap::map::Entry;
use std::collections::{HashMap, HashSet};

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

/// What joints, constraints and forces have to do with every body.
pub(super) struct Reactions<'a> {
    c: &'a Compiler<'a>,
    model: &'a Model,
    own: &'a [JointTerms],
    /// The constraints, forces and contacts of every body.
    acting: Vec<Vec<Source>>,
    /// The eliminated joints at every point that takes forces, each with such a point on its other side.
    eliminated: HashMap<PointRef, Vec<(usize, PointRef)>>,
    /// The joints that inverse kinematics or a prescribed angle moves.
    actuated: HashSet<usize>,
}

impl<'a> Reactions<'a> {
    /// Of a model without joints, and the terms of each joint.
    pub fn new(c: &'a Compiler, model: &'a Model, own: &'a [JointTerms]) -> Reactions<'a> {
        let mut acting = vec![Vec::new(); model.bodies().len()];
        let mut act = |source: Source, bodies: &[usize]| {
            for &body in bodies {
                let sources: &mut Vec<Source> = &mut acting[body];
                if sources.last() != Some(&source) {
                    sources.push(source);
                }
            }
        };
        for (i, c) in model.constraints.iter().enumerate() {
            act(Source::Constraint(i), &c.owners);
        }
        for (i, f) in model.forces.iter().enumerate() {
            act(Source::Force(i), &f.owners);
        }
        let mut eliminated: HashMap<PointRef, Vec<(usize, PointRef)>> = HashMap::new();
        for (j, (joint, own)) in c.scene.joints.iter().zip(own).enumerate() {
            match own.force {
                ForceTerm::Contact(i) => {
                    act(Source::Contact(i), &joint.points().map(|end| end.body));
                }
                ForceTerm::Eliminated => {
                    let [bearing, journal] = joint.points().map(|p| attachment(model, p));
                    eliminated.entry(bearing).or_default().push((j, journal));
                    eliminated.entry(journal).or_default().push((j, bearing));
                }
                _ => {}
            }
        }
        let motions = c.roles.iter().filter_map(Role::turned);
        let turning = motions.filter_map(|m| match c.scene.motions[m].kind {
            MotionKind::Angle { joint, .. } => Some(joint),
            MotionKind::Point { .. } => None,
        });
        let followed = c.scene.drives.iter().flat_map(|drive| &drive.joints);
        Reactions {
            c,
            model,
            own,
            acting,
            eliminated,
            actuated: followed.copied().chain(turning).collect(),
        }
    }

    /// The coordinates of a term, and the body of each where a term has several. The couple of a friction force on a rigid link acts
    /// on both of its ends, so the coordinates of a contact belong to both bodies.
    fn coordinates(&self, source: Source) -> (&[usize], Option<&[usize]>) {
        let model = self.model;
        match source {
            Source::Inertia(i) => (&model.mass.parts[i].coordinates, None),
            Source::Eccentric(i) => (&model.eccentric[i].mass.pose, None),
            Source::Element(i) => (&model.elements[i].block.coordinates, None),
            Source::Constraint(i) => {
                let placed = &model.constraints[i];
                (&placed.block.coordinates, Some(&placed.owners))
            }
            Source::Force(i) => {
                let placed = &model.forces[i];
                (&placed.block.coordinates, Some(&placed.owners))
            }
            Source::Contact(i) => (&model.contacts[i].block.coordinates, None),
        }
    }

    /// The force of all terms that belong to `point`: its body's own, and those of joints attached there.
    fn grip(&self, point: PointRef) -> Option<Grip> {
        let model = self.model;
        let coordinates = place(model, point)?;
        let body = &model.bodies()[point.body];
        // a joint exerts nothing on the coordinate that it leaves to the body that it holds
        let is_held = body.placed.kind.hold().is_some();
        let taken = coordinates.iter().map(|&x| {
            let is_left = is_held && x < model.shape.unknowns;
            (!is_left).then_some(x)
        });
        let taken: Vec<Option<usize>> = taken.collect();
        let own = body.inertia.clone().map(Source::Inertia);
        let own = own.chain(body.eccentric.clone().map(Source::Eccentric));
        let own = own.chain(body.elements.clone().map(Source::Element));
        let sources = own.chain(self.acting[point.body].iter().copied());
        let shares = sources.flat_map(|source| {
            let (coordinates, owners) = self.coordinates(source);
            let counts = |local: usize| owners.is_none_or(|owners| owners[local] == point.body);
            runs(source, coordinates, &taken, counts)
        });
        let shares = shares.collect();
        Some(Grip {
            coordinates,
            shares,
        })
    }

    /// The points connected to `from` without joint `cut`, through eliminated joints and driven bodies. `None` if the ground or a
    /// body on a path is connected to it.
    fn hanging(&self, cut: usize, from: PointRef) -> Option<Vec<PointRef>> {
        let from = attachment(self.model, from);
        let (mut points, mut found) = (vec![from], HashSet::from([from]));
        let mut next = 0;
        while let Some(&point) = points.get(next) {
            next += 1;
            let of_body = match self.c.roles[point.body] {
                Role::Ground | Role::Path => return None,
                Role::Driven | Role::Turned(_) => attachments(self.c, self.model, point.body),
                Role::Free => Vec::new(),
            };
            let joined = self.eliminated.get(&point).into_iter().flatten();
            let joined = joined.filter(|(j, _)| *j != cut).map(|(_, far)| *far);
            points.extend(
                of_body
                    .into_iter()
                    .chain(joined)
                    .filter(|p| found.insert(*p)),
            );
        }
        Some(points)
    }

    /// Joint `j` with its force and, where a drive acts on it, its torque.
    ///
    /// # Errors
    /// Its force is undetermined.
    pub fn joint(&self, j: usize) -> Result<PlacedJoint, SceneError> {
        let joint = &self.c.scene.joints[j];
        let mut placed = PlacedJoint {
            name: joint.name.clone(),
            terms: self.own[j],
            states: Vec::new(),
            reaction: None,
            actuator: None,
        };
        if !matches!(placed.terms.force, ForceTerm::Eliminated) {
            return Ok(placed);
        }
        let side = |point, sign| Some((self.hanging(j, point)?, sign));
        let Some((points, sign)) = side(joint.journal, 1.0).or_else(|| side(joint.bearing, -1.0))
        else {
            let message = format!(
                "the reaction force of joint {} is undetermined, because its bodies are held by other joints as well",
                joint.name
            );
            return Err(self.c.joint_error(j, message, "redundant joint"));
        };
        let outboard: Vec<Grip> = points.into_iter().filter_map(|p| self.grip(p)).collect();
        let shares = outboard.iter().flat_map(|grip| &grip.shares);
        let shares = shares.copied().collect();
        placed.reaction = Some(Reaction { shares, sign });
        if self.actuated.contains(&j) {
            placed.actuator = Some(Actuator {
                bodies: [joint.bearing.body, joint.journal.body],
                centre: self.model.bodies()[joint.bearing.body]
                    .placed
                    .marker(joint.bearing.point),
                outboard,
                sign,
            });
        }
        Ok(placed)
    }

    /// What acts on all known points that can move: those of driven bodies, and the nodes fixed to them.
    pub fn driven(&self, kinematics: Option<&Kinematics>) -> Vec<Grip> {
        let Reactions { c, model, .. } = *self;
        let mut resting: HashSet<usize> = model.fixed.iter().map(|&(x, _)| x).collect();
        if let Some(kinematics) = kinematics {
            let inner = kinematics.mechanism.fixed.iter();
            resting.extend(inner.map(|&(x, _)| x + kinematics.offset));
        }
        let mut grips: IndexMap<[usize; 2], Grip> = IndexMap::new();
        let bodies = 0..c.scene.bodies.len();
        for point in bodies.flat_map(|b| attachments(c, model, b)) {
            let known = |x: usize| x >= model.shape.unknowns && !resting.contains(&x);
            if !place(model, point).is_some_and(|x| known(x[0])) {
                continue;
            }
            let Some(grip) = self.grip(point) else {
                continue;
            };
            match grips.entry(grip.position()) {
                Entry::Occupied(mut other) => other.get_mut().shares.extend(grip.shares),
                Entry::Vacant(place) => {
                    place.insert(grip);
                }
            }
        }
        grips.into_values().collect()
    }
}
