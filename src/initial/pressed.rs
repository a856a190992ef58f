//! A start with the journals pressed against their bearings.
//!
//! With multipliers in place of the contacts, and rigid links, the mechanism of the scene has a force lambda in every joint with
//! clearance. A journal at rest in its bearing exerts this force where
//!
//! ```text
//! Phi = (c + delta) lambda/|lambda|,   N(delta, 0) = |lambda|
//! ```
//!
//! with the clearance c, the normal law N, and Phi the eccentricity from journal to bearing of a revolute joint, the distance from the
//! centre line of a guide. Newton's method with steps of least norm moves the bodies there, and Phi_q v + Phi_t = 0 makes the surfaces
//! rest on each other. Without a force that presses the surfaces by more than the tolerance of an onset, Phi = 0. These are as many
//! equations as those of the ideal mechanism.

use super::redundancy::{Ranks, Redundancy};
use super::{known, place};
use crate::body::{Deformation, Frame};
use crate::compile::assembly::{close_to, name, opening};
use crate::compile::compile_pressed;
use crate::compile::extent::extent;
use crate::interaction::{Contact, Joint};
use crate::math::plane::Vec2;
use crate::model::{Model, PlacedConstraint};
use crate::newton::Newton;
use crate::scene::{Scene, SceneError};
use crate::system::{State, System};
use crate::terms::ForceTerm;

/// Halvings of the clearance in which a penetration is sought: a bit each.
const HALVINGS: usize = f64::MANTISSA_DIGITS as usize;

/// Moves the bodies of a start so that every journal exerts the force that the ideal joint would have.
pub(super) fn press(scene: &Scene, starts: &mut [Option<Frame>]) -> Result<(), SceneError> {
    let mut given = scene.initial.bodies.values();
    if let Some(given) = given.find(|given| given.deformation != Deformation::default()) {
        let message = format!(
            "journals cannot be pressed: {} starts stretched or bending",
            scene.bodies[given.body].name
        );
        return Err(scene.error(given.span, message, "deformed"));
    }
    let compiled = compile_pressed(scene)?;
    let mut state = known(scene, &compiled)?;
    let mut model = compiled.model;
    let shape = model.shape();
    let mut written = vec![false; state.q.len()];
    written[shape.unknowns..].fill(true);
    for (body, start) in model.bodies().iter().zip(&*starts) {
        if let Some(start) = start {
            // where bodies do not meet, the mechanism is closed below
            place(
                body,
                body.placed.kind.place(start),
                extent(scene),
                &mut state,
                &mut written,
            );
        }
    }
    let mut goal = vec![0.0; shape.multipliers];
    close_at(scene, &model, &mut state, &goal)?;
    if let Redundancy::Rows(rows) = Ranks::of(&model, &state, extent(scene)).redundancy() {
        model.drop_rows(&rows);
    }
    rest(scene, &model, &mut state)?;
    for (j, joint) in scene.joints.iter().enumerate() {
        if let Some(contact) = joint.contact() {
            let placed = multipliers(scene, &model, j)?;
            let pressed = eccentricity(scene, joint, contact, placed.multipliers(&state).into())?;
            for d in 0..placed.rows {
                goal[placed.row + d] = pressed[d];
            }
        }
    }
    close_at(scene, &model, &mut state, &goal)?;
    rest(scene, &model, &mut state)?;
    for (body, start) in model.bodies().iter().zip(starts) {
        if start.is_some() {
            let placed = &body.placed;
            *start = placed.kind.frame_at(&placed.x, &state.q, &state.v);
        }
    }
    Ok(())
}

/// Closes the mechanism with these values of its constraints.
fn close_at(
    scene: &Scene,
    model: &Model,
    state: &mut State,
    goal: &[f64],
) -> Result<(), SceneError> {
    let held = vec![false; model.shape().unknowns];
    let Some((open, placed)) = close_to(model, state, &held, goal, extent(scene)) else {
        model.move_driven_nodes(state);
        return Ok(());
    };
    let message = format!(
        "journals cannot be pressed: {} stays open by {}",
        name(model, placed),
        opening(&placed.term, open, "")
    );
    let error = scene.error(scene.initial.span, message, "this start");
    Err(error.with_help(
        "the ideal mechanism is overdetermined here: start with `journals = \"centred\"`",
    ))
}

/// Velocities that satisfy the constraints, accelerations and multipliers.
fn rest(scene: &Scene, model: &Model, state: &mut State) -> Result<(), SceneError> {
    // the equations are linear in what is solved for: no tolerance enters
    let mut newton = Newton::new(model, 0.0);
    let solved = newton.make_consistent(model, state, &mut model.work());
    solved.map_err(|failure| {
        let message = format!(
            "journals cannot be pressed: the forces of the ideal joints are not determined at {}",
            model.unknown_name(failure.index())
        );
        scene.error(scene.initial.span, message, "this start")
    })
}

/// The constraint that stands for a contact.
fn multipliers<'m>(
    scene: &Scene,
    model: &'m Model,
    joint: usize,
) -> Result<&'m PlacedConstraint, SceneError> {
    if let ForceTerm::Constraint(c) = model.joints()[joint].terms.force {
        return Ok(&model.constraints[c]);
    }
    let joint = &scene.joints[joint];
    let message = format!(
        "joint {} cannot start pressed: it has no ideal form with a force",
        joint.name
    );
    Err(scene.error(joint.span, message, "this joint"))
}

/// The value of the constraint of a joint at which its contact at rest has the force of these multipliers.
fn eccentricity(
    scene: &Scene,
    joint: &Joint,
    contact: &Contact,
    lambda: Vec2,
) -> Result<Vec2, SceneError> {
    let force = lambda.norm();
    let law = contact.normal_law();
    let at_rest = |delta: f64| law.force(delta, 0.0, contact.impact_velocity_floor).value;
    let [mut low, mut high] = [0.0, contact.clearance];
    if force.is_nan() || at_rest(high) < force {
        let message = format!(
            "joint {} cannot start pressed: a force of {} needs a penetration beyond its clearance of {}",
            joint.name,
            numbers::si(force, "N"),
            numbers::si(contact.clearance, "m")
        );
        return Err(scene.error(joint.span, message, "this joint"));
    }
    for _ in 0..HALVINGS {
        let delta = 0.5 * (low + high);
        let bound = if at_rest(delta) < force {
            &mut low
        } else {
            &mut high
        };
        *bound = delta;
    }
    // what does not close the contact is rounding
    match high > scene.integrator.onset_tolerance {
        true => Ok((contact.clearance + high) / force * lambda),
        false => Ok(Vec2::zeros()),
    }
}
