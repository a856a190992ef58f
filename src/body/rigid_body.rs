//! `type = "rigid_body"`: x, y of the centre of mass, theta.

use super::{Body, BodyKind, HeldBody, Material, Materials, Point, Ties, points, pose};
use crate::document::{Fields, Key, Kind, SceneError, Takes, derived};
use crate::math::plane::Vec2;
use crate::terms::{Inertia, Owner, Terms};
use std::f64::consts::PI;
use std::sync::Arc;

pub(super) static KIND: BodyKind = BodyKind {
    name: "rigid_body",
    keys: &[
        Key::positive(
            "mass",
            "kg",
            "the mass; with a plate it replaces the plate's mass and scales its inertia",
        )
        .or("required without `plate`"),
        Key::positive(
            "inertia",
            "kg m2",
            "the moment of inertia about the centre of mass; excludes `plate`",
        )
        .or("required without `plate`"),
        Key::new(
            "plate",
            Takes::Table,
            "a uniform plate that gives mass and inertia",
        )
        .or("none"),
        Key::vector(
            "center_of_mass",
            "m",
            "[x, y]",
            "the centre of mass in the frame in which `points` are written",
        )
        .or("[0, 0]"),
        COORDINATES.or(AS_IT_IS_HELD),
        Key::new("points", Takes::Table, "named points at theta = 0 [m]").or("none"),
    ],
    read: |table, known| {
        let (mass, inertia) = inertia(table, known)?;
        let center = table.optional_vector::<2>("center_of_mass")?;
        let center = Vec2::from(center.unwrap_or_default());
        let mut points = points::read(table)?;
        for point in &mut points {
            point.at -= center;
        }
        Ok(Arc::new(RigidBody {
            mass,
            inertia,
            points,
            radius: None,
            may_be_held: may_be_held(table)?,
        }))
    },
};

/// A rigid body in reference-point coordinates (x, y, theta) of its centre of mass.
#[derive(Debug, Clone)]
pub struct RigidBody {
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia about the centre of mass \[kg m2\].
    pub inertia: f64,
    /// Named points relative to the centre of mass at theta = 0 \[m\].
    pub points: Vec<Point>,
    /// Radius of a disc about the centre of mass \[m\].
    pub radius: Option<f64>,
    /// Whether it may have the one coordinate that a joint leaves it.
    pub may_be_held: bool,
}

/// The unknowns of a rigid body.
pub(super) const COORDINATES: Key = Key::word(
    "coordinates",
    &["center"],
    "the unknowns, see [Coordinates of rigid bodies](#coordinates-of-rigid-bodies)",
);
/// The coordinates without the key.
pub(super) const AS_IT_IS_HELD: &str = "what fits its joints";

/// Whether a body may have the coordinate that a joint leaves it.
pub(super) fn may_be_held(table: &Fields) -> Result<bool, SceneError> {
    Ok(table.optional_word("coordinates")?.is_none())
}

impl Body for RigidBody {
    fn points(&self) -> &[Point] {
        &self.points
    }

    fn mass(&self) -> Option<f64> {
        Some(self.mass)
    }

    fn size(&self) -> f64 {
        (self.inertia / self.mass).sqrt()
    }

    fn radius(&self) -> Option<f64> {
        self.radius
    }

    fn lever(&self, _: usize) -> f64 {
        let arms = self.points.iter().map(|p| p.at.x.hypot(p.at.y));
        arms.fold(self.size(), f64::max)
    }

    fn terms(&self, x: &[usize], _: Owner, terms: &mut Terms) {
        let inertia = Inertia::of_pose(pose(x), self.mass, self.inertia, terms.gravity);
        terms.inertia.push(inertia);
    }

    fn real(&self, ties: &Ties) -> Option<Arc<dyn Body>> {
        let [hold] = ties.holds[..] else {
            return None;
        };
        self.may_be_held.then(|| -> Arc<dyn Body> {
            let body = Arc::new(self.clone());
            let (mass, inertia) = (self.mass, self.inertia);
            Arc::new(HeldBody::new(body, mass, inertia, Vec2::zeros(), hold))
        })
    }
}

/// A shape of a uniform plate. `read` gives the area \[m2\], and the moment of inertia over the mass \[m2\].
pub type Plate = Kind<fn(&Fields) -> Result<[f64; 2], SceneError>>;

pub(super) const THICKNESS: Key = Key::positive("thickness", "m", "the size normal to the plane");
pub(super) const MATERIAL: Key = Key::name_in("material", "materials", "the name of a material");

/// The shapes of a uniform plate.
pub static PLATES: [&Plate; 3] = [
    &Plate {
        name: "equilateral_triangle",
        keys: &[
            Key::positive(
                "circumradius",
                "m",
                "the distance from the centre to a corner",
            ),
            THICKNESS,
            MATERIAL,
        ],
        read: |table| {
            let r = table.number("circumradius")?;
            // side s = sqrt(3) r, I = m s^2/12
            Ok([0.75 * 3f64.sqrt() * r * r, r * r / 4.0])
        },
    },
    &Plate {
        name: "disc",
        keys: &[
            Key::positive("radius", "m", "the radius"),
            THICKNESS,
            MATERIAL,
        ],
        read: |table| Ok(disc(table.number("radius")?)),
    },
    &Plate {
        name: "rectangle",
        keys: &[
            Key::positive("width", "m", "one side"),
            Key::positive("height", "m", "the other side"),
            THICKNESS,
            MATERIAL,
        ],
        read: |table| {
            let (w, h) = (table.number("width")?, table.number("height")?);
            Ok([w * h, (w * w + h * h) / 12.0])
        },
    },
];

/// Area \[m2\] and moment of inertia over mass \[m2\] of a disc.
pub(super) fn disc(radius: f64) -> [f64; 2] {
    [PI * radius * radius, radius * radius / 2.0]
}

/// Mass \[kg\] of a uniform plate of this area.
pub(super) fn plate_mass(table: &Fields, known: &Materials, area: f64) -> Result<f64, SceneError> {
    let Material { density, .. } = known.material(table, "material")?;
    let thickness = table.field("thickness")?;
    derived(
        &thickness,
        "a mass",
        density * area * table.number("thickness")?,
    )
}

/// Mass \[kg\] and moment of inertia \[kg m2\], typed or those of a uniform plate; a mass typed beside a plate
/// replaces that of its material and scales the inertia with it.
fn inertia(table: &Fields, known: &Materials) -> Result<(f64, f64), SceneError> {
    let Some(plate) = table.optional("plate") else {
        return Ok((table.number("mass")?, table.number("inertia")?));
    };
    if let Some(typed) = table.optional("inertia") {
        let message = format!("`{}` is already given by the plate", typed.path);
        return Err(typed.key_fault(message, "remove this or the plate"));
    }
    let (shape, fields) = Kind::by("shape", &plate, "the shape of the plate", &PLATES)?;
    let [area, gyration] = (shape.read)(&fields)?;
    let own = plate_mass(&fields, known, area)?;
    let mass = table.optional_number("mass")?.unwrap_or(own);
    Ok((
        mass,
        derived(&plate, "a moment of inertia", mass * gyration)?,
    ))
}
