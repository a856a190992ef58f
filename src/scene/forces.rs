//! `[forces]`: springs and loads.

use super::bodies::Bodies;
use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::functions::{Use, function};
use super::joints::point;
use super::names::{RESERVED, check_name, named};
use super::{BodyKind, Force, ForceKind, Joint, JointModel, PointRef};
use indexmap::IndexMap;

pub(super) fn read(
    root: &Fields,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
    duration: f64,
) -> Result<Vec<Force>, SceneError> {
    let forces = named(root.optional("forces"), |field| {
        check_name(field, &RESERVED)?;
        let taken = bodies.bodies.contains_key(&field.name) || joints.contains_key(&field.name);
        if taken {
            let message = format!("`{}` names both a force and a body or joint", field.name);
            let help = "channels are called `name.quantity`, so names must differ";
            return Err(field.key_fault(message, "taken").with_help(help));
        }
        Ok(Force {
            name: field.name.clone(),
            span: field.node.span,
            kind: force(field, bodies, joints, duration)?,
        })
    })?;
    Ok(forces.into_values().collect())
}

fn force(
    field: &Field,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
    duration: f64,
) -> Result<ForceKind, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        SpringDamper,
        TorsionSpring,
        Force,
        Torque,
    }
    let types = [
        ("spring_damper", Type::SpringDamper),
        ("torsion_spring", Type::TorsionSpring),
        ("force", Type::Force),
        ("torque", Type::Torque),
    ];
    let mut table = field.fields()?;
    let purpose = "\"spring_damper\", \"torsion_spring\", \"force\" or \"torque\"";
    match table.required("type", purpose)?.choice(&types)? {
        Type::SpringDamper => {
            table.only(&["type", "from", "to", "stiffness", "damping", "rest_length"])?;
            let from = point(
                &table.required("from", "one end, as \"body.point\"")?,
                bodies,
            )?;
            let to_field = table.required("to", "the other end, as \"body.point\"")?;
            let to = point(&to_field, bodies)?;
            if from == to {
                let message = format!("`{}` joins a point to itself", field.path);
                return Err(to_field.fault(message, "the same point"));
            }
            let (stiffness, damping) = rates(field, &table, "N/m", "N s/m")?;
            let rest = table.required("rest_length", "the length without force [m]")?;
            Ok(ForceKind::SpringDamper {
                from,
                to,
                stiffness,
                damping,
                rest_length: rest.non_negative()?,
            })
        }
        Type::TorsionSpring => {
            table.only(&["type", "joint", "stiffness", "damping", "rest_angle"])?;
            let name = table.required("joint", "the name of a revolute joint")?;
            let (index, joint) = name.lookup("joint", joints)?;
            if !matches!(joint.model, JointModel::Ideal | JointModel::Clearance(_)) {
                let message = format!("the joint `{}` is not revolute", joint.name);
                return Err(name.fault(message, "its bodies do not turn freely"));
            }
            for side in [joint.bearing, joint.journal] {
                turns(&name, side, bodies)?;
            }
            let (stiffness, damping) = rates(field, &table, "N m/rad", "N m s/rad")?;
            let rest = table.required("rest_angle", "the angle without torque [rad]")?;
            Ok(ForceKind::TorsionSpring {
                joint: index,
                stiffness,
                damping,
                rest_angle: rest.number()?,
            })
        }
        Type::Force => {
            table.only(&["type", "point", "x", "y", "frame"])?;
            let point_field = table.required("point", "where it acts, as \"body.point\"")?;
            let place = point(&point_field, bodies)?;
            let component = |key, purpose| {
                let field = table.required(key, purpose)?;
                function(&field, Use::Load, duration)
            };
            let components = [
                component("x", "the first component [N]")?,
                component("y", "the second component [N]")?,
            ];
            let purpose =
                "the frame of its components, which a follower turns with: \"ground\" or \"body\"";
            let frames = [("ground", false), ("body", true)];
            let follower = table.required("frame", purpose)?.choice(&frames)?;
            if follower {
                turns(&point_field, place, bodies)?;
            }
            Ok(ForceKind::PointForce {
                point: place,
                components,
                follower,
            })
        }
        Type::Torque => {
            table.only(&["type", "point", "reaction", "value"])?;
            let purpose = "a point of the body it turns, as \"body.point\"";
            let point_field = table.required("point", purpose)?;
            let place = point(&point_field, bodies)?;
            turns(&point_field, place, bodies)?;
            let reaction = table.optional("reaction");
            let reaction = reaction.map(|field| {
                let place = point(&field, bodies)?;
                turns(&field, place, bodies)?;
                Ok(place)
            });
            let reaction = reaction.transpose()?;
            let fixed = |p: PointRef| matches!(bodies.bodies[p.body].kind, BodyKind::Ground { .. });
            if fixed(place) && reaction.is_none_or(fixed) {
                let message = format!("`{}` acts on the ground, which does not move", field.path);
                return Err(point_field.fault(message, "does nothing"));
            }
            let value = table.required("value", "the torque [N m]")?;
            Ok(ForceKind::Torque {
                point: place,
                reaction,
                value: function(&value, Use::Load, duration)?,
            })
        }
    }
}

/// Stiffness and damping, one of them at least.
fn rates(
    field: &Field,
    table: &Fields,
    stiffness_unit: &str,
    damping_unit: &str,
) -> Result<(f64, f64), SceneError> {
    let purpose = format!("the stiffness [{stiffness_unit}]; 0 for a damper");
    let stiffness = table.required("stiffness", &purpose)?.non_negative()?;
    let purpose = format!("the damping [{damping_unit}]; 0 for a spring");
    let damping = table.required("damping", &purpose)?.non_negative()?;
    if stiffness == 0.0 && damping == 0.0 {
        let message = format!("`{}` has neither stiffness nor damping", field.path);
        return Err(field.key_fault(message, "does nothing"));
    }
    Ok((stiffness, damping))
}

/// Refuses a point whose body has no direction.
pub(super) fn turns(field: &Field, point: PointRef, bodies: &Bodies) -> Result<(), SceneError> {
    match bodies.bodies.get_index(point.body) {
        Some((name, body)) if matches!(body.kind, BodyKind::PointMass { .. }) => {
            let message = format!(
                "`{}` needs the direction of {name}, but a point mass has none",
                field.path
            );
            Err(field.fault(message, "a point has no direction"))
        }
        _ => Ok(()),
    }
}
