//! Terms of joints and prescribed motions.

use super::Compiler;
use super::Role;
use super::numbering::{Connection, Numbering};
use super::terms::{ForceTerm, JointTerms, Terms};
use crate::constraint::{Align, ClampSlope, Coincide, Place, Slide};
use crate::contact::friction::Ambrosio;
use crate::contact::geometry::CircleInCircle;
use crate::contact::{Rough, Smooth};
use crate::effect::Effect;
use crate::marker::Spin;
use crate::model::{BodyCoordinates, ConstraintTerm};
use crate::scene::{Function, Joint, JointModel, MotionKind, PointRef, SceneError, SlopeClamp};

pub(super) fn joint_terms(
    c: &Compiler,
    numbering: &Numbering,
    j: usize,
    joint: &Joint,
    terms: &mut Terms,
) -> Result<JointTerms, SceneError> {
    let points = [joint.bearing, joint.journal];
    let sides = points.map(|p| p.body);
    let [bearing, journal] = points.map(|p| c.marker(&numbering.bodies[p.body], p));
    let name = format!("joint {}", joint.name);
    let mut line = None;
    let force = match (numbering.connections[j], &joint.model) {
        (Connection::Eliminated, _) => ForceTerm::Eliminated,
        (Connection::Contact, JointModel::Clearance(contact)) => {
            let n = numbering.unknowns;
            if bearing.x() >= n && journal.x() >= n {
                let message = format!(
                    "joint {} has clearance, but both of its points are fixed or prescribed",
                    joint.name
                );
                return Err(c.joint_error(j, message, "nothing here can move"));
            }
            let surface = Smooth {
                geometry: CircleInCircle {
                    bearing,
                    journal,
                    bearing_radius: contact.bearing_radius,
                    clearance: contact.clearance,
                },
                law: contact.normal_law(),
            };
            terms.contacts.push(match contact.friction {
                None => Box::new(surface),
                Some(f) => {
                    let law = Ambrosio {
                        coefficient: f.coefficient,
                        v0: f.v0,
                        v1: f.v1,
                    };
                    let spins = points.map(|p| spin(numbering, p));
                    Box::new(Rough::new(surface, Box::new(law), f.slip, spins))
                }
            });
            ForceTerm::Contact(terms.contacts.len() - 1)
        }
        (_, JointModel::Prismatic { direction, .. }) => {
            let slide = Slide {
                guide: bearing,
                spin: spin(numbering, joint.bearing),
                angle: *direction,
                scale: c.inverse_size(joint.bearing.body, numbering),
                slider: journal,
            };
            line = Some(slide);
            let row = terms.constrain(
                ConstraintTerm::Other(Box::new(slide)),
                Effect::Slide,
                &name,
                &["line"],
                sides,
                joint.span,
            );
            ForceTerm::Constraint(row)
        }
        _ => {
            let coincide = Coincide { bearing, journal };
            let row = terms.constrain(
                ConstraintTerm::Coincide(coincide),
                Effect::Coincidence,
                &name,
                &["x", "y"],
                sides,
                joint.span,
            );
            ForceTerm::Constraint(row)
        }
    };
    Ok(JointTerms {
        force,
        couple: couple(c, numbering, joint, terms),
        turned: None,
        slide: line,
    })
}

/// The constraint of directions of a weld or a locked guide.
fn couple(c: &Compiler, numbering: &Numbering, joint: &Joint, terms: &mut Terms) -> Option<usize> {
    let points = [joint.bearing, joint.journal];
    let (angle, slope) = match joint.model {
        JointModel::Weld { angle, slope } => (angle, slope),
        JointModel::Prismatic { locked, .. } => (locked?, SlopeClamp::Direction),
        JointModel::Ideal | JointModel::Clearance(_) => return None,
    };
    let name = format!("joint {}", joint.name);
    let spins = points.map(|p| spin(numbering, p));
    let sides = points.map(|p| p.body);
    // a slope is held relative to the other side, on either side of the joint
    let held = match (slope, spins) {
        (SlopeClamp::Vector, [_, Spin::Slope { x }]) => Some((0, x, angle)),
        (SlopeClamp::Vector, [Spin::Slope { x }, _]) => Some((1, x, -angle)),
        _ => None,
    };
    Some(match held {
        Some((other, slope, angle)) => {
            let clamp = ClampSlope {
                first: spins[other],
                slope,
                angle,
                scale: c.inverse_size(sides[other], numbering),
                sign: if other == 0 { 1.0 } else { -1.0 },
            };
            let sides = [sides[other], sides[1 - other]];
            terms.constrain(
                ConstraintTerm::Other(Box::new(clamp)),
                Effect::Direction,
                &name,
                &["slope x", "slope y"],
                sides,
                joint.span,
            )
        }
        None => {
            let align = Align {
                first: spins[0],
                second: spins[1],
                angle: Function::Constant(angle),
                scale: sides.map(|b| c.inverse_size(b, numbering)).iter().product(),
            };
            terms.constrain(
                ConstraintTerm::Other(Box::new(align)),
                Effect::Direction,
                &name,
                &["angle"],
                sides,
                joint.span,
            )
        }
    })
}

/// Prescribed motions that are constraints, not rules of known coordinates.
pub(super) fn motion_terms(
    c: &Compiler,
    numbering: &Numbering,
    own: &mut [JointTerms],
    terms: &mut Terms,
) {
    for (m, motion) in c.scene.motions.iter().enumerate() {
        let name = format!("drive {}", motion.name);
        match &motion.kind {
            MotionKind::Angle { joint, angle } => {
                if c.roles.contains(&Role::Turned(m)) {
                    continue;
                }
                let points = [
                    c.scene.joints[*joint].bearing,
                    c.scene.joints[*joint].journal,
                ];
                let sides = points.map(|p| p.body);
                let [first, second] = points.map(|p| spin(numbering, p));
                let align = Align {
                    first,
                    second,
                    angle: angle.clone(),
                    scale: sides.map(|b| c.inverse_size(b, numbering)).iter().product(),
                };
                let row = terms.constrain(
                    ConstraintTerm::Other(Box::new(align)),
                    Effect::Direction,
                    &name,
                    &["angle"],
                    sides,
                    motion.span,
                );
                own[*joint].couple = Some(row);
                own[*joint].turned = Some([first, second]);
            }
            MotionKind::Point { point, coordinates } => {
                for (i, value) in coordinates.iter().enumerate() {
                    if let Some(value) = value {
                        let place = Place {
                            marker: c.marker(&numbering.bodies[point.body], *point),
                            direction: [[1.0, 0.0], [0.0, 1.0]][i],
                            value: value.clone(),
                        };
                        let part = [["x"], ["y"]][i];
                        let sides = [point.body, point.body];
                        terms.constrain(
                            ConstraintTerm::Other(Box::new(place)),
                            Effect::Place,
                            &name,
                            &part,
                            sides,
                            motion.span,
                        );
                    }
                }
            }
        }
    }
}

/// The rotation of the body at a point.
pub(super) fn spin(numbering: &Numbering, point: PointRef) -> Spin {
    match &numbering.bodies[point.body] {
        BodyCoordinates::Ground { .. } | BodyCoordinates::PointMass { .. } => Spin::Fixed,
        BodyCoordinates::Rigid { x } => Spin::Angle { theta: x + 2 },
        BodyCoordinates::RigidLink { ends } => Spin::Chord {
            from: ends[0],
            to: ends[1],
        },
        BodyCoordinates::FlexibleLink { slopes, points, .. } => Spin::Slope {
            x: slopes[points[point.point]],
        },
    }
}
