//! `[bodies]`.

use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::materials::{Material, Section, lacks, material, section};
use super::names::{check_name, derived, named};
use super::{Body, BodyKind, Link, LinkModel, Point, RigidBody};
use indexmap::IndexMap;
use std::f64::consts::PI;

/// More elements in one link than any convergence study needs.
const MOST_ELEMENTS: i64 = 10_000;

/// The bodies and what joints need besides.
pub(super) struct Bodies {
    pub bodies: IndexMap<String, Body>,
    pub materials: IndexMap<String, Material>,
}

pub(super) fn read(root: &Fields) -> Result<Bodies, SceneError> {
    let materials = named(root.optional("materials"), material)?;
    let sections = named(root.optional("sections"), section)?;
    let table = root.required("bodies", "the tables of ground, links and rigid bodies")?;
    let bodies = named(Some(table), |field| {
        check_name(field, &["error", "energy", "t"])?;
        let span = field.node.span;
        let kind = body(field, &materials, &sections)?;
        Ok(Body {
            name: field.name.clone(),
            span,
            kind,
        })
    })?;
    let mut grounds = bodies
        .values()
        .filter(|b| matches!(b.kind, BodyKind::Ground { .. }));
    let table = root.required("bodies", "")?;
    let Some(ground) = grounds.next() else {
        let error = table.key_fault("the scene has no body of type \"ground\"", "no ground here");
        return Err(error.with_help("add `[bodies.ground]` with `type = \"ground\"`"));
    };
    if let Some(second) = grounds.next() {
        let message = format!("`{}` and `{}` are both ground", ground.name, second.name);
        return Err(SceneError::new(
            root.sources,
            second.span,
            message,
            "a second ground".into(),
        ));
    }
    Ok(Bodies { bodies, materials })
}

fn body(
    field: &Field,
    materials: &IndexMap<String, Material>,
    sections: &IndexMap<String, Section>,
) -> Result<BodyKind, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        Ground,
        Link,
        Rigid,
    }
    let mut table = field.fields()?;
    let types = [
        ("ground", Type::Ground),
        ("link", Type::Link),
        ("rigid_body", Type::Rigid),
    ];
    let purpose = "the kind of body: \"ground\", \"link\" or \"rigid_body\"";
    match table.required("type", purpose)?.choice(&types)? {
        Type::Ground => {
            table.only(&["type", "points"])?;
            Ok(BodyKind::Ground {
                points: points(&table)?,
            })
        }
        Type::Link => {
            table.only(&["type", "model", "length", "section", "material", "elements"])?;
            Ok(BodyKind::Link(link(&table, materials, sections)?))
        }
        Type::Rigid => {
            table.only(&["type", "mass", "inertia", "plate", "points"])?;
            let (mass, inertia) = inertia(&table, materials)?;
            Ok(BodyKind::Rigid(RigidBody {
                mass,
                inertia,
                points: points(&table)?,
            }))
        }
    }
}

fn link(
    table: &Fields,
    materials: &IndexMap<String, Material>,
    sections: &IndexMap<String, Section>,
) -> Result<Link, SceneError> {
    let purpose = "how the link deforms: \"rigid\" or \"flexible\"";
    let flexible = table
        .required("model", purpose)?
        .choice(&[("rigid", false), ("flexible", true)])?;
    let length = table
        .required("length", "the length of the link [m]")?
        .positive()?;
    let (_, section) = table
        .required("section", "the name of a section")?
        .lookup("section", sections)?;
    let material_field = table.required("material", "the name of a material")?;
    let (_, material) = material_field.lookup("material", materials)?;
    let purpose = "the number of equal finite elements of a flexible link";
    let elements = match flexible {
        true => Some(table.required("elements", purpose)?),
        false => table.optional("elements"),
    };
    let elements = match elements.map(|field| (field.integer(), field)) {
        None => 1,
        Some((Ok(n), _)) if (1..=MOST_ELEMENTS).contains(&n) => n as usize,
        Some((Ok(_), field)) => return Err(field.must("lie between 1 and 10000")),
        Some((Err(error), _)) => return Err(error),
    };
    let model = match (flexible, material.youngs_modulus) {
        (false, _) => LinkModel::Rigid,
        (true, Some(youngs_modulus)) => LinkModel::Flexible {
            elements,
            youngs_modulus,
        },
        (true, None) => return Err(lacks(&material_field, "youngs_modulus")),
    };
    Ok(Link {
        length,
        area: section.area,
        second_moment: section.second_moment,
        density: material.density,
        model,
    })
}

/// Mass \[kg\] and moment of inertia \[kg m2\], typed or those of a uniform plate; a mass typed beside a plate
/// replaces that of its material and scales the inertia with it.
fn inertia(
    table: &Fields,
    materials: &IndexMap<String, Material>,
) -> Result<(f64, f64), SceneError> {
    let Some(plate) = table.optional("plate") else {
        let mass = table
            .required("mass", "the mass [kg]; or describe a `plate`")?
            .positive()?;
        let purpose = "the moment of inertia about the centre of mass [kg m2]";
        return Ok((mass, table.required("inertia", purpose)?.positive()?));
    };
    if let Some(typed) = table.optional("inertia") {
        let message = format!("`{}` is given by the plate already", typed.path);
        return Err(typed.key_fault(message, "remove this or the plate"));
    }
    #[derive(Clone, Copy)]
    enum Shape {
        Triangle,
        Disc,
        Rectangle,
    }
    let mut fields = plate.fields()?;
    let shapes = [
        ("equilateral_triangle", Shape::Triangle),
        ("disc", Shape::Disc),
        ("rectangle", Shape::Rectangle),
    ];
    let purpose = "\"equilateral_triangle\", \"disc\" or \"rectangle\"";
    let shape = fields.required("shape", purpose)?.choice(&shapes)?;
    fields.only(match shape {
        Shape::Triangle => &["shape", "circumradius", "thickness", "material"],
        Shape::Disc => &["shape", "radius", "thickness", "material"],
        Shape::Rectangle => &["shape", "width", "height", "thickness", "material"],
    })?;
    let size = |key, purpose| fields.required(key, purpose)?.positive();
    // Area, and moment of inertia over mass.
    let (area, gyration) = match shape {
        Shape::Triangle => {
            let r = size(
                "circumradius",
                "the distance from the centre to a corner [m]",
            )?;
            // Side s = sqrt(3) r, I = m s^2 / 12.
            (0.75 * 3f64.sqrt() * r * r, r * r / 4.0)
        }
        Shape::Disc => {
            let r = size("radius", "the radius of the disc [m]")?;
            (PI * r * r, r * r / 2.0)
        }
        Shape::Rectangle => {
            let w = size("width", "one side of the rectangle [m]")?;
            let h = size("height", "the other side of the rectangle [m]")?;
            (w * h, (w * w + h * h) / 12.0)
        }
    };
    let thickness = size("thickness", "the size normal to the plane [m]")?;
    let material = fields.required("material", "the name of a material")?;
    let density = material.lookup("material", materials)?.1.density;
    let mass = match table.optional("mass") {
        Some(typed) => typed.positive()?,
        None => derived(&plate, "a mass", density * area * thickness)?,
    };
    Ok((
        mass,
        derived(&plate, "a moment of inertia", mass * gyration)?,
    ))
}

fn points(table: &Fields) -> Result<Vec<Point>, SceneError> {
    let points = named(table.optional("points"), |field| {
        let at = if field.is_table() {
            polar(field)?
        } else {
            field.numbers("[x, y]")?
        };
        Ok(Point {
            name: field.name.clone(),
            at,
        })
    })?;
    Ok(points.into_values().collect())
}

/// `{ radius, degrees }`
fn polar(field: &Field) -> Result<[f64; 2], SceneError> {
    let mut table = field.fields()?;
    table.only(&["radius", "degrees"])?;
    let radius = table
        .required("radius", "the distance from the origin [m]")?
        .non_negative()?;
    let degrees = table
        .required("degrees", "the direction, counter-clockwise from x")?
        .number()?;
    let (sin, cos) = degrees.to_radians().sin_cos();
    Ok([radius * cos, radius * sin])
}
