//! Named points of a body: `points.NAME = [x, y]` or `{ radius, degrees }`.

use crate::document::{Field, Fields, Key, SceneError, named};
use crate::math::plane::{Vec2, unit};

/// A named point.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The name the user wrote.
    pub name: String,
    /// Coordinates in the frame of the body \[m\].
    pub at: Vec2,
}

impl Point {
    pub(super) fn new(name: &str, at: Vec2) -> Point {
        let name = name.to_owned();
        Point { name, at }
    }
}

/// The keys of a point in polar coordinates.
pub static POLAR: [Key; 2] = [
    Key::non_negative("radius", "m", "the distance from the origin"),
    Key::number(
        "degrees",
        "degrees",
        "the direction, counter-clockwise from x",
    ),
];

/// The table `points`.
pub(super) fn read(table: &Fields) -> Result<Vec<Point>, SceneError> {
    let points = named(table.optional("points"), |field| {
        let at = match field.is_table() {
            true => polar(field)?,
            false => field.numbers::<2>("[x, y]")?.into(),
        };
        Ok(Point::new(&field.name, at))
    })?;
    Ok(points.into_values().collect())
}

fn polar(field: &Field) -> Result<Vec2, SceneError> {
    let mut table = field.fields()?;
    table.declare(&[], &POLAR)?;
    let (radius, degrees) = (table.number("radius")?, table.number("degrees")?);
    Ok(radius * unit(degrees.to_radians()))
}
