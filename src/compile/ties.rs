//! What holds a body, and by which of its joints: from this a body chooses its coordinates.

use super::{Compiler, Role, numbering};
use crate::body::{Hold, HoldingLine, PointRef, Ties};
use crate::interaction::Freedom;
use crate::scene::SceneError;
use std::f64::consts::FRAC_PI_2;

/// The ties of every body.
pub(super) fn of_bodies(c: &Compiler) -> Result<Vec<Ties>, SceneError> {
    let shared = numbering::shared_nodes(c)?;
    let mut all = vec![Ties::default(); c.bodies.len()];
    for (joint, shared) in shared.into_iter().enumerate() {
        let [bearing, journal] = c.scene.joints[joint].points();
        for (own, other) in [(bearing, journal), (journal, bearing)] {
            let ties = &mut all[own.body];
            if shared && c.node(own).is_some() {
                match c.is_known(other) {
                    true => ties.anchored += 1,
                    false => ties.shares = true,
                }
            }
            if c.is_known(other) && !c.is_known(own) {
                ties.holds.extend(hold(c, joint, own, other));
            }
        }
    }
    Ok(all)
}

/// How a joint holds the body of `own` on the known point `other`, if it leaves one coordinate.
fn hold(c: &Compiler, joint: usize, own: PointRef, other: PointRef) -> Option<Hold> {
    let line = match c.joints[joint].leaves()? {
        Freedom::Turn => None,
        Freedom::Slide { direction, angle } => {
            // a direction along an axis is an exact multiple of a quarter turn
            let quarters = direction / FRAC_PI_2;
            let is_guide = other == c.scene.joints[joint].bearing;
            if !is_guide || c.roles[other.body] != Role::Ground || quarters.fract() != 0.0 {
                return None;
            }
            let along = quarters.rem_euclid(2.0) as usize;
            Some(HoldingLine {
                along,
                across: c.bodies[other.body].points()[other.point].at[1 - along],
                angle,
            })
        }
    };
    Some(Hold {
        joint,
        point: own.point,
        line,
    })
}
