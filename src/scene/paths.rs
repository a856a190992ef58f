//! Paths of bodies: `type` and its keys.

use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::functions::{Use, function, rows};
use crate::motion::{Circle, Coordinates, Line, Path, Table};
use std::f64::consts::TAU;
use std::sync::Arc;

const POSE: &str = "[x, y, theta]";

type Read = fn(&mut Fields, f64) -> Result<Arc<dyn Path>, SceneError>;

/// The kinds, by the name that a scene gives.
const KINDS: [(&str, Read); 4] = [
    ("circle", circle),
    ("line", line),
    ("table", table),
    ("coordinates", coordinates),
];

/// Reads a path of a run of this duration.
pub(super) fn path(field: &Field, duration: f64) -> Result<Arc<dyn Path>, SceneError> {
    let mut fields = field.fields()?;
    let purpose = "\"circle\", \"line\", \"table\" or \"coordinates\"";
    let read = fields.required("type", purpose)?.choice(&KINDS)?;
    read(&mut fields, duration)
}

fn circle(fields: &mut Fields, _: f64) -> Result<Arc<dyn Path>, SceneError> {
    fields.only(&["type", "center", "radius", "frequency", "phase", "theta"])?;
    Ok(Arc::new(Circle {
        center: fields
            .required("center", "the centre of the circle [m]")?
            .numbers("[x, y]")?,
        radius: fields
            .required("radius", "the radius of the circle [m]")?
            .positive()?,
        rate: TAU
            * fields
                .required("frequency", "revolutions a second [Hz]")?
                .number()?,
        phase: fields
            .required("phase", "the angle on the circle at t = 0 [rad]")?
            .number()?,
        theta: fields
            .required("theta", "the orientation of the body [rad]")?
            .number()?,
    }))
}

fn line(fields: &mut Fields, _: f64) -> Result<Arc<dyn Path>, SceneError> {
    fields.only(&["type", "from", "to", "duration"])?;
    Ok(Arc::new(Line {
        from: fields
            .required("from", "the first pose [m, m, rad]")?
            .numbers(POSE)?,
        to: fields
            .required("to", "the last pose [m, m, rad]")?
            .numbers(POSE)?,
        duration: fields
            .required("duration", "the time of travel [s]")?
            .positive()?,
    }))
}

fn coordinates(fields: &mut Fields, duration: f64) -> Result<Arc<dyn Path>, SceneError> {
    fields.only(&["type", "x", "y", "theta"])?;
    let coordinate = |key, purpose| {
        let field = fields.required(key, purpose)?;
        function(&field, Use::Motion, duration)
    };
    Ok(Arc::new(Coordinates {
        functions: [
            coordinate("x", "x as a function of time [m]")?,
            coordinate("y", "y as a function of time [m]")?,
            coordinate("theta", "theta as a function of time [rad]")?,
        ],
    }))
}

fn table(fields: &mut Fields, duration: f64) -> Result<Arc<dyn Path>, SceneError> {
    fields.only(&["type", "rows"])?;
    let field = fields.required("rows", "the rows [t, x, y, theta]")?;
    let rows: Vec<[f64; 4]> = rows(&field, duration, "[t, x, y, theta]")?;
    let times = rows.iter().map(|r| r[0]).collect();
    let poses = rows.iter().map(|r| [r[1], r[2], r[3]]).collect();
    Ok(Arc::new(Table::new(times, poses)))
}
