//! Initial guess of the assembly: given poses, sketched joints, and the bodies connected to them.

use super::super::sketch::fit;
use super::super::{Compiler, Role};
use crate::math::plane::{add, rotate, sub};
use crate::model::{BodyCoordinates, Model};
use crate::scene::{BodyKind, JointModel, MotionKind, PointRef, SceneError, Sketched};
use crate::system::State;

/// The bodies that have been placed, and their coordinates.
struct Placed<'a> {
    c: &'a Compiler<'a>,
    mechanism: &'a Model,
    done: Vec<bool>,
    /// Coordinates of given poses.
    held: Vec<bool>,
}

impl Placed<'_> {
    fn position(&self, point: PointRef, state: &State) -> [f64; 2] {
        let coordinates = &self.mechanism.bodies()[point.body].coordinates;
        let marker = self.c.marker(coordinates, point);
        self.mechanism.position(&marker, state)
    }

    /// Position of a point, if a placed body joined to it, the sketch or a drive gives it.
    fn known(&self, point: PointRef, state: &State) -> Option<[f64; 2]> {
        if self.done[point.body] {
            return Some(self.position(point, state));
        }
        let met = self.met(point, state);
        let drawn = met.or_else(|| self.c.drawn(Sketched::Point(point)));
        let [x, y] = self.driven(point);
        match (drawn, x, y) {
            (_, Some(x), Some(y)) => Some([x, y]),
            (Some(at), ..) => Some([x.unwrap_or(at[0]), y.unwrap_or(at[1])]),
            (None, ..) => None,
        }
    }

    /// Coordinates of a point that drives prescribe at t = 0.
    fn driven(&self, point: PointRef) -> [Option<f64>; 2] {
        let mut driven = [None; 2];
        for motion in &self.c.scene.motions {
            if let MotionKind::Point {
                point: moved,
                coordinates,
            } = &motion.kind
                && *moved == point
            {
                for (known, f) in driven.iter_mut().zip(coordinates) {
                    *known = f.as_ref().map(|f| f.at(0.0)[0]).or(*known);
                }
            }
        }
        driven
    }

    /// Position of a point that a joint connects to a placed body, or whose joint is sketched.
    fn met(&self, point: PointRef, state: &State) -> Option<[f64; 2]> {
        let mut joints = self.c.scene.joints.iter().enumerate();
        let prismatic =
            |j: usize| matches!(self.c.scene.joints[j].model, JointModel::Prismatic { .. });
        joints.find_map(|(j, joint)| {
            let partner = match () {
                () if joint.bearing == point => joint.journal,
                () if joint.journal == point => joint.bearing,
                () => return None,
            };
            let partner =
                (self.done[partner.body] && !prismatic(j)).then(|| self.position(partner, state));
            partner.or_else(|| self.c.drawn(Sketched::Joint(j)))
        })
    }

    /// Places body `b` if two of its points are known, or its only one.
    fn place(&mut self, b: usize, state: &mut State) {
        let known = |local: usize, at: [f64; 2]| {
            self.known(
                PointRef {
                    body: b,
                    point: local,
                },
                state,
            )
            .map(|r| (at, r))
        };
        match (
            &self.mechanism.bodies()[b].coordinates,
            &self.c.scene.bodies[b].kind,
        ) {
            (BodyCoordinates::Rigid { x }, BodyKind::Rigid(rigid)) => {
                let points = rigid.points.iter().enumerate();
                let pairs: Vec<_> = points.filter_map(|(i, p)| known(i, p.at)).collect();
                let apart = pairs.iter().any(|p| p.0 != pairs[0].0);
                if apart {
                    state.q[*x..x + 3].copy_from_slice(&fit(&pairs));
                    self.done[b] = true;
                }
            }
            (BodyCoordinates::PointMass { x }, _) => {
                if let Some((_, at)) = known(0, [0.0; 2]) {
                    state.q[*x..x + 2].copy_from_slice(&at);
                    self.done[b] = true;
                }
            }
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
                let count = 2 + link.points.len();
                let pairs: Vec<_> = (0..count)
                    .filter_map(|i| known(i, [link.share(i) * link.length, 0.0]))
                    .collect();
                let apart = pairs.iter().any(|p| p.0 != pairs[0].0);
                if apart {
                    let pose = fit(&pairs);
                    self.write_link(*ends, link.length, pose, state);
                    self.done[b] = true;
                }
            }
            _ => {}
        }
    }

    /// Places a body with one known point at the angle that follows from its joints with placed bodies: from a weld, a locked
    /// guide or a drive, or from the direction of a slot towards its pin. False if there is no such joint.
    fn place_at_point(&mut self, b: usize, state: &mut State) -> bool {
        let points: Vec<[f64; 2]> = match &self.c.scene.bodies[b].kind {
            _ if self.done[b] => return false,
            BodyKind::Rigid(rigid) => rigid.points.iter().map(|p| p.at).collect(),
            BodyKind::Link(link) => {
                let places = (0..2 + link.points.len()).map(|i| link.share(i) * link.length);
                places.map(|x| [x, 0.0]).collect()
            }
            _ => return false,
        };
        let known = |point| self.known(PointRef { body: b, point }, state);
        let mut known = points.iter().enumerate().map(|(i, p)| Some((p, known(i)?)));
        let Some((local, at)) = known.find_map(|known| known) else {
            return false;
        };
        let Some(angle) = self.suggested_angle(b, at, state) else {
            return false;
        };
        let arm = rotate(angle.cos(), angle.sin(), *local);
        let pose = [at[0] - arm[0], at[1] - arm[1], angle];
        match (
            &self.mechanism.bodies()[b].coordinates,
            &self.c.scene.bodies[b].kind,
        ) {
            (BodyCoordinates::Rigid { x }, _) => state.q[*x..x + 3].copy_from_slice(&pose),
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
                self.write_link(*ends, link.length, pose, state);
            }
            _ => return false,
        }
        self.done[b] = true;
        true
    }

    fn suggested_angle(&self, b: usize, at: [f64; 2], state: &State) -> Option<f64> {
        let direction = |body: usize| match &self.mechanism.bodies()[body].coordinates {
            BodyCoordinates::Rigid { x } => state.q[x + 2],
            BodyCoordinates::RigidLink { ends: [i, j] } => {
                (state.q[j + 1] - state.q[i + 1]).atan2(state.q[*j] - state.q[*i])
            }
            _ => 0.0,
        };
        let driven = |j: usize| {
            self.c.scene.motions.iter().find_map(|m| match &m.kind {
                MotionKind::Angle { joint, angle } if *joint == j => Some(angle.at(0.0)[0]),
                _ => None,
            })
        };
        self.c
            .scene
            .joints
            .iter()
            .enumerate()
            .find_map(|(j, joint)| {
                let (first, second) = (joint.bearing.body, joint.journal.body);
                let angle = match joint.model {
                    JointModel::Weld { angle, .. } => Some(angle),
                    JointModel::Prismatic { locked, .. } => locked,
                    JointModel::Ideal | JointModel::Clearance(_) => driven(j),
                };
                match (angle, joint.model.clone()) {
                    (Some(angle), _) if second == b && self.done[first] => {
                        Some(direction(first) + angle)
                    }
                    (Some(angle), _) if first == b && self.done[second] => {
                        Some(direction(second) - angle)
                    }
                    (None, JointModel::Prismatic { direction, .. })
                        if first == b && self.done[second] =>
                    {
                        let to_pin = sub(self.position(joint.journal, state), at);
                        Some(to_pin[1].atan2(to_pin[0]) - direction)
                    }
                    _ => None,
                }
            })
    }

    /// Sets those ends of a link that are unknown and not fixed by a given pose.
    fn write_link(&self, ends: [usize; 2], length: f64, pose: [f64; 3], state: &mut State) {
        let n = self.mechanism.shape().unknowns;
        let along = [length * pose[2].cos(), length * pose[2].sin()];
        let points = [[pose[0], pose[1]], add([pose[0], pose[1]], along)];
        for (x, at) in ends.into_iter().zip(points) {
            if x < n && !self.held[x] {
                state.q[x..x + 2].copy_from_slice(&at);
            }
        }
    }
}

/// The unknown coordinates of a body.
pub(super) fn coordinates(mechanism: &Model, body: usize) -> Vec<usize> {
    let all: Vec<usize> = match &mechanism.bodies()[body].coordinates {
        BodyCoordinates::Rigid { x } => (*x..x + 3).collect(),
        BodyCoordinates::PointMass { x } => (*x..x + 2).collect(),
        BodyCoordinates::RigidLink { ends } => ends.iter().flat_map(|&x| [x, x + 1]).collect(),
        _ => Vec::new(),
    };
    let n = mechanism.shape().unknowns;
    all.into_iter().filter(|&i| i < n).collect()
}

/// Places all bodies from the given states, the sketch and the joints; returns the coordinates of given poses.
pub(super) fn guess(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
) -> Result<Vec<bool>, SceneError> {
    let n = mechanism.shape().unknowns;
    let mut placed = Placed {
        c,
        mechanism,
        done: c.roles.iter().map(|r| *r != Role::Free).collect(),
        held: vec![false; n],
    };
    for given in &c.scene.initial.bodies {
        let body = &c.scene.bodies[given.body];
        match (&mechanism.bodies()[given.body].coordinates, &body.kind) {
            (BodyCoordinates::Rigid { x }, _) => {
                state.q[*x..x + 3].copy_from_slice(&given.position);
            }
            (BodyCoordinates::PointMass { x }, _) => {
                state.q[*x..x + 2].copy_from_slice(&given.position[..2]);
            }
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
                let [x, y] = link.start(given)[0];
                placed.write_link(*ends, link.length, [x, y, given.position[2]], state);
            }
            _ => {}
        }
        for i in coordinates(mechanism, given.body) {
            placed.held[i] = true;
        }
        placed.done[given.body] = true;
    }
    loop {
        let before = placed.done.iter().filter(|d| **d).count();
        for b in 0..c.scene.bodies.len() {
            if !placed.done[b] {
                placed.place(b, state);
            }
        }
        let stuck = placed.done.iter().filter(|d| **d).count() == before;
        // only one body at a time is placed by a single point, so that its neighbours can be placed exactly
        if stuck && !(0..c.scene.bodies.len()).any(|b| placed.place_at_point(b, state)) {
            break;
        }
    }
    match placed.done.iter().position(|d| !d) {
        None => Ok(placed.held),
        Some(b) => {
            let body = &c.scene.bodies[b];
            let message = format!("the scene does not say where {} starts", body.name);
            let error = c.scene.error(body.span, message, "this body");
            Err(error.with_help(
                "give its pose in `[initial.bodies]`, or the approximate positions of two of its joints or points in \
                 `[initial.sketch]`",
            ))
        }
    }
}
