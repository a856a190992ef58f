//! Assembly of a mechanism that no inverse kinematics closes: positions from a sketch, velocities from a few of them.
//!
//! Everything is done on the ideal rigid mechanism. Positions: Newton's method with the step of least norm, from a guess
//! that the sketch and the given poses make. Velocities: those of least kinetic energy that satisfy the constraints and
//! what the scene gives.

mod guess;
mod velocities;

use super::{Compiler, Mode, known_roles, numbering, terms};
use crate::math::dense::Equations;
use crate::math::plane::{norm, sub};
use crate::model::Model;
use crate::scene::{BodyKind, Joint, JointModel, PointRef, Scene, SceneError};
use crate::system::State;
use guess::guess;
use plot::number;
use velocities::velocities;

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
        return Err(cannot_close(c, open, &name, held.contains(&true)));
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

/// Names the body that is larger than all others together, if there is one and neither a guide nor a given pose explains the
/// opening, or else the constraint that stays open.
fn cannot_close(c: &Compiler, open: f64, name: &str, holds: bool) -> SceneError {
    let sizes: Vec<f64> = (0..c.scene.bodies.len()).map(|b| size(c, b)).collect();
    let total: f64 = sizes.iter().sum();
    let guides = |joint: &Joint| matches!(joint.model, JointModel::Prismatic { .. });
    let pinned = !holds && !c.scene.joints.iter().any(guides);
    if let Some(b) = sizes.iter().position(|s| pinned && *s > total - s) {
        let body = &c.scene.bodies[b];
        let message = format!(
            "the mechanism cannot be assembled: {} is {} m long, more than all other bodies together ({} m)",
            body.name,
            plot::exact(sizes[b]),
            number(total - sizes[b], 4)
        );
        return c.scene.error(
            body.span,
            message,
            "too large, or its unit is not the metre",
        );
    }
    let message = format!(
        "the mechanism cannot be assembled: {name} stays open by {} m",
        number(open, 4)
    );
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
