//! Given poses that contradict the sketch, a joint, a drive or each other.

use super::super::extent::{FITS, extent};
use super::super::{Compiler, Role};
use super::closing::{Closing, Search};
use super::guess::coordinates;
use super::{CENTRE, check_sketch, name, opening, reach, strays, whole_name};
use crate::math::plane::{Rotation, Vec2};
use crate::model::{Model, PlacedConstraint};
use crate::scene::{MotionKind, SceneError, SketchPoint};
use crate::system::State;
use crate::terms::ConstraintTerm;
use numbers::number;
use std::collections::HashSet;

/// Checks that neither the sketch nor a joint contradicts a given pose or a prescribed motion.
pub(super) fn check_given(
    c: &Compiler,
    model: &Model,
    state: &State,
    held: &[bool],
) -> Result<(), SceneError> {
    for (drawn, point, at) in strays(c, model, state) {
        let body = &c.scene.bodies[point.body];
        let given = c.scene.initial.state_of(point.body);
        let (cause, span) = match (given, c.roles[point.body]) {
            (Some(pose), _) => (format!("the given pose of {}", body.name), pose.span),
            (None, Role::Free) => continue,
            (None, Role::Turned(m)) => {
                let motion = &c.scene.motions[m];
                (format!("drive {}", motion.name), motion.span)
            }
            (None, Role::Ground) => ("the ground".to_owned(), body.span),
            (None, Role::Path | Role::Driven) => (format!("the path of {}", body.name), body.span),
        };
        let message = format!(
            "the sketch draws {} at ({:.4}, {:.4}) m, but {cause} puts it at ({:.4}, {:.4}) m",
            c.sketched_name(drawn),
            drawn.at[0],
            drawn.at[1],
            at[0],
            at[1]
        );
        let cause = Some((span, "contradicts the sketch"));
        let sketch = (drawn.span, "the sketch");
        let error = c.scene.contradiction(message, sketch, cause);
        let in_degrees = turned(c, point.body).filter(|(centre, angle)| {
            let turn = Rotation::new(angle.to_radians() - angle);
            (centre + turn * (at - centre) - drawn.at).norm() <= reach(c, drawn)
        });
        return Err(match in_degrees {
            Some((_, angle)) => error.with_help(format!(
                "are these degrees? Angles are in radians, and {} degrees are {} rad",
                number(angle, 6),
                number(angle.to_radians(), 6)
            )),
            None => error,
        });
    }
    let n = model.shape().unknowns;
    let fits = FITS * extent(c.scene);
    for placed in &model.constraints {
        let fixed = placed.block.coordinates.iter().all(|&i| i >= n || held[i]);
        let open = Vec2::from(placed.term.value(state)).norm();
        if fixed && open > fits {
            let error = match placed.term {
                ConstraintTerm::Length(_) => wrong_length(c, placed, state),
                _ => misfit(c, placed, whole_name(model, placed), open),
            };
            if let Some(error) = error {
                return Err(error.with_help(CENTRE));
            }
        }
    }
    Ok(())
}

/// The angle that a scene gives a body, and the point about which it turns it.
fn turned(c: &Compiler, body: usize) -> Option<(Vec2, f64)> {
    if let Some(given) = c.scene.initial.state_of(body) {
        let [x, y, angle] = given.position;
        return Some((Vec2::new(x, y), angle));
    }
    let motion = c.roles[body].turned()?;
    let MotionKind::Angle { joint, angle } = &c.scene.motions[motion].kind else {
        return None;
    };
    let mut ends = c.scene.joints[*joint].points().into_iter();
    let centre = ends.find_map(|point| c.on_ground(point))?;
    Some((centre, angle.at(0.0)[0]))
}

/// An error for a link if given poses fix its ends at a distance other than its length.
fn wrong_length(c: &Compiler, placed: &PlacedConstraint, state: &State) -> Option<SceneError> {
    let body = &c.scene.bodies[placed.owners[0]];
    let length = body.kind.length()?;
    // Phi = (d^2 - l^2)/(2 l)
    let phi = placed.term.value(state)[0];
    let distance = (length * (length + 2.0 * phi)).sqrt();
    let [distance, length] = [distance, length].map(|x| numbers::si(x, "m"));
    if let Some(pose) = c.scene.initial.state_of(placed.owners[0]) {
        let message = format!(
            "the given pose of {} does not fit the points that its ends are joined to: they are {distance} apart, but its length is \
             {length}",
            body.name
        );
        return Some(c.scene.error(pose.span, message, "this pose"));
    }
    let pose = c.scene.joints.iter().find_map(|joint| {
        let bodies = joint.points().map(|point| point.body);
        let other = bodies.iter().find(|b| **b != placed.owners[0])?;
        let given = || c.scene.initial.state_of(*other);
        bodies.contains(&placed.owners[0]).then(given)?
    })?;
    let message = format!(
        "the given poses hold the ends of {} {distance} apart, but its length is {length}",
        body.name
    );
    let link = Some((body.span, "this link"));
    Some(
        c.scene
            .contradiction(message, (pose.span, "this pose"), link),
    )
}

/// An error for a joint or a drive that a given pose violates, if there is one.
fn misfit(c: &Compiler, placed: &PlacedConstraint, whole: &str, open: f64) -> Option<SceneError> {
    let mut poses = c.scene.initial.bodies.values();
    let pose = poses.find(|s| placed.owners.contains(&s.body))?;
    let message = format!(
        "the given pose of {} does not fit {whole}, which stays open by {}",
        c.scene.bodies[pose.body].name,
        opening(&placed.term, open, "")
    );
    let joints = c.scene.joints.iter();
    let joints = joints.map(|j| (format!("joint {}", j.name), j.span));
    let drives = c.scene.motions.iter();
    let drives = drives.map(|m| (format!("drive {}", m.name), m.span));
    let violated = joints.chain(drives).find(|(name, _)| name == whole);
    let violated = violated.map(|(_, span)| (span, "does not fit the pose"));
    Some(
        c.scene
            .contradiction(message, (pose.span, "this pose"), violated),
    )
}

/// An error that names a given pose and the sketch, if the mechanism closes as sketched without this pose.
pub(super) fn blame(
    c: &Compiler,
    closing: &Closing,
    guessed: &State,
    placed: &PlacedConstraint,
) -> Option<SceneError> {
    let model = closing.model;
    let part = closing.part(placed).into_iter();
    let reached: HashSet<usize> = part
        .flat_map(|k| model.constraints[k].block.coordinates.iter().copied())
        .collect();
    let mut poses = c.scene.initial.bodies.values();
    let pose = poses.find(|pose| {
        let own = coordinates(model, pose.body);
        if !own.iter().any(|i| reached.contains(i)) {
            return false;
        }
        let (mut free, mut state) = (closing.held.to_vec(), guessed.clone());
        for i in own {
            free[i] = false;
        }
        let without = Closing {
            held: &free,
            ..*closing
        };
        without.close(&mut state).is_none() && check_sketch(c, model, &state).is_ok()
    })?;
    let body = &c.scene.bodies[pose.body].name;
    let open = match closing.search(guessed, placed) {
        Search::Open(open) => {
            let [place, gap] = open.gap(c, model);
            format!("{place} stays open by {gap} at least")
        }
        _ => format!("{} stays open", name(model, placed)),
    };
    let mut sketch = c.scene.initial.sketch.iter();
    let near = |s: &&SketchPoint| {
        let points = c.sketched_points(s);
        points.iter().any(|p| placed.owners.contains(&p.body))
    };
    let drawn = sketch.find(near);
    let message = match drawn {
        Some(drawn) => format!(
            "the given pose of {body} contradicts the sketch of {}: without this pose the mechanism closes there, with it {open}",
            c.sketched_name(drawn)
        ),
        None => format!(
            "the mechanism cannot be assembled with the given pose of {body}: {open}; without this pose it closes"
        ),
    };
    let drawn = drawn.map(|drawn| (drawn.span, "this sketch"));
    let error = c
        .scene
        .contradiction(message, (pose.span, "this pose"), drawn);
    Some(error.with_help(CENTRE))
}
