//! Where the motion starts: poses of the ideal mechanism or of the scene, then consistent rates.

pub(crate) mod redundancy;

use crate::body::{Content, Frame};
use crate::compile::Compiled;
use crate::compile::assembly::{CENTRE, assemble, opening};
use crate::math::plane::norm;
use crate::model::{Model, PlacedConstraint};
use crate::scene::{Analysis, BodyState, Scene, SceneError};
use crate::system::State;

/// Largest violation of a constraint \[m\] or of its rate \[m/s\] at the start: the digits of a typed position.
const START_TOLERANCE: f64 = 1e-9;

/// Writes coordinates and remembers which were written, so that two bodies that share a node must agree on it.
struct Writer<'a> {
    state: &'a mut State,
    unknowns: usize,
    written: Vec<bool>,
}

impl Writer<'_> {
    /// Sets coordinates from `x` and their rates; false if they are already known or written and differ.
    fn slot(&mut self, x: usize, [position, velocity]: [[f64; 3]; 2], content: Content) -> bool {
        let here = x..x + content.names().len();
        if x >= self.unknowns || self.written[x] {
            let agrees = |level: &[f64], values: [f64; 3]| {
                let differences = level[here.clone()].iter().zip(values).map(|(a, b)| a - b);
                differences.map(|d| d * d).sum::<f64>().sqrt() <= START_TOLERANCE
            };
            return agrees(&self.state.q, position) && agrees(&self.state.v, velocity);
        }
        self.written[x] = true;
        let width = here.len();
        self.state.q[here.clone()].copy_from_slice(&position[..width]);
        self.state.v[here].copy_from_slice(&velocity[..width]);
        true
    }
}

/// The state at t = 0, accelerations and multipliers still to be found.
///
/// # Errors
/// A body without a start, or a start that violates a constraint.
pub fn start(scene: &Scene, compiled: &Compiled) -> Result<State, SceneError> {
    let Compiled { model, kinematics } = compiled;
    let mut state = model.blank_state();
    model.follow_rules(&mut state);
    if let Some(kinematics) = kinematics {
        let mut inner = kinematics.work();
        inner.state.q.copy_from_slice(&kinematics.start);
        let solved = kinematics.solve(&mut inner, 20);
        solved.map_err(|e| scene.error(scene.initial.span, e.to_string(), "the start"))?;
        let here = kinematics.offset..kinematics.offset + inner.state.q.len();
        state.q[here.clone()].copy_from_slice(&inner.state.q);
        state.v[here.clone()].copy_from_slice(&inner.state.v);
        state.a[here].copy_from_slice(&inner.state.a);
    }
    model.move_driven_nodes(&mut state);
    let starts = starts(scene, compiled, &state)?;

    let unknowns = model.shape().unknowns;
    let mut writer = Writer {
        written: vec![false; state.q.len()],
        state: &mut state,
        unknowns,
    };
    for (b, start) in starts.iter().enumerate() {
        let Some(start) = start else { continue };
        let body = &scene.bodies[b];
        if !place(model, b, start, &mut writer) {
            let given = scene.initial.bodies.iter().find(|s| s.body == b);
            let span = given.map_or(body.span, |g| g.span);
            let message = format!(
                "the pose of {} does not fit the points that its ends are joined to",
                body.name
            );
            let error = scene.error(span, message, "does not fit its joints");
            return Err(error.with_help(CENTRE));
        }
    }
    for j in 0..scene.joints.len() {
        let Some(contact) = scene.joints[j].contact() else {
            continue;
        };
        let delta = model.gap(j, &state).map_or(0.0, |(gap, ..)| gap.delta);
        if delta > contact.clearance {
            let message = format!(
                "the journal of joint {} starts outside its bearing: the penetration of {} exceeds the clearance of {}",
                scene.joints[j].name,
                numbers::si(delta, "m"),
                numbers::si(contact.clearance, "m")
            );
            return Err(scene.error(scene.joints[j].span, message, "this joint"));
        }
    }
    for (f, force) in scene.forces.iter().enumerate() {
        if let Some(fault) = model.force(f).fault(&state) {
            let message = format!("force {} is not defined at the start: {fault}", force.name);
            return Err(scene.error(force.span, message, "this force"));
        }
    }
    satisfied(scene, model, &state)?;
    if let Some(index) = model.half_turned(&state) {
        let name = &model.unknown_names()[index];
        let message = format!("{name} starts half a turn away from the angle it holds");
        return Err(scene.error(scene.initial.span, message, "this start"));
    }
    model.remember_angles(&mut state);
    Ok(state)
}

/// Checks that a start satisfies the constraints and their rates.
fn satisfied(scene: &Scene, model: &Model, state: &State) -> Result<(), SceneError> {
    let worst = |of: fn(&PlacedConstraint, &State) -> f64| {
        let all = model.constraints.iter().map(|p| (of(p, state), p));
        let worst = all.max_by(|a, b| a.0.total_cmp(&b.0));
        worst.filter(|(x, _)| x.is_nan() || *x > START_TOLERANCE)
    };
    let name = |p: &PlacedConstraint| {
        let row = model.names[model.shape().unknowns + p.row].as_str();
        // the violation is measured over all rows together, so no single row can be named
        match p.rows {
            1 => row,
            _ => row.split(" (").next().unwrap_or(row),
        }
    };
    if let Some((open, placed)) = worst(|p, at| norm(p.term.value(at))) {
        let message = format!(
            "the start violates {}: it is open by {}",
            name(placed),
            opening(&placed.term, open, "")
        );
        let error = scene.error(scene.initial.span, message, "this start");
        return Err(error.with_help(CENTRE));
    }
    // nothing moves in a static analysis, whatever its drives prescribe
    if scene.simulation.analysis == Analysis::Static {
        return Ok(());
    }
    let Some((off, placed)) = worst(|p, at| norm(p.term.velocity(at))) else {
        return Ok(());
    };
    let message = format!(
        "the velocities of the start violate {}, by {}",
        name(placed),
        opening(&placed.term, off, "/s")
    );
    let silent = scene.initial.bodies.iter().filter(|s| !s.velocity_given);
    let silent: Vec<&BodyState> = silent.collect();
    let Some(first) = silent.first() else {
        return Err(scene.error(scene.initial.span, message, "this start"));
    };
    let names: Vec<&str> = silent
        .iter()
        .map(|s| scene.bodies[s.body].name.as_str())
        .collect();
    let message = format!(
        "{message}: the scene gives no velocity for {}, so zero was assumed",
        names.join(", ")
    );
    let error = scene.error(first.span, message, "no velocity here");
    Err(error.with_help(if !model.prescribed.is_empty() {
        "give `vx`, `vy` and `omega` beside the pose"
    } else {
        "add a joint to `[initial.sketch]` or a velocity to `[initial.velocities]`, and the others are computed; or give `vx`, \
         `vy` and `omega` of every body"
    }))
}

/// The start of every body that moves freely.
fn starts(
    scene: &Scene,
    compiled: &Compiled,
    state: &State,
) -> Result<Vec<Option<Frame>>, SceneError> {
    let Compiled { model, kinematics } = compiled;
    let free: Vec<bool> = (0..scene.bodies.len()).map(|b| is_free(model, b)).collect();
    let given = |b: usize| scene.initial.bodies.iter().find(|s| s.body == b);
    for (b, body) in scene.bodies.iter().enumerate() {
        if let Some(given) = given(b).filter(|_| !free[b]) {
            let message = format!(
                "the motion of {} is prescribed, so it cannot be given an initial state",
                body.name
            );
            return Err(scene.error(given.span, message, "remove this"));
        }
    }
    if let (Some(kinematics), Some(given)) = (kinematics, scene.initial.velocities.first()) {
        let message = format!(
            "the velocity of {} cannot be given: with inverse kinematics all velocities are those of the ideal mechanism",
            kinematics.mechanism.bodies()[given.body].name
        );
        return Err(scene.error(given.span, message, "remove this"));
    }
    let exact = |b: usize| given(b).map(|g| scene.bodies[b].kind.frame(g.position, g.velocity));
    let incomplete = (0..scene.bodies.len()).any(|b| free[b] && given(b).is_none());
    let assembled = kinematics.is_none()
        && (incomplete || !scene.initial.sketch.is_empty() || !scene.initial.velocities.is_empty());
    if assembled {
        let assembly = assemble(scene)?;
        let of = |b: usize| ideal_start(&assembly.mechanism, b, &assembly.state, 0);
        return Ok((0..free.len())
            .map(|b| free[b].then(|| of(b)).flatten())
            .collect());
    }
    let ideal = |b: usize| {
        let kinematics = kinematics.as_ref()?;
        ideal_start(&kinematics.mechanism, b, state, kinematics.offset)
    };
    Ok((0..free.len())
        .map(|b| free[b].then(|| exact(b).or_else(|| ideal(b))).flatten())
        .collect())
}

fn is_free(model: &Model, b: usize) -> bool {
    let unknowns = model.shape().unknowns;
    model.bodies()[b].placed.x.iter().any(|&x| x < unknowns)
}

/// Frame of a body in the ideal mechanism, whose coordinates begin at `offset` in `state`.
fn ideal_start(mechanism: &Model, b: usize, state: &State, offset: usize) -> Option<Frame> {
    let placed = &mechanism.bodies()[b].placed;
    let (q, v) = (&state.q[offset..], &state.v[offset..]);
    placed.kind.frame_at(&placed.x, q, v)
}

/// Writes the coordinates of body `b`, undeformed; false if a node differs from one already known or written.
fn place(model: &Model, b: usize, start: &Frame, writer: &mut Writer) -> bool {
    let body = &model.bodies()[b];
    let values = body.placed.kind.place(start);
    let slots = body.placed.x.iter().zip(values).zip(&body.contents);
    let fits = slots.map(|((x, value), content)| writer.slot(*x, value, *content));
    fits.fold(true, |all, fits| all & fits)
}
