//! Given poses that contradict the sketch, a joint, a drive or each other.

use super::super::{Compiler, Role};
use super::guess::coordinates;
use super::{CENTRE, CLOSED, check_sketch, close, is_guide, names, opening, position, reach};
use crate::math::plane::{norm, sub};
use crate::model::{Model, PlacedConstraint};
use crate::scene::{BodyState, SceneError, SketchPoint};
use crate::system::State;
use crate::terms::ConstraintTerm;

/// The state that the scene gives to a body.
fn given<'a>(c: &Compiler<'a>, body: usize) -> Option<&'a BodyState> {
    c.scene.initial.bodies.iter().find(|s| s.body == body)
}

/// Checks that neither the sketch nor a joint contradicts a given pose or a prescribed motion.
pub(super) fn check_given(
    c: &Compiler,
    model: &Model,
    state: &State,
    held: &[bool],
) -> Result<(), SceneError> {
    for drawn in &c.scene.initial.sketch {
        for point in c.sketched_points(drawn) {
            let at = position(model, state, point);
            if is_guide(c, drawn, point) || norm(sub(at, drawn.at)) <= reach(c, drawn) {
                continue;
            }
            let body = &c.scene.bodies[point.body];
            let (cause, span) = match (given(c, point.body), c.roles[point.body]) {
                (Some(pose), _) => (format!("the given pose of {}", body.name), pose.span),
                (None, Role::Free) => continue,
                (None, Role::Turned(m)) => {
                    let motion = &c.scene.motions[m];
                    (format!("drive {}", motion.name), motion.span)
                }
                (None, Role::Ground) => ("the ground".to_owned(), body.span),
                (None, Role::Path | Role::Driven) => {
                    (format!("the path of {}", body.name), body.span)
                }
            };
            let message = format!(
                "the sketch draws {} at ({:.4}, {:.4}) m, but {cause} puts it at ({:.4}, {:.4}) m",
                c.sketched_name(drawn),
                drawn.at[0],
                drawn.at[1],
                at[0],
                at[1]
            );
            let places = [(drawn.span, "the sketch"), (span, "contradicts the sketch")];
            return Err(c.scene.contradiction(message, places[0], places[1]));
        }
    }
    let n = model.shape().unknowns;
    for (placed, name) in model.constraints.iter().zip(names(model)) {
        let fixed = placed.block.coordinates.iter().all(|&i| i >= n || held[i]);
        let open = norm(placed.term.value(state));
        if fixed && open > CLOSED {
            match placed.term {
                ConstraintTerm::Length(_) => wrong_length(c, placed, state)?,
                _ => misfit(c, placed, name, open)?,
            }
        }
    }
    Ok(())
}

/// An error for a link if given poses fix its ends at a distance other than its length.
fn wrong_length(c: &Compiler, placed: &PlacedConstraint, state: &State) -> Result<(), SceneError> {
    let own = placed.owners[0];
    let body = &c.scene.bodies[own];
    let Some(length) = body.kind.length() else {
        return Ok(());
    };
    // Phi = (d^2 - l^2)/(2 l)
    let phi = placed.term.value(state)[0];
    let distance = (length * (length + 2.0 * phi)).sqrt();
    let [distance, length] = [distance, length].map(|x| numbers::si(x, "m"));
    let neighbour = c.scene.joints.iter().find_map(|joint| {
        let bodies = [joint.bearing.body, joint.journal.body];
        let other = bodies.iter().find(|b| **b != own)?;
        bodies.contains(&own).then(|| given(c, *other))?
    });
    let error = match (given(c, own), neighbour) {
        (Some(pose), _) => {
            let message = format!(
                "the given pose of {} does not fit the points that its ends are joined to: they are {distance} apart, but its length \
                 is {length}",
                body.name
            );
            c.scene.error(pose.span, message, "this pose")
        }
        (None, Some(pose)) => {
            let message = format!(
                "the given poses hold the ends of {} {distance} apart, but its length is {length}",
                body.name
            );
            let places = [(pose.span, "this pose"), (body.span, "this link")];
            c.scene.contradiction(message, places[0], places[1])
        }
        (None, None) => return Ok(()),
    };
    Err(error.with_help(CENTRE))
}

/// An error for a joint or a drive that a given pose violates, if there is one.
fn misfit(
    c: &Compiler,
    placed: &PlacedConstraint,
    name: &str,
    open: f64,
) -> Result<(), SceneError> {
    let mut poses = c.scene.initial.bodies.iter();
    let Some(pose) = poses.find(|s| placed.owners.contains(&s.body)) else {
        return Ok(());
    };
    let whole = name.split(" (").next().unwrap_or(name);
    let message = format!(
        "the given pose of {} does not fit {whole}, which stays open by {}",
        c.scene.bodies[pose.body].name,
        opening(&placed.term, open, "")
    );
    let joints = c.scene.joints.iter();
    let joints = joints.map(|j| (format!("joint {}", j.name), j.span));
    let drives = c.scene.motions.iter();
    let drives = drives.map(|m| (format!("drive {}", m.name), m.span));
    let error = match joints.chain(drives).find(|(n, _)| n == whole) {
        Some((_, span)) => {
            let places = [(pose.span, "this pose"), (span, "does not fit the pose")];
            c.scene.contradiction(message, places[0], places[1])
        }
        None => c.scene.error(pose.span, message, "this pose"),
    };
    Err(error.with_help(CENTRE))
}

/// An error that names a given pose and the sketch, if the mechanism closes as sketched without this pose.
pub(super) fn blame(
    c: &Compiler,
    model: &Model,
    guessed: &State,
    held: &[bool],
    (open, constraint): (f64, usize),
) -> Option<SceneError> {
    let placed = &model.constraints[constraint];
    let pose = c.scene.initial.bodies.iter().find(|pose| {
        let (mut free, mut state) = (held.to_vec(), guessed.clone());
        for i in coordinates(model, pose.body) {
            free[i] = false;
        }
        close(model, &mut state, &free).is_none() && check_sketch(c, model, &state).is_ok()
    })?;
    let (body, open) = (
        &c.scene.bodies[pose.body].name,
        opening(&placed.term, open, ""),
    );
    let name = names(model).nth(constraint)?;
    let mut sketch = c.scene.initial.sketch.iter();
    let near = |s: &&SketchPoint| {
        let points = c.sketched_points(s);
        points.iter().any(|p| placed.owners.contains(&p.body))
    };
    let error = match sketch.find(near) {
        Some(drawn) => {
            let message = format!(
                "the given pose of {body} contradicts the sketch of {}: without this pose the mechanism closes there, with \
                 it {name} stays open by {open}",
                c.sketched_name(drawn)
            );
            let places = [(pose.span, "this pose"), (drawn.span, "this sketch")];
            c.scene.contradiction(message, places[0], places[1])
        }
        None => {
            let message = format!(
                "the mechanism cannot be assembled with the given pose of {body}: {name} stays open by {open}; without \
                 this pose it closes"
            );
            c.scene.error(pose.span, message, "this pose")
        }
    };
    Some(error.with_help(CENTRE))
}
