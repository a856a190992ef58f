//! `[drives]` and `[initial]`.

use super::bodies::Bodies;
use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::functions::{Use, function};
use super::names::named;
use super::paths::path;
use super::{Body, BodyKind, BodyState, Drive, GivenVelocity, Initial, Joint, JointModel};
use super::{Motion, MotionKind, PointRef, SketchPoint, Sketched};
use super::{forces, joints};
use indexmap::IndexMap;

/// What `[drives]` prescribes.
#[derive(Default)]
pub(super) struct Drives {
    pub kinematics: Vec<Drive>,
    pub motions: Vec<Motion>,
}

pub(super) fn drives(
    root: &Fields,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
    duration: f64,
) -> Result<Drives, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        InverseKinematics,
        Angle,
        Point,
    }
    let types = [
        ("inverse_kinematics", Type::InverseKinematics),
        ("angle", Type::Angle),
        ("point", Type::Point),
    ];
    let mut driven = Vec::new();
    let mut drives = Drives::default();
    named(root.optional("drives"), |field| {
        let mut table = field.fields()?;
        let purpose = "the kind of drive: \"inverse_kinematics\", \"angle\" or \"point\"";
        let kind = match table.required("type", purpose)?.choice(&types)? {
            Type::InverseKinematics => {
                table.only(&["type", "joints", "body", "path"])?;
                let drive =
                    inverse_kinematics(field, &table, bodies, joints, duration, &mut driven)?;
                drives.kinematics.push(drive);
                return Ok(());
            }
            Type::Angle => {
                table.only(&["type", "joint", "angle"])?;
                let name = table.required("joint", "the name of a revolute joint")?;
                let joint = actuated(&name, joints, &mut driven)?;
                for side in [joints[joint].bearing, joints[joint].journal] {
                    forces::turns(&name, side, bodies)?;
                }
                let angle = table.required("angle", "the angle as a function of time [rad]")?;
                MotionKind::Angle {
                    joint,
                    angle: function(&angle, Use::Motion, duration)?,
                }
            }
            Type::Point => {
                table.only(&["type", "point", "x", "y"])?;
                let point_field = table.required("point", "the point, as \"body.point\"")?;
                let point = joints::point(&point_field, bodies)?;
                let (name, body) = bodies.bodies.get_index(point.body).expect("it is there");
                if let BodyKind::Ground { .. } | BodyKind::Moving { .. } = body.kind {
                    let message = format!(
                        "the motion of {name} is known at every time, so its points cannot be driven"
                    );
                    return Err(point_field.fault(message, "not a free body"));
                }
                let coordinate = |key| {
                    let field = table.optional(key);
                    field
                        .map(|f| function(&f, Use::Motion, duration))
                        .transpose()
                };
                let coordinates = [coordinate("x")?, coordinate("y")?];
                if coordinates.iter().all(Option::is_none) {
                    let message = format!("`{}` prescribes neither x nor y", field.path);
                    return Err(field.key_fault(message, "needs `x`, `y` or both"));
                }
                MotionKind::Point { point, coordinates }
            }
        };
        drives.motions.push(Motion {
            name: field.name.clone(),
            span: field.node.span,
            kind,
        });
        Ok(())
    })?;
    Ok(drives)
}

/// The revolute joint that a field names, driven for the first time.
fn actuated(
    field: &Field,
    joints: &IndexMap<String, Joint>,
    driven: &mut Vec<usize>,
) -> Result<usize, SceneError> {
    let (index, joint) = field.lookup("joint", joints)?;
    if !matches!(joint.model, JointModel::Ideal | JointModel::Clearance(_)) {
        let message = format!(
            "the joint `{}` is not revolute, so a drive cannot turn it",
            joint.name
        );
        return Err(field.fault(message, "not a revolute joint"));
    }
    if driven.contains(&index) {
        let message = format!("the joint `{}` is driven twice", joint.name);
        return Err(field.fault(message, "a second time"));
    }
    driven.push(index);
    Ok(index)
}

fn inverse_kinematics(
    field: &Field,
    table: &Fields,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
    duration: f64,
    driven: &mut Vec<usize>,
) -> Result<Drive, SceneError> {
    let list = table.required("joints", "the list of actuated joints")?;
    let items = list.items()?;
    let indices: Result<Vec<usize>, _> = items
        .iter()
        .map(|item| actuated(item, joints, driven))
        .collect();
    let indices = indices?;
    if indices.is_empty() {
        return Err(list.fault(format!("`{}` names no joint", list.path), "empty"));
    }
    let body_field = table.required("body", "the name of the driven rigid body")?;
    let (body, found) = body_field.lookup("body", &bodies.bodies)?;
    if !matches!(found.kind, BodyKind::Rigid(_)) {
        let message = format!(
            "`{}` must be a body of type \"rigid_body\"",
            body_field.path
        );
        return Err(body_field.fault(message, "not a rigid body"));
    }
    let path_field = table.required("path", "the path of the driven body")?;
    Ok(Drive {
        name: field.name.clone(),
        span: field.node.span,
        joints: indices,
        body,
        path: path(&path_field, duration)?,
        path_span: path_field.node.span,
    })
}

pub(super) fn initial(
    root: &Fields,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
) -> Result<Initial, SceneError> {
    let Some(field) = root.optional("initial") else {
        return Ok(Initial {
            sketch: Vec::new(),
            bodies: Vec::new(),
            velocities: Vec::new(),
            equilibrium: false,
            span: root.span,
        });
    };
    let mut table = field.fields()?;
    table.only(&["sketch", "bodies", "velocities", "equilibrium"])?;
    let mut sketch = Vec::new();
    named(table.optional("sketch"), |field| {
        match joints.get_index_of(&field.name) {
            Some(joint) => sketch.push(sketched(field, Sketched::Joint(joint))?),
            None => sketch.extend(sketched_points(field, &bodies.bodies, joints)?),
        }
        Ok(())
    })?;
    let states = named(table.optional("bodies"), |field| {
        state(field, &bodies.bodies)
    })?;
    let mut velocities = Vec::new();
    named(table.optional("velocities"), |field| {
        velocities.extend(given_velocities(field, &bodies.bodies)?);
        Ok(())
    })?;
    let equilibrium = table.optional("equilibrium").map(|f| f.boolean());
    Ok(Initial {
        sketch,
        bodies: states.into_values().collect(),
        velocities,
        equilibrium: equilibrium.transpose()?.unwrap_or(false),
        span: table.span,
    })
}

fn sketched(field: &Field, what: Sketched) -> Result<SketchPoint, SceneError> {
    Ok(SketchPoint {
        what,
        at: field.numbers("[x, y]")?,
        span: field.node.span,
    })
}

/// `sketch.BODY = { POINT = [x, y], ... }`
fn sketched_points(
    field: &Field,
    bodies: &IndexMap<String, Body>,
    joints: &IndexMap<String, Joint>,
) -> Result<Vec<SketchPoint>, SceneError> {
    let Some((body, _, found)) = bodies.get_full(&field.name) else {
        let known = joints.keys().chain(bodies.keys()).map(String::as_str);
        return Err(field.dangling_key("joint or body", known));
    };
    if let BodyKind::Ground { .. } | BodyKind::Moving { .. } = found.kind {
        let message = format!(
            "the position of `{}` is known at every time; a sketch cannot change it",
            field.name
        );
        return Err(field.key_fault(message, "remove this"));
    }
    if !field.is_table() {
        let message = format!("`{}` is a body: the sketch places its points", field.name);
        let help = format!("write `{} = {{ POINT = [x, y] }}`", field.name);
        return Err(field.fault(message, "of which point?").with_help(help));
    }
    let names = joints::point_names(found);
    let points = named(Some(field.clone()), |point| {
        let Some(index) = names.iter().position(|name| *name == point.name) else {
            let kind = format!("point of `{}` called", field.name);
            return Err(point.dangling_key(&kind, names.iter().copied()));
        };
        let what = Sketched::Point(PointRef { body, point: index });
        sketched(point, what)
    })?;
    Ok(points.into_values().collect())
}

/// `velocities.BODY = { vx, vy, omega }`, any of them.
fn given_velocities(
    field: &Field,
    bodies: &IndexMap<String, Body>,
) -> Result<Vec<GivenVelocity>, SceneError> {
    let body = moving_body(field, bodies)?;
    let mut table = field.fields()?;
    table.only(&["vx", "vy", "omega"])?;
    let mut given = Vec::new();
    for (component, key) in ["vx", "vy", "omega"].into_iter().enumerate() {
        if let Some(value) = table.optional(key) {
            if component == 2 && matches!(bodies[body].kind, BodyKind::PointMass { .. }) {
                let message = format!("`{}` is a point mass and does not turn", field.name);
                return Err(value.key_fault(message, "remove this"));
            }
            given.push(GivenVelocity {
                body,
                component,
                value: value.number()?,
                span: value.node.span,
            });
        }
    }
    if given.is_empty() {
        return Err(field.key_fault(
            format!(
                "`{}` gives none of the velocities vx, vy and omega",
                field.path
            ),
            "empty",
        ));
    }
    Ok(given)
}

/// The body that a key names, one that has a state of its own.
fn moving_body(field: &Field, bodies: &IndexMap<String, Body>) -> Result<usize, SceneError> {
    let Some((body, _, found)) = bodies.get_full(&field.name) else {
        return Err(field.dangling_key("body", bodies.keys().map(String::as_str)));
    };
    match found.kind {
        BodyKind::Ground { .. } => {
            let message = format!("`{}` is the ground and has no initial state", field.name);
            Err(field.key_fault(message, "does not move"))
        }
        BodyKind::Moving { .. } => {
            let message = format!(
                "`{}` follows its path, so it cannot be given an initial state",
                field.name
            );
            Err(field.key_fault(message, "prescribed"))
        }
        _ => Ok(body),
    }
}

fn state(field: &Field, bodies: &IndexMap<String, Body>) -> Result<BodyState, SceneError> {
    let body = moving_body(field, bodies)?;
    if let BodyKind::PointMass { .. } = bodies[body].kind {
        return point_state(field, body);
    }
    let mut table = field.fields()?;
    table.only(&["x", "y", "theta", "vx", "vy", "omega"])?;
    let position = [
        table
            .required("x", "the position of the body [m]")?
            .number()?,
        table
            .required("y", "the position of the body [m]")?
            .number()?,
        table
            .required("theta", "the orientation of the body [rad]")?
            .number()?,
    ];
    let velocity_given = ["vx", "vy", "omega"]
        .iter()
        .any(|key| table.optional(key).is_some());
    let mut velocity = [0.0; 3];
    if velocity_given {
        for (v, key) in velocity.iter_mut().zip(["vx", "vy", "omega"]) {
            *v = table
                .required(key, "a velocity; give all three or none")?
                .number()?;
        }
    }
    Ok(BodyState {
        body,
        position,
        velocity,
        velocity_given,
        span: field.node.span,
    })
}

/// The state of a point mass, which has no angle.
fn point_state(field: &Field, body: usize) -> Result<BodyState, SceneError> {
    let mut table = field.fields()?;
    table.only(&["x", "y", "vx", "vy"])?;
    let number = |key: &'static str| {
        table
            .required(key, "the position of the point mass [m]")?
            .number()
    };
    let position = [number("x")?, number("y")?, 0.0];
    let velocity_given = ["vx", "vy"].iter().any(|key| table.optional(key).is_some());
    let mut velocity = [0.0; 3];
    if velocity_given {
        for (v, key) in velocity.iter_mut().zip(["vx", "vy"]) {
            *v = table
                .required(key, "a velocity; give both or none")?
                .number()?;
        }
    }
    Ok(BodyState {
        body,
        position,
        velocity,
        velocity_given,
        span: field.node.span,
    })
}
