//! Assembly of a mechanism that no inverse kinematics closes: positions from a sketch, velocities from a few of them.
//!
//! Everything is done on the ideal rigid mechanism. Positions: Newton's method with the step of least norm, from a guess
//! that the sketch and the given poses make. Velocities: those of least kinetic energy that satisfy the constraints and
//! what the scene gives.

use super::sketch::fit;
use super::{Compiler, Mode, Role, known_roles, numbering, terms};
use crate::math::dense::{Added, Equations};
use crate::math::plane::{add, cross, dot, norm, perp, rotate, scale, sub};
use crate::model::{BodyCoordinates, Model};
use crate::scene::{BodyKind, BodyState, JointModel, MotionKind, PointRef, Scene, SceneError};
use crate::system::{State, System};
use faer::Mat;

/// Largest opening of an assembled constraint \[m\]: far above rounding, far below anything measurable.
const CLOSED: f64 = 1e-12;
/// Steps of Newton's method.
const ITERATIONS: usize = 80;
/// A sketched joint may end this part of the shorter link away from where it was drawn.
const SKETCH: f64 = 0.25;
/// Largest difference of velocities that agree: the digits of typed numbers \[m/s, rad/s\].
const AGREEING: f64 = 1e-9;

/// The ideal mechanism of a scene and its state at t = 0.
pub(crate) struct Assembly {
    pub mechanism: Model,
    pub state: State,
}

/// Assembles the ideal mechanism of a scene.
///
/// # Errors
/// A body that nothing places, a mechanism that cannot close, velocities that contradict or repeat each other.
pub(crate) fn assemble(scene: &Scene) -> Result<Assembly, SceneError> {
    let c = Compiler {
        scene,
        mode: Mode::Ideal,
        roles: known_roles(scene),
    };
    let numbering = numbering::number(&c, None)?;
    let mechanism = terms::build(&c, numbering, None)?;
    let mut state = mechanism.blank_state();
    mechanism.follow_rules(&mut state);
    mechanism.ride(&mut state);
    let held = guess(&c, &mechanism, &mut state)?;
    close(&c, &mechanism, &mut state, &held)?;
    check_sketch(&c, &mechanism, &state)?;
    velocities(&c, &mechanism, &mut state)?;
    Ok(Assembly { mechanism, state })
}

/// Which bodies have a place, and where their points are.
struct Placed<'a> {
    c: &'a Compiler<'a>,
    mechanism: &'a Model,
    done: Vec<bool>,
}

impl Placed<'_> {
    fn position(&self, point: PointRef, state: &State) -> [f64; 2] {
        let coordinates = &self.mechanism.bodies()[point.body].coordinates;
        let marker = self.c.marker(coordinates, point);
        self.mechanism.position(&marker, state)
    }

    /// Where a point is, as far as the sketch, a placed partner or a shared node tells.
    fn known(&self, point: PointRef, state: &State) -> Option<[f64; 2]> {
        if self.done[point.body] {
            return Some(self.position(point, state));
        }
        let joints = self.c.scene.joints.iter().enumerate();
        let prismatic =
            |j: usize| matches!(self.c.scene.joints[j].model, JointModel::Prismatic { .. });
        joints
            .filter_map(|(j, joint)| {
                let partner = match () {
                    () if joint.bearing == point => joint.journal,
                    () if joint.journal == point => joint.bearing,
                    () => return None,
                };
                let drawn = self.c.scene.initial.sketch.iter().find(|s| s.joint == j);
                let partner = (self.done[partner.body] && !prismatic(j))
                    .then(|| self.position(partner, state));
                partner.or(drawn.map(|s| s.at))
            })
            .next()
    }

    /// Places body `b` where two of its points, or the only one it has, are known.
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

    /// Places a rigid body of which one point is known, at the angle that its joints with placed bodies suggest: that of a
    /// weld, a locked guide or a drive, or that of a slot towards its pin. False for a body that cannot be placed so.
    fn place_at_point(&mut self, b: usize, state: &mut State) -> bool {
        let (BodyCoordinates::Rigid { x }, BodyKind::Rigid(rigid), false) = (
            &self.mechanism.bodies()[b].coordinates,
            &self.c.scene.bodies[b].kind,
            self.done[b],
        ) else {
            return false;
        };
        let point = |point| PointRef { body: b, point };
        let mut points = rigid.points.iter().enumerate();
        let Some((local, at)) =
            points.find_map(|(i, p)| Some((p.at, self.known(point(i), state)?)))
        else {
            return false;
        };
        let Some(angle) = self.suggested_angle(b, at, state) else {
            return false;
        };
        let arm = rotate(angle.cos(), angle.sin(), local);
        state.q[*x..x + 3].copy_from_slice(&[at[0] - arm[0], at[1] - arm[1], angle]);
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

    /// Puts both ends of a link where they are unknown.
    fn write_link(&self, ends: [usize; 2], length: f64, pose: [f64; 3], state: &mut State) {
        let n = self.mechanism.shape().unknowns;
        let way = [length * pose[2].cos(), length * pose[2].sin()];
        let points = [[pose[0], pose[1]], add([pose[0], pose[1]], way)];
        for (x, at) in ends.into_iter().zip(points) {
            if x < n {
                state.q[x..x + 2].copy_from_slice(&at);
            }
        }
    }
}

/// Poses from the given states, the sketch, and what hangs together; returns the coordinates of given poses.
fn guess(c: &Compiler, mechanism: &Model, state: &mut State) -> Result<Vec<bool>, SceneError> {
    let n = mechanism.shape().unknowns;
    let mut placed = Placed {
        c,
        mechanism,
        done: c.roles.iter().map(|r| *r != Role::Free).collect(),
    };
    let mut held = vec![false; n];
    for given in &c.scene.initial.bodies {
        let body = &c.scene.bodies[given.body];
        if c.roles[given.body] != Role::Free {
            let message = format!(
                "the motion of {} is prescribed; it cannot have a start of its own",
                body.name
            );
            return Err(c.scene.error(given.span, message, "remove this"));
        }
        let mut hold = |x: usize, count: usize| {
            for h in held.iter_mut().skip(x).take(count) {
                *h = true;
            }
        };
        match (&mechanism.bodies()[given.body].coordinates, &body.kind) {
            (BodyCoordinates::Rigid { x }, _) => {
                state.q[*x..x + 3].copy_from_slice(&given.position);
                hold(*x, 3);
            }
            (BodyCoordinates::PointMass { x }, _) => {
                state.q[*x..x + 2].copy_from_slice(&given.position[..2]);
                hold(*x, 2);
            }
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
                placed.write_link(*ends, link.length, given.position, state);
                hold(ends[0], 2);
                hold(ends[1], 2);
            }
            _ => {}
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
        // one body at a time is drawn by a single point, so that its neighbours may follow it exactly
        if stuck && !(0..c.scene.bodies.len()).any(|b| placed.place_at_point(b, state)) {
            break;
        }
    }
    match placed.done.iter().position(|d| !d) {
        None => Ok(held),
        Some(b) => {
            let body = &c.scene.bodies[b];
            let message = format!(
                "the scene does not say where {} starts: give it in [initial] bodies, or draw two of its joints in [initial] sketch",
                body.name
            );
            Err(c.scene.error(body.span, message, "this body"))
        }
    }
}

/// The gradient of one constraint row by the unknown coordinates.
pub(crate) fn row(model: &Model, state: &State, constraint: usize, d: usize) -> Vec<f64> {
    let n = model.shape().unknowns;
    let placed = &model.constraints[constraint];
    let gradient = placed.term.gradient(state);
    let mut dense = vec![0.0; n];
    for (g, &i) in gradient[d].iter().zip(&placed.block.coordinates) {
        if i < n {
            dense[i] += g;
        }
    }
    dense
}

/// One step of Newton's method of least norm on Phi = 0 over the coordinates that are not held; returns the largest move.
pub(crate) fn closing_step(model: &Model, state: &mut State, held: &[bool]) -> f64 {
    let n = model.shape().unknowns;
    let mut equations = Equations::default();
    for (i, placed) in model.constraints.iter().enumerate() {
        let value = placed.term.value(state);
        for d in 0..placed.rows {
            let mut gradient = row(model, state, i, d);
            for (g, held) in gradient.iter_mut().zip(held) {
                *g = if *held { 0.0 } else { *g };
            }
            equations.add(&gradient, -value[d]);
        }
    }
    let step = equations.least_norm(n);
    for (q, dq) in state.q.iter_mut().zip(&step) {
        *q += dq;
    }
    step.iter()
        .fold(0.0, |m, x| if x.abs() <= m { m } else { x.abs() })
}

/// The constraint that is open most, by how much, and its name.
fn widest(model: &Model, state: &State) -> Option<(f64, String)> {
    let opening = model.constraints.iter().map(|p| {
        let value = p.term.value(state);
        (norm(value), p.row)
    });
    let widest = opening.max_by(|a, b| a.0.total_cmp(&b.0));
    widest.map(|(x, row)| (x, model.names[model.shape().unknowns + row].clone()))
}

/// Moves all coordinates that are not held until every constraint is closed.
fn close(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
    held: &[bool],
) -> Result<(), SceneError> {
    for _ in 0..ITERATIONS {
        let open = widest(mechanism, state).map_or(0.0, |(x, _)| x);
        if open <= CLOSED {
            break;
        }
        let moved = closing_step(mechanism, state, held);
        if !moved.is_finite() {
            break;
        }
    }
    let Some((open, name)) = widest(mechanism, state) else {
        return Ok(());
    };
    if open.is_nan() || open > CLOSED {
        return Err(cannot_close(c, open, &name));
    }
    for (placed, name) in mechanism.constraints.iter().zip(names(mechanism)) {
        if placed.term.half_turn(state) {
            let message = format!("{name} closes half a turn away from its angle");
            let error = c
                .scene
                .error(c.scene.initial.span, message, "from this start");
            return Err(error.with_help("draw the mechanism closer to the pose you mean"));
        }
    }
    Ok(())
}

/// Names the body that is larger than all others together, if there is one, or else the constraint that stays open.
fn cannot_close(c: &Compiler, open: f64, name: &str) -> SceneError {
    let sizes: Vec<f64> = (0..c.scene.bodies.len()).map(|b| size(c, b)).collect();
    let total: f64 = sizes.iter().sum();
    if let Some(b) = sizes.iter().position(|s| *s > total - s) {
        let body = &c.scene.bodies[b];
        let message = format!(
            "the mechanism cannot be assembled: {} is {:?} m long, more than all other bodies together ({:.4} m)",
            body.name,
            sizes[b],
            total - sizes[b]
        );
        return c.scene.error(
            body.span,
            message,
            "too large, or its unit is not the metre",
        );
    }
    let message = format!("the mechanism cannot be assembled: {name} stays open by {open:.3e} m");
    let error = c
        .scene
        .error(c.scene.initial.span, message, "from this start");
    error.with_help(
        "check the lengths, the given poses, and that the sketch draws the mechanism closed",
    )
}

/// Largest distance of two points of a body that joints use.
fn size(c: &Compiler, b: usize) -> f64 {
    let points = match &c.scene.bodies[b].kind {
        BodyKind::Link(link) => return link.length,
        BodyKind::PointMass { .. } => return 0.0,
        BodyKind::Ground { points } | BodyKind::Moving { points, .. } => points,
        BodyKind::Rigid(rigid) => &rigid.points,
    };
    let used = |i: usize| {
        let point = PointRef { body: b, point: i };
        let joints = c.scene.joints.iter();
        joints
            .into_iter()
            .any(|j| j.bearing == point || j.journal == point)
    };
    let used: Vec<_> = (0..points.len())
        .filter(|&i| used(i))
        .map(|i| points[i].at)
        .collect();
    let pairs = used
        .iter()
        .flat_map(|p| used.iter().map(move |q| norm(sub(*p, *q))));
    pairs.fold(0.0, f64::max)
}

fn names(model: &Model) -> impl Iterator<Item = &String> {
    let first = model.shape().unknowns;
    model
        .constraints
        .iter()
        .map(move |p| &model.names[first + p.row])
}

/// Sees that sketched joints ended near where they were drawn.
fn check_sketch(c: &Compiler, mechanism: &Model, state: &State) -> Result<(), SceneError> {
    for drawn in &c.scene.initial.sketch {
        let joint = &c.scene.joints[drawn.joint];
        let at = mechanism.position(
            &c.marker(
                &mechanism.bodies()[joint.journal.body].coordinates,
                joint.journal,
            ),
            state,
        );
        let size = |p: PointRef| match &c.scene.bodies[p.body].kind {
            BodyKind::Link(link) => link.length,
            BodyKind::Rigid(rigid) => {
                let far = rigid
                    .points
                    .iter()
                    .map(|q| norm(sub(q.at, rigid.points[p.point].at)));
                match far.fold(0.0, f64::max) {
                    0.0 => f64::INFINITY,
                    far => far,
                }
            }
            _ => f64::INFINITY,
        };
        if norm(sub(at, drawn.at)) > SKETCH * size(joint.bearing).min(size(joint.journal)) {
            let message = format!(
                "joint {} closes at ({:.4}, {:.4}) m, far from its sketch: draw it closer to the branch you mean",
                joint.name, at[0], at[1]
            );
            return Err(c.scene.error(drawn.span, message, "the sketch"));
        }
    }
    Ok(())
}

/// Velocities of least kinetic energy under the constraints and the given ones.
fn velocities(c: &Compiler, mechanism: &Model, state: &mut State) -> Result<(), SceneError> {
    let n = mechanism.shape().unknowns;
    state.v[..n].fill(0.0);
    let mut rates = vec![0.0; mechanism.shape().multipliers];
    mechanism.constraint_velocity(state, &mut rates);
    let mut equations = Equations::default();
    for (i, placed) in mechanism.constraints.iter().enumerate() {
        for d in 0..placed.rows {
            let added = equations.add(&row(mechanism, state, i, d), -rates[placed.row + d]);
            if let Added::Dependent(off) = added
                && off.abs() > AGREEING
            {
                let name = &mechanism.names[n + placed.row + d];
                let message = format!(
                    "the prescribed motions contradict each other at t = 0: {name} is off by {off:.3e} m/s"
                );
                return Err(c.scene.error(c.scene.initial.span, message, "this start"));
            }
        }
    }
    for given in c.scene.initial.bodies.iter().filter(|g| g.velocity_given) {
        for component in 0..3 {
            let Some((a, known)) = velocity_row(mechanism, state, given.body, component) else {
                continue;
            };
            let added = equations.add(&a, given.velocity[component] - known);
            if let Added::Dependent(off) = added
                && off.abs() > AGREEING
            {
                return Err(contradiction(c, given, component, off));
            }
        }
    }
    for given in &c.scene.initial.velocities {
        let body = &c.scene.bodies[given.body].name;
        let key = ["vx", "vy", "omega"][given.component];
        if c.roles[given.body] != Role::Free {
            let message = format!("the motion of {body} is prescribed; it cannot be given {key}");
            return Err(c.scene.error(given.span, message, "remove this"));
        }
        let Some((a, known)) = velocity_row(mechanism, state, given.body, given.component) else {
            continue;
        };
        if let Added::Dependent(off) = equations.add(&a, given.value - known) {
            let implied = given.value - off;
            let message = if off.abs() > AGREEING {
                format!(
                    "{key} of {body} contradicts what is given before: that makes it {implied:.6}"
                )
            } else {
                format!("{key} of {body} repeats what is given before: that makes it {implied:.6}")
            };
            return Err(c.scene.error(given.span, message, "leave this out"));
        }
    }
    let (mass, momentum) = mass(mechanism, state);
    let v = equations.least_energy(&mass, &momentum);
    state.v[..n].copy_from_slice(&v);
    mechanism.ride(state);
    Ok(())
}

fn contradiction(c: &Compiler, given: &BodyState, component: usize, off: f64) -> SceneError {
    let message = format!(
        "the velocity of {} contradicts the constraints: {} is off by {off:.3e}",
        c.scene.bodies[given.body].name,
        ["vx", "vy", "omega"][component]
    );
    c.scene.error(given.span, message, "this velocity")
}

/// A velocity of a body as a row over the unknown ones, and the part that known coordinates have in it. `None` for a
/// point mass's angular velocity.
fn velocity_row(
    mechanism: &Model,
    state: &State,
    body: usize,
    component: usize,
) -> Option<(Vec<f64>, f64)> {
    let n = mechanism.shape().unknowns;
    let entries: Vec<(usize, f64)> = match (&mechanism.bodies()[body].coordinates, component) {
        (BodyCoordinates::Rigid { x }, _) => vec![(x + component, 1.0)],
        (BodyCoordinates::PointMass { x }, 0 | 1) => vec![(x + component, 1.0)],
        (BodyCoordinates::RigidLink { ends }, 0 | 1) => vec![(ends[0] + component, 1.0)],
        (BodyCoordinates::RigidLink { ends: [i, j] }, _) => {
            let d = sub([state.q[*j], state.q[j + 1]], [state.q[*i], state.q[i + 1]]);
            let b = scale(1.0 / dot(d, d), perp(d));
            vec![(*i, -b[0]), (i + 1, -b[1]), (*j, b[0]), (j + 1, b[1])]
        }
        _ => return None,
    };
    let (mut row, mut known) = (vec![0.0; n], 0.0);
    for (i, value) in entries {
        if i < n {
            row[i] += value;
        } else {
            known += value * state.v[i];
        }
    }
    Some((row, known))
}

/// Mass matrix over the unknowns, and the momentum that known velocities give them.
fn mass(mechanism: &Model, state: &State) -> (Mat<f64>, Vec<f64>) {
    let n = mechanism.shape().unknowns;
    let (mut m, mut momentum) = (Mat::zeros(n, n), vec![0.0; n]);
    for part in &mechanism.mass.parts {
        let count = part.coordinates.len();
        for (r, &i) in part.coordinates.iter().enumerate().filter(|(_, i)| **i < n) {
            for (s, &j) in part.coordinates.iter().enumerate() {
                let value = part.values[r * count + s];
                if j < n {
                    m[(i, j)] += value;
                } else {
                    momentum[i] += value * state.v[j];
                }
            }
        }
    }
    (m, momentum)
}

/// Position and velocity of the reference point and the angle of a link, from its ends.
pub(crate) fn link_start(ends: [([f64; 2], [f64; 2]); 2]) -> ([f64; 3], [f64; 3]) {
    let [(from, from_rate), (to, to_rate)] = ends;
    let (d, d_dot) = (sub(to, from), sub(to_rate, from_rate));
    let omega = cross(d, d_dot) / dot(d, d);
    (
        [from[0], from[1], d[1].atan2(d[0])],
        [from_rate[0], from_rate[1], omega],
    )
}
