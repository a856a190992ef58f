//! `[drives]` and `[initial]`.

use super::bodies::Bodies;
use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::names::named;
use super::{Body, BodyKind, BodyState, Drive, Initial, Joint, Path2, SketchPoint};
use indexmap::IndexMap;

const POSE: &str = "[x, y, theta]";

pub(super) fn drives(
    root: &Fields,
    bodies: &Bodies,
    joints: &IndexMap<String, Joint>,
    duration: f64,
) -> Result<Vec<Drive>, SceneError> {
    let mut driven = Vec::new();
    let drives = named(root.optional("drives"), |field| {
        let mut table = field.fields()?;
        table.only(&["type", "joints", "body", "path"])?;
        let purpose = "the kind of drive: \"inverse_kinematics\"";
        table
            .required("type", purpose)?
            .choice(&[("inverse_kinematics", ())])?;
        let list = table.required("joints", "the list of actuated joints")?;
        let mut actuated = Vec::new();
        for item in list.items()? {
            let (index, joint) = item.lookup("joint", joints)?;
            if driven.contains(&index) {
                let message = format!("the joint `{}` is driven twice", joint.name);
                return Err(item.fault(message, "a second time"));
            }
            driven.push(index);
            actuated.push(index);
        }
        if actuated.is_empty() {
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
        let path = path(&path_field, duration)?;
        Ok(Drive {
            name: field.name.clone(),
            span: field.node.span,
            joints: actuated,
            body,
            path,
            path_span: path_field.node.span,
        })
    })?;
    Ok(drives.into_values().collect())
}

fn path(field: &Field, duration: f64) -> Result<Path2, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        Circle,
        Line,
        Table,
    }
    let mut table = field.fields()?;
    let types = [
        ("circle", Type::Circle),
        ("line", Type::Line),
        ("table", Type::Table),
    ];
    match table
        .required("type", "\"circle\", \"line\" or \"table\"")?
        .choice(&types)?
    {
        Type::Circle => {
            table.only(&["type", "center", "radius", "frequency", "phase", "theta"])?;
            Ok(Path2::Circle {
                center: table
                    .required("center", "the centre of the circle [m]")?
                    .numbers("[x, y]")?,
                radius: table
                    .required("radius", "the radius of the circle [m]")?
                    .positive()?,
                frequency: table
                    .required("frequency", "revolutions a second [Hz]")?
                    .number()?,
                phase: table
                    .required("phase", "the angle on the circle at t = 0 [rad]")?
                    .number()?,
                theta: table
                    .required("theta", "the orientation of the body [rad]")?
                    .number()?,
            })
        }
        Type::Line => {
            table.only(&["type", "from", "to", "duration"])?;
            Ok(Path2::Line {
                from: table
                    .required("from", "the first pose [m, m, rad]")?
                    .numbers(POSE)?,
                to: table
                    .required("to", "the last pose [m, m, rad]")?
                    .numbers(POSE)?,
                duration: table
                    .required("duration", "the time of travel [s]")?
                    .positive()?,
            })
        }
        Type::Table => {
            table.only(&["type", "rows"])?;
            let rows = table.required("rows", "the rows [t, x, y, theta]")?;
            Ok(Path2::Table {
                rows: self::rows(&rows, duration)?,
            })
        }
    }
}

fn rows(field: &Field, duration: f64) -> Result<Vec<[f64; 4]>, SceneError> {
    let items = field.items()?;
    let mut rows: Vec<[f64; 4]> = Vec::with_capacity(items.len());
    for item in &items {
        let row = item.numbers("[t, x, y, theta]")?;
        if let Some(last) = rows.last().filter(|last| row[0] <= last[0]) {
            let message = format!(
                "the times of `{}` must increase: {:?} after {:?}",
                field.path, row[0], last[0]
            );
            return Err(item.fault(message, "not later than the row before"));
        }
        rows.push(row);
    }
    let [first, .., last] = &rows[..] else {
        return Err(field.fault(
            format!("`{}` needs two rows or more", field.path),
            "too short",
        ));
    };
    if first[0] > 0.0 {
        let message = format!(
            "the first time of `{}` must not be later than 0",
            field.path
        );
        return Err(items[0].fault(message, "starts too late"));
    }
    if last[0] < duration {
        let message = format!(
            "the last time of `{}` must reach the duration of {duration} s",
            field.path
        );
        return Err(items[items.len() - 1].fault(message, "ends too early"));
    }
    Ok(rows)
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
            span: root.span,
        });
    };
    let mut table = field.fields()?;
    table.only(&["sketch", "bodies"])?;
    let sketch = named(table.optional("sketch"), |field| {
        let Some(joint) = joints.get_index_of(&field.name) else {
            return Err(field.dangling_key("joint", joints.keys().map(String::as_str)));
        };
        Ok(SketchPoint {
            joint,
            at: field.numbers("[x, y]")?,
            span: field.node.span,
        })
    })?;
    let states = named(table.optional("bodies"), |field| {
        state(field, &bodies.bodies)
    })?;
    Ok(Initial {
        sketch: sketch.into_values().collect(),
        bodies: states.into_values().collect(),
        span: table.span,
    })
}

fn state(field: &Field, bodies: &IndexMap<String, Body>) -> Result<BodyState, SceneError> {
    let Some((body, _, found)) = bodies.get_full(&field.name) else {
        return Err(field.dangling_key("body", bodies.keys().map(String::as_str)));
    };
    if matches!(found.kind, BodyKind::Ground { .. }) {
        let message = format!("`{}` is ground and has no state", field.name);
        return Err(field.key_fault(message, "does not move"));
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
