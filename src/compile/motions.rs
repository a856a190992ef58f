//! Prescribed motions as terms.

use super::numbering::Numbering;
use super::{Compiler, Role};
use crate::constraint::{Align, Place};
use crate::math::plane::Vec2;
use crate::scene::MotionKind;
use crate::terms::{ConstraintTerm, CoupleTerm, JointTerms, Owner, Terms};
use std::collections::HashSet;

/// Prescribed motions that are constraints, not rules of known coordinates.
pub(super) fn motion_terms(
    c: &Compiler,
    numbering: &Numbering,
    own: &mut [JointTerms],
    terms: &mut Terms,
) {
    let turning: HashSet<usize> = c.roles.iter().filter_map(Role::turned).collect();
    for (m, motion) in c.scene.motions.iter().enumerate() {
        let name = &format!("drive {}", motion.name);
        let span = motion.span;
        match &motion.kind {
            MotionKind::Angle { joint, angle } => {
                if turning.contains(&m) {
                    continue;
                }
                let points = c.scene.joints[*joint].points();
                let sides = points.map(|p| p.body);
                let [first, second] = points.map(|p| numbering.bodies[p.body].spin(p.point));
                let align = Align {
                    first,
                    second,
                    angle: angle.clone(),
                    scale: sides.map(|b| c.inverse_size(b)).iter().product(),
                };
                let term = ConstraintTerm::Other(Box::new(align));
                let row = terms.constrain(term, Owner { name, sides, span }, &["angle"]);
                own[*joint].couple = Some(CoupleTerm::Constraint(row));
                own[*joint].turned = Some([first, second]);
            }
            MotionKind::Point { point, coordinates } => {
                for (i, value) in coordinates.iter().enumerate() {
                    if let Some(value) = value {
                        let place = Place {
                            marker: numbering.bodies[point.body].marker(point.point),
                            direction: [Vec2::x(), Vec2::y()][i],
                            value: value.clone(),
                        };
                        let part = [["x"], ["y"]][i];
                        let sides = [point.body, point.body];
                        let term = ConstraintTerm::Other(Box::new(place));
                        terms.constrain(term, Owner { name, sides, span }, &part);
                    }
                }
            }
        }
    }
}
