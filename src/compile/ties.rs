//! What holds a body, and by which of its joints: from this a body chooses its coordinates.

use super::{Compiler, Role, numbering};
use crate::body::{Hold, HoldingLine, PointRef, Ties};
use crate::scene::SceneError;
use std::f64::consts::FRAC_PI_2;

/// The ties of a body, and the joints that are its holds.
#[derive(Debug, Clone, Default)]
pub(crate) struct BodyTies {
    pub ties: Ties,
    pub joints: Vec<usize>,
}

/// Those of every body.
pub(super) fn of_bodies(c: &Compiler) -> Result<Vec<BodyTies>, SceneError> {
    let shared = numbering::shared_nodes(c)?;
    let mut all = vec![BodyTies::default(); c.bodies.len()];
    for (j, shared) in shared.into_iter().enumerate() {
        let joint = &c.scene.joints[j];
        for (own, other) in [
            (joint.bearing, joint.journal),
            (joint.journal, joint.bearing),
        ] {
            let of_body = &mut all[own.body];
            if shared && c.node(own).is_some() {
                match c.is_known(other) {
                    true => of_body.ties.anchored = true,
                    false => of_body.ties.shares = true,
                }
            }
            if let Some(hold) = hold(c, j, own, other) {
                of_body.ties.holds.push(hold);
                of_body.joints.push(j);
            }
        }
    }
    Ok(all)
}

/// How joint `j` holds the body of `own`, if the other of its points is known.
fn hold(c: &Compiler, j: usize, own: PointRef, other: PointRef) -> Option<Hold> {
    let model = &c.joints[j];
    if model.contact().is_some() || !c.is_known(other) || c.is_known(own) {
        return None;
    }
    let point = own.point;
    if model.is_revolute() {
        return Some(Hold { point, line: None });
    }
    let (angle, direction) = (model.angle()?, model.line()?);
    // a quarter turn is written exactly
    let quarters = direction / FRAC_PI_2;
    let is_guide = other == c.scene.joints[j].bearing && c.roles[other.body] == Role::Ground;
    if !is_guide || quarters.fract() != 0.0 {
        return None;
    }
    let along = quarters.rem_euclid(2.0) as usize;
    let across = c.bodies[other.body].points()[other.point].at[1 - along];
    let line = HoldingLine {
        along,
        across,
        angle,
    };
    Some(Hold {
        point,
        line: Some(line),
    })
}
