//! Coordinates that are known functions of time.

use super::numbering::Numbering;
use super::{Compiler, Role};
use crate::model::{BodyCoordinates, Rule};
use crate::scene::{BodyKind, MotionKind};

/// The rules: bodies on paths, bodies that turn about a point of the ground.
pub(super) fn rules(c: &Compiler, numbering: &Numbering) -> Vec<Rule> {
    let mut rules = Vec::new();
    for (b, body) in c.scene.bodies.iter().enumerate() {
        let coordinates = &numbering.bodies[b];
        let path = match (&body.kind, c.roles[b]) {
            (BodyKind::Moving { path, .. }, _) => Some(path),
            (_, Role::Path) => c.scene.drives.first().map(|d| &d.path),
            _ => None,
        };
        if let (Some(path), BodyCoordinates::Rigid { x }) = (path, coordinates) {
            rules.push(Rule::Path {
                x: *x,
                path: path.clone(),
            });
        }
        if let Role::Turned(motion) = c.roles[b] {
            rules.extend(turn(c, numbering, b, motion));
        }
    }
    rules
}

/// The rule of a body that motion `m` turns about a point of the ground.
fn turn(c: &Compiler, numbering: &Numbering, b: usize, m: usize) -> Option<Rule> {
    let MotionKind::Angle { joint, angle } = &c.scene.motions[m].kind else {
        return None;
    };
    let joint = &c.scene.joints[*joint];
    // the angle is that of the journal's body relative to the bearing's
    let (own, ground, sign) = if joint.journal.body == b {
        (joint.journal, joint.bearing, 1.0)
    } else {
        (joint.bearing, joint.journal, -1.0)
    };
    let pivot = match &numbering.bodies[ground.body] {
        BodyCoordinates::Ground { points } => points[ground.point],
        _ => return None,
    };
    match (&numbering.bodies[b], &c.scene.bodies[b].kind) {
        (BodyCoordinates::Rigid { x }, BodyKind::Rigid(rigid)) => {
            let s = rigid.points[own.point].at;
            Some(Rule::Turn {
                pivot,
                point: (*x, [-s[0], -s[1]]),
                theta: Some(x + 2),
                angle: angle.clone(),
                sign,
            })
        }
        (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) => {
            let along = if own.point == 0 {
                link.length
            } else {
                -link.length
            };
            Some(Rule::Turn {
                pivot,
                point: (ends[1 - own.point], [along, 0.0]),
                theta: None,
                angle: angle.clone(),
                sign,
            })
        }
        _ => None,
    }
}
