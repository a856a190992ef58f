//! `type = "rigid_body"`: x, y of the centre of mass, theta.

use super::{
    Body, BodyKind, Content, Frame, Levels, Material, Materials, Point, Pose, Slot, points,
};
use crate::document::{Fields, Key, SceneError, Takes, derived};
use crate::marker::{Marker, Spin};
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
        Key::new("points", Takes::Table, "named points at theta = 0 [m]").or("none"),
    ],
    read: |table, known| {
        let (mass, inertia) = inertia(table, known)?;
        let center = table.optional_vector("center_of_mass")?.unwrap_or([0.0; 2]);
        let mut points = points::read(table)?;
        for point in &mut points {
            point.at = [point.at[0] - center[0], point.at[1] - center[1]];
        }
        Ok(Arc::new(RigidBody {
            mass,
            inertia,
            points,
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
}

impl Body for RigidBody {
    fn points(&self) -> &[Point] {
        &self.points
    }

    fn slots(&self) -> Vec<Slot> {
        vec![Slot::own(String::new(), Content::Pose)]
    }

    fn mass(&self) -> Option<f64> {
        Some(self.mass)
    }

    fn size(&self) -> f64 {
        (self.inertia / self.mass).sqrt()
    }

    fn lever(&self, _: usize) -> f64 {
        let arms = self.points.iter().map(|p| p.at[0].hypot(p.at[1]));
        arms.fold(self.size(), f64::max)
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        let s = self.points[point].at;
        Marker::OnBody { x: x[0], s }
    }

    fn spin(&self, _: usize, x: &[usize]) -> Spin {
        Spin::Angle { theta: x[0] + 2 }
    }

    fn terms(&self, x: &[usize], _: Owner, terms: &mut Terms) {
        let (m, i, g) = (self.mass, self.inertia, terms.gravity);
        terms.inertia.push(Inertia {
            coordinates: vec![x[0], x[0] + 1, x[0] + 2],
            values: vec![m, 0.0, 0.0, 0.0, m, 0.0, 0.0, 0.0, i],
            field: vec![g[0], g[1], 0.0],
        });
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        pose(x[0], levels)
    }

    fn frame_at(&self, x: &[usize], q: &[f64], v: &[f64]) -> Option<Frame> {
        let [position, velocity] = [q, v].map(|level| three(level, x[0]));
        Some(Frame { position, velocity })
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        vec![[frame.position, frame.velocity]]
    }

    fn velocity(&self, component: usize, x: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        Some(vec![(x[0] + component, 1.0)])
    }
}

fn three(level: &[f64], x: usize) -> [f64; 3] {
    [level[x], level[x + 1], level[x + 2]]
}

/// The pose of x, y, theta from index `x`.
pub(crate) fn pose(x: usize, levels: Levels) -> Pose {
    let [position, velocity, acceleration] = levels.map(|level| three(level, x));
    Pose {
        position,
        velocity,
        acceleration,
    }
}

const THICKNESS: Key = Key::positive("thickness", "m", "the size normal to the plane");
const PLATE: Key = Key::name_in("material", "materials", "the name of a material");

/// The shapes of a uniform plate and their keys.
pub static PLATES: [(&str, &[Key]); 3] = [
    (
        "equilateral_triangle",
        &[
            Key::positive(
                "circumradius",
                "m",
                "the distance from the centre to a corner",
            ),
            THICKNESS,
            PLATE,
        ],
    ),
    (
        "disc",
        &[Key::positive("radius", "m", "the radius"), THICKNESS, PLATE],
    ),
    (
        "rectangle",
        &[
            Key::positive("width", "m", "one side"),
            Key::positive("height", "m", "the other side"),
            THICKNESS,
            PLATE,
        ],
    ),
];

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
    let mut fields = plate.fields()?;
    let names: Vec<_> = PLATES.iter().map(|(name, _)| format!("{name:?}")).collect();
    let shape = fields.required(
        "shape",
        &format!("the shape of the plate: {}", names.join(", ")),
    )?;
    fields.declare(&["shape"], shape.choice(&PLATES)?)?;
    let size = |key| fields.number(key);
    // area, and moment of inertia over mass
    let (area, gyration) = match shape.text()? {
        "equilateral_triangle" => {
            let r = size("circumradius")?;
            // side s = sqrt(3) r, I = m s^2/12
            (0.75 * 3f64.sqrt() * r * r, r * r / 4.0)
        }
        "disc" => {
            let r = size("radius")?;
            (PI * r * r, r * r / 2.0)
        }
        _ => {
            let (w, h) = (size("width")?, size("height")?);
            (w * h, (w * w + h * h) / 12.0)
        }
    };
    let thickness = size("thickness")?;
    let Material { density, .. } = known.material(&fields, "material")?;
    let mass = match table.optional_number("mass")? {
        Some(typed) => typed,
        None => derived(&plate, "a mass", density * area * thickness)?,
    };
    let inertia = derived(&plate, "a moment of inertia", mass * gyration)?;
    Ok((mass, inertia))
}
