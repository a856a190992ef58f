//! Where the motion starts: poses of the ideal mechanism or of the scene, then consistent rates.

use crate::math::plane::{Vec2, add, norm, perp, scale, sub};
use crate::model::{BodyCoordinates, Model};
use crate::scene::{BodyKind, JointModel, Scene, SceneError};
use crate::system::State;

/// Largest distance by which a start may miss a constraint \[m\] or a rate \[m/s\]: the digits of a typed position.
const START_TOLERANCE: f64 = 1e-9;

/// Position and velocity of a body: of a rigid body (x, y, theta), of a link its `start` and its direction.
struct Start {
    position: [f64; 3],
    velocity: [f64; 3],
}

/// Writes coordinates and remembers which were written, so that two bodies that share a node must agree on it.
struct Writer<'a> {
    state: &'a mut State,
    unknowns: usize,
    written: Vec<bool>,
}

impl Writer<'_> {
    /// Sets a node; false where it is known or written already and differs.
    fn node(&mut self, x: usize, position: Vec2, velocity: Vec2) -> bool {
        if x >= self.unknowns || self.written[x] {
            let here = [self.state.q[x], self.state.q[x + 1]];
            let rate = [self.state.v[x], self.state.v[x + 1]];
            return norm(sub(here, position)) <= START_TOLERANCE
                && norm(sub(rate, velocity)) <= START_TOLERANCE;
        }
        self.set(x, position, velocity);
        true
    }

    fn set(&mut self, x: usize, position: Vec2, velocity: Vec2) {
        self.written[x] = true;
        self.state.q[x..x + 2].copy_from_slice(&position);
        self.state.v[x..x + 2].copy_from_slice(&velocity);
    }
}

/// The state at t = 0, accelerations and multipliers still to be found.
///
/// # Errors
/// A body without a start, or a start that violates a constraint.
pub fn start(scene: &Scene, model: &Model) -> Result<State, SceneError> {
    let mut state = model.blank_state();
    if let Some(kinematics) = &model.kinematics {
        let mut inner = kinematics.work();
        inner.state.q.copy_from_slice(&kinematics.start);
        let solved = kinematics.solve(&mut inner, 20);
        solved.map_err(|e| scene.error(scene.initial.span, e.to_string(), "the start"))?;
        let here = kinematics.offset..kinematics.offset + inner.state.q.len();
        state.q[here.clone()].copy_from_slice(&inner.state.q);
        state.v[here.clone()].copy_from_slice(&inner.state.v);
        state.a[here].copy_from_slice(&inner.state.a);
    }
    model.ride(&mut state);

    let unknowns = model.shape().unknowns;
    let mut writer = Writer {
        written: vec![false; state.q.len()],
        state: &mut state,
        unknowns,
    };
    for (b, body) in scene.bodies.iter().enumerate() {
        let free = match &model.bodies()[b].coordinates {
            BodyCoordinates::Ground { .. } => false,
            BodyCoordinates::Rigid { x } => *x < unknowns,
            BodyCoordinates::RigidLink { ends } => ends.iter().any(|&x| x < unknowns),
            BodyCoordinates::FlexibleLink { .. } => true,
        };
        let given = scene.initial.bodies.iter().find(|s| s.body == b);
        if !free {
            if let Some(given) = given {
                let message = format!(
                    "the motion of {} is prescribed; it cannot have a start of its own",
                    body.name
                );
                return Err(scene.error(given.span, message, "remove this"));
            }
            continue;
        }
        let start = match given {
            Some(given) => Start {
                position: given.position,
                velocity: given.velocity,
            },
            None => ideal_start(model, b, writer.state).ok_or_else(|| {
                let message = format!(
                    "the scene does not say where {} starts: give it in [initial] bodies",
                    body.name
                );
                scene.error(body.span, message, "this body")
            })?,
        };
        if !place(model, b, body_length(&body.kind), &start, &mut writer) {
            let span = given.map_or(body.span, |g| g.span);
            let message = format!(
                "the start of {} does not fit what its ends are joined to",
                body.name
            );
            return Err(scene.error(span, message, "this start violates a joint"));
        }
    }
    for j in 0..scene.joints.len() {
        let JointModel::Clearance(contact) = &scene.joints[j].model else {
            continue;
        };
        let delta = model
            .clearance(j, &state)
            .map_or(0.0, |(_, delta, _)| delta);
        if delta > contact.clearance {
            let message = format!(
                "joint {} starts {delta:.3e} m deep in the wall of its bearing, more than its clearance",
                scene.joints[j].name
            );
            return Err(scene.error(scene.joints[j].span, message, "this joint"));
        }
    }
    if let Some((distance, rate, name)) = model.worst_constraint(&state)
        && (distance > START_TOLERANCE || rate > START_TOLERANCE)
    {
        let message = format!("the start violates {name}: by {distance:.3e} m and {rate:.3e} m/s");
        return Err(scene.error(scene.initial.span, message, "this start"));
    }
    Ok(state)
}

fn body_length(kind: &BodyKind) -> f64 {
    match kind {
        BodyKind::Link(link) => link.length,
        _ => 0.0,
    }
}

/// Start of a body in the ideal mechanism, whose coordinates are in place.
fn ideal_start(model: &Model, b: usize, state: &State) -> Option<Start> {
    let kinematics = model.kinematics.as_ref()?;
    let at = |x: usize| {
        let x = x + kinematics.offset;
        ([state.q[x], state.q[x + 1]], [state.v[x], state.v[x + 1]])
    };
    match kinematics.mechanism.bodies()[b].coordinates {
        BodyCoordinates::Rigid { x } => {
            let x = x + kinematics.offset;
            let of = |level: &[f64]| [level[x], level[x + 1], level[x + 2]];
            Some(Start {
                position: of(&state.q),
                velocity: of(&state.v),
            })
        }
        BodyCoordinates::RigidLink { ends: [i, j] } => {
            let ((from, from_rate), (to, to_rate)) = (at(i), at(j));
            let (d, d_dot) = (sub(to, from), sub(to_rate, from_rate));
            let omega = crate::math::plane::cross(d, d_dot) / crate::math::plane::dot(d, d);
            Some(Start {
                position: [from[0], from[1], d[1].atan2(d[0])],
                velocity: [from_rate[0], from_rate[1], omega],
            })
        }
        _ => None,
    }
}

/// Writes the coordinates of body `b`, undeformed; false where it does not meet a known or written node.
fn place(model: &Model, b: usize, length: f64, start: &Start, writer: &mut Writer) -> bool {
    let [x0, y0, theta] = start.position;
    let [vx, vy, omega] = start.velocity;
    let direction = [theta.cos(), theta.sin()];
    let turning = scale(omega, perp(direction));
    let point = |s: f64| {
        (
            add([x0, y0], scale(s, direction)),
            add([vx, vy], scale(s, turning)),
        )
    };
    match &model.bodies()[b].coordinates {
        BodyCoordinates::Ground { .. } => true,
        BodyCoordinates::Rigid { x } => {
            writer.set(*x, [x0, y0], [vx, vy]);
            writer.state.q[x + 2] = theta;
            writer.state.v[x + 2] = omega;
            true
        }
        BodyCoordinates::RigidLink { ends } => {
            let ((p, v), (p1, v1)) = (point(0.0), point(length));
            writer.node(ends[0], p, v) & writer.node(ends[1], p1, v1)
        }
        BodyCoordinates::FlexibleLink { nodes, slopes, .. } => {
            let mut fits = true;
            for (k, (&node, &slope)) in nodes.iter().zip(slopes).enumerate() {
                let (p, v) = point(length * k as f64 / (nodes.len() - 1) as f64);
                fits &= writer.node(node, p, v);
                writer.set(slope, direction, turning);
            }
            fits
        }
    }
}
