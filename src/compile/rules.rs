//! Coordinates that are known functions of time.

use super::numbering::Numbering;
use super::{Compiler, Role};
use crate::body::{Content, Known};
use crate::math::plane::Vec2;
use crate::model::Rule;
use crate::scene::MotionKind;

/// The rules: bodies on paths, bodies that turn about a point of the ground.
pub(super) fn rules(c: &Compiler, numbering: &Numbering) -> Vec<Rule> {
    let mut rules = Vec::new();
    for (b, body) in c.bodies.iter().enumerate() {
        let path = match (body.known(), c.roles[b]) {
            (Some(Known::Path(path)), _) => Some(path),
            (None, Role::Path) => c.scene.drives.first().map(|d| &d.path),
            _ => None,
        };
        rules.extend(path.map(|path| Rule::Path {
            x: numbering.bodies[b].x[0],
            path: path.clone(),
        }));
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
    let (x, points) = (&numbering.bodies[b].x, c.bodies[b].points());
    let angle = angle.clone();
    let at = points[own.point].at;
    let pivot = numbering.bodies[ground.body].x[ground.point];
    let (point, theta) = match c.slots[b][0].content {
        Content::Pose => ((x[0], -at), Some(x[0] + 2)),
        _ => {
            let other = 1 - own.point;
            ((x[other], Vec2::new(points[other].at.x - at.x, 0.0)), None)
        }
    };
    Some(Rule::Turn {
        pivot,
        point,
        theta,
        angle,
        sign,
    })
}
