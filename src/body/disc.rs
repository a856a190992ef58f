//! `type = "disc"`: a rigid disc about its centre of mass, with a point on its rim.

use super::rigid_body::{
    AS_IT_IS_HELD, COORDINATES, MATERIAL, THICKNESS, disc, may_be_held, plate_mass,
};
use super::{BodyKind, Materials, Point, RigidBody, points};
use crate::document::{Fields, Key, SceneError, Takes, derived};
use crate::math::plane::{Vec2, unit};
use std::sync::Arc;

pub(super) static KIND: BodyKind = BodyKind {
    name: "disc",
    keys: &[
        Key::positive("radius", "m", "the radius"),
        Key::positive("mass", "kg", "the mass; or give `thickness` and `material`")
            .or("that of the material"),
        THICKNESS.or("required without mass"),
        MATERIAL.or("required without mass"),
        Key::number(
            "rim",
            "rad",
            "the direction from `center` to `rim`, from the x axis of the disc",
        )
        .or("0"),
        COORDINATES.or(AS_IT_IS_HELD),
        Key::new(
            "points",
            Takes::Table,
            "named points relative to the centre [m]",
        )
        .or("none"),
    ],
    read: |table, known| {
        let radius = table.number("radius")?;
        let rim = table.optional_number("rim")?.unwrap_or(0.0);
        let mut all = vec![
            Point::new("center", Vec2::zeros()),
            Point::new("rim", radius * unit(rim)),
        ];
        let named = points::read(table)?;
        if let Some(double) = named
            .iter()
            .find(|p| all.iter().any(|own| own.name == p.name))
        {
            let message = format!("every disc has a point `{}` already", double.name);
            return Err(table.fault(message, "name the point otherwise"));
        }
        all.extend(named);
        let mass = mass(table, known, radius)?;
        let [_, gyration] = disc(radius);
        let inertia = derived(
            &table.field("radius")?,
            "a moment of inertia",
            mass * gyration,
        )?;
        Ok(Arc::new(RigidBody {
            mass,
            inertia,
            points: all,
            radius: Some(radius),
            may_be_held: may_be_held(table)?,
        }))
    },
};

/// Mass \[kg\], typed or that of the material.
fn mass(table: &Fields, known: &Materials, radius: f64) -> Result<f64, SceneError> {
    let mut plate = ["thickness", "material"].into_iter();
    let plate = plate.find_map(|key| table.optional(key));
    match (table.optional_number("mass")?, plate) {
        (Some(_), Some(second)) => {
            let message = format!("`{}` cannot be combined with a given `mass`", second.path);
            Err(second.key_fault(message, "remove this or the mass"))
        }
        (Some(mass), None) => Ok(mass),
        (None, _) => {
            let [area, _] = disc(radius);
            plate_mass(table, known, area)
        }
    }
}
