//! Paths of bodies: `type` and its keys.

use super::read_function::{FunctionReader, SHAPE, Use, is_monotone, rows, rows_key};
use super::{Circle, CubicSpline, Line, MonotoneQuintic, Path};
use crate::document::{Field, Fields, Key, Kind, SceneError};
use std::f64::consts::TAU;
use std::sync::Arc;

const POSE: &str = "[x, y, theta]";
const POSE_UNITS: &str = "m, m, rad";

/// A kind of path. It is read with the functions of time that a scene can name.
pub type PathKind = Kind<fn(&Fields, &FunctionReader) -> Result<Arc<dyn Path>, SceneError>>;

/// The kinds that a scene can name.
pub static PATHS: [&PathKind; 4] = [&CIRCLE, &LINE, &TABLE, &COORDINATES];

static CIRCLE: PathKind = PathKind {
    name: "circle",
    keys: &[
        Key::vector("center", "m", "[x, y]", "the centre"),
        Key::positive("radius", "m", "the radius"),
        Key::number(
            "frequency",
            "Hz",
            "revolutions a second, negative for clockwise",
        ),
        Key::number("phase", "rad", "the angle on the circle at t = 0"),
        Key::number("theta", "rad", "the angle of the body"),
    ],
    read: |fields, _| {
        Ok(Arc::new(Circle {
            center: fields.vector("center")?,
            radius: fields.number("radius")?,
            rate: TAU * fields.number("frequency")?,
            phase: fields.number("phase")?,
            theta: fields.number("theta")?,
        }))
    },
};

static LINE: PathKind = PathKind {
    name: "line",
    keys: &[
        Key::vector("from", POSE_UNITS, POSE, "the first pose"),
        Key::vector("to", POSE_UNITS, POSE, "the last pose"),
        Key::positive("duration", "s", "the time of travel"),
    ],
    read: |fields, _| {
        Ok(Arc::new(Line {
            from: fields.vector("from")?,
            to: fields.vector("to")?,
            duration: fields.number("duration")?,
        }))
    },
};

static TABLE: PathKind = PathKind {
    name: "table",
    keys: &[rows_key("s, m, m, rad", "[t, x, y, theta]"), SHAPE],
    read: |fields, functions| {
        let rows: Vec<[f64; 4]> = rows(&fields.field("rows")?, functions.duration)?;
        let rows = rows.iter();
        let rows = rows.map(|&[t, x, y, theta]| (t, [x, y, theta]));
        if is_monotone(fields)? {
            return Ok(Arc::new(MonotoneQuintic::new(rows)));
        }
        let spline = CubicSpline::new(rows);
        for (i, (name, unit)) in [("x", "m"), ("y", "m"), ("theta", "rad")]
            .iter()
            .enumerate()
        {
            let path = format!("{}.{name}", fields.path());
            functions.note_overshoot(&path, unit, &spline, i);
        }
        Ok(Arc::new(spline))
    },
};

static COORDINATES: PathKind = PathKind {
    name: "coordinates",
    keys: &[
        Key::function("x", "m", "x"),
        Key::function("y", "m", "y"),
        Key::function("theta", "rad", "theta"),
    ],
    read: |fields, functions| {
        let coordinate = |key| functions.read(&fields.field(key)?, Use::Motion);
        let coordinates = [coordinate("x")?, coordinate("y")?, coordinate("theta")?];
        Ok(Arc::new(coordinates))
    },
};

/// Reads a path; its coordinates may be functions of time.
pub(crate) fn read_path(
    field: &Field,
    functions: &FunctionReader,
) -> Result<Arc<dyn Path>, SceneError> {
    let (kind, fields) = Kind::of(field, "path", &PATHS)?;
    (kind.read)(&fields, functions)
}
