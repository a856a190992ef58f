//! Initial guess of the assembly: given poses, sketched joints, and the bodies connected to them.

use super::super::sketch::{PointPair, fit};
use super::super::{Compiler, Role};
use super::position;
use crate::body::{Frame, PointRef};
use crate::math::plane::{Rotation, Vec2};
use crate::model::Model;
use crate::motion::Function;
use crate::scene::{MotionKind, SceneError, Sketched};
use crate::system::State;
use std::collections::{BTreeSet, HashMap};

/// The bodies that have been placed, and their coordinates.
struct PartialAssembly<'a> {
    c: &'a Compiler<'a>,
    mechanism: &'a Model,
    done: Vec<bool>,
    /// Coordinates of given poses.
    held: Vec<bool>,
    /// The angles that drives prescribe in joints.
    angles: HashMap<usize, &'a Function>,
    /// The coordinates of points that drives prescribe at t = 0.
    driven: HashMap<PointRef, [Option<f64>; 2]>,
}

impl PartialAssembly<'_> {
    fn position(&self, point: PointRef, state: &State) -> Vec2 {
        position(self.mechanism, state, point)
    }

    /// The points of a body whose positions are known.
    fn known_points(&self, body: usize, state: &State) -> impl Iterator<Item = PointPair> {
        let points = self.c.bodies[body].points().iter().enumerate();
        points.filter_map(move |(point, p)| {
            let known = self.known(PointRef { body, point }, state)?;
            Some((p.at, known))
        })
    }

    /// Position of a point, if a placed body joined to it, the sketch or a drive gives it.
    fn known(&self, point: PointRef, state: &State) -> Option<Vec2> {
        if self.done[point.body] {
            return Some(self.position(point, state));
        }
        let met = self.met(point, state);
        let drawn = met.or_else(|| self.c.drawn(Sketched::Point(point)));
        let [x, y] = self.driven.get(&point).copied().unwrap_or_default();
        match (drawn, x, y) {
            (_, Some(x), Some(y)) => Some(Vec2::new(x, y)),
            (Some(at), ..) => Some(Vec2::new(x.unwrap_or(at.x), y.unwrap_or(at.y))),
            (None, ..) => None,
        }
    }

    /// Position of a point that a joint connects to a placed body, or whose joint is sketched.
    fn met(&self, point: PointRef, state: &State) -> Option<Vec2> {
        self.c.joints_at(point).iter().find_map(|&(j, partner)| {
            let partner = (self.done[partner.body] && self.c.joints[j].coincides())
                .then(|| self.position(partner, state));
            partner.or_else(|| self.c.drawn(Sketched::Joint(j)))
        })
    }

    /// Places all bodies that can be placed. A body is tried again when one that is joined to it has been placed.
    fn place_all(&mut self, state: &mut State) {
        let open = (0..self.done.len()).filter(|b| !self.done[*b]);
        let mut by_point: BTreeSet<usize> = open.collect();
        // in sweeps over the bodies, as (sweep, body)
        let mut queue: BTreeSet<(usize, usize)> = by_point.iter().map(|b| (0, *b)).collect();
        let mut sweep = 0;
        loop {
            // only one body at a time is placed by a single point, so that its neighbours can be placed exactly
            let (b, placed, same_sweep_from) = if let Some((now, b)) = queue.pop_first() {
                sweep = now;
                (b, self.place(b, state), b)
            } else if let Some(b) = by_point.pop_first() {
                (b, self.place_at_point(b, state), usize::MAX)
            } else {
                return;
            };
            if placed {
                for other in self.partners(b) {
                    by_point.insert(other);
                    queue.insert((sweep + usize::from(other < same_sweep_from), other));
                }
            }
        }
    }

    /// The bodies that joints connect to a body.
    fn partners(&self, body: usize) -> impl Iterator<Item = usize> {
        let points = 0..self.c.bodies[body].points().len();
        let joints = points.flat_map(move |point| self.c.joints_at(PointRef { body, point }));
        joints.map(|(_, partner)| partner.body)
    }

    /// Places body `b` if two of its points are known, or its only one. False if it is placed already or cannot be.
    fn place(&mut self, b: usize, state: &mut State) -> bool {
        if self.done[b] {
            return false;
        }
        let pairs: Vec<_> = self.known_points(b, state).collect();
        let pose = match self.c.bodies[b].turns() {
            true => {
                let apart = pairs.iter().any(|p| p.0 != pairs[0].0);
                apart.then(|| fit(&pairs))
            }
            false => pairs.first().map(|(_, r)| r.push(0.0).into()),
        };
        if let Some(pose) = pose {
            self.write(b, pose, state);
        }
        pose.is_some()
    }

    /// Places a body with one known point at the angle that follows from its joints with placed bodies: from a weld, a locked
    /// guide or a drive, or from the direction of a slot towards its pin. False if there is no such joint.
    fn place_at_point(&mut self, b: usize, state: &mut State) -> bool {
        if self.done[b] || !self.c.bodies[b].turns() {
            return false;
        }
        let Some((local, at)) = self.known_points(b, state).next() else {
            return false;
        };
        let Some(angle) = self.suggested_angle(b, at, state) else {
            return false;
        };
        let origin = at - Rotation::new(angle) * local;
        self.write(b, origin.push(angle).into(), state);
        true
    }

    fn suggested_angle(&self, b: usize, at: Vec2, state: &State) -> Option<f64> {
        let direction = |body: usize| {
            let placed = &self.mechanism.bodies()[body].placed;
            let frame = placed.kind.frame_at(&placed.x, &state.q, &state.v);
            frame.map_or(0.0, |frame| frame.position[2])
        };
        let points = 0..self.c.bodies[b].points().len();
        let points = points.map(|point| PointRef { body: b, point });
        let joints = points.flat_map(|point| self.c.joints_at(point));
        let joints: BTreeSet<usize> = joints.map(|&(j, _)| j).collect();
        joints.into_iter().find_map(|j| {
            let joint = &self.c.scene.joints[j];
            let (first, second) = (joint.bearing.body, joint.journal.body);
            let model = &self.c.joints[j];
            let driven = || self.angles.get(&j).filter(|_| model.is_revolute());
            let angle = model.angle().or_else(|| Some(driven()?.at(0.0)[0]));
            match (angle, model.line()) {
                (Some(angle), _) if second == b && self.done[first] => {
                    Some(direction(first) + angle)
                }
                (Some(angle), _) if first == b && self.done[second] => {
                    Some(direction(second) - angle)
                }
                (None, Some(direction)) if first == b && self.done[second] => {
                    let to_pin = self.position(joint.journal, state) - at;
                    Some(to_pin.y.atan2(to_pin.x) - direction)
                }
                _ => None,
            }
        })
    }

    /// Places a body: puts its frame into those of its coordinates that are unknown and not fixed by a given pose.
    fn write(&mut self, b: usize, position: [f64; 3], state: &mut State) {
        self.done[b] = true;
        let frame = Frame {
            position,
            velocity: [0.0; 3],
        };
        let placed = &self.mechanism.bodies()[b];
        let values = placed.placed.kind.place(&frame);
        for ((x, [value, _]), content) in placed.placed.x.iter().zip(values).zip(&placed.contents) {
            for (i, value) in value.iter().enumerate().take(content.names().len()) {
                if x + i < self.held.len() && !self.held[x + i] {
                    state.q[x + i] = *value;
                }
            }
        }
    }
}

/// The unknown coordinates of a body.
pub(super) fn coordinates(mechanism: &Model, body: usize) -> Vec<usize> {
    let all = mechanism.bodies()[body].coordinates();
    let n = mechanism.shape().unknowns;
    all.filter(|&i| i < n).collect()
}

/// Places all bodies from the given states, the sketch and the joints; returns the coordinates of given poses.
pub(super) fn guess(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
) -> Result<Vec<bool>, SceneError> {
    let n = mechanism.shape().unknowns;
    let mut driven: HashMap<PointRef, [Option<f64>; 2]> = HashMap::new();
    for motion in &c.scene.motions {
        if let MotionKind::Point { point, coordinates } = &motion.kind {
            let known = driven.entry(*point).or_default();
            for (known, f) in known.iter_mut().zip(coordinates) {
                *known = f.as_ref().map(|f| f.at(0.0)[0]).or(*known);
            }
        }
    }
    let mut assembly = PartialAssembly {
        c,
        mechanism,
        angles: c.scene.prescribed_angles(),
        driven,
        done: c.roles.iter().map(|r| *r != Role::Free).collect(),
        held: vec![false; n],
    };
    for given in c.scene.initial.bodies.values() {
        let frame = c.bodies[given.body].frame(given.position, given.velocity);
        assembly.write(given.body, frame.position, state);
        for i in coordinates(mechanism, given.body) {
            assembly.held[i] = true;
        }
    }
    assembly.place_all(state);
    match assembly.done.iter().position(|d| !d) {
        None => Ok(assembly.held),
        Some(b) => {
            let body = &c.scene.bodies[b];
            let message = format!("the scene does not say where {} starts", body.name);
            let mut error = c.scene.error(body.span, message, "this body");
            let joints = c.scene.joints.iter();
            let held = joints.filter(|j| j.points().iter().any(|p| p.body == b));
            if let [joint] = held.collect::<Vec<_>>()[..] {
                error = error.with_help(format!(
                    "only joint {} holds {}, which keeps degrees of freedom: is another joint missing?",
                    joint.name, body.name
                ));
            }
            Err(error.with_help(
                "give its pose in `[initial.bodies]`, or the approximate positions of two of its joints or points in \
                 `[initial.sketch]`",
            ))
        }
    }
}
