//! `[bodies]`.

use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::materials::{Material, Section, lacks, material, section};
use super::names::{RESERVED, check_name, derived, named};
use super::paths::path;
use super::{Body, BodyKind, Damping, Link, LinkModel, LinkPoint, Point, RigidBody};
use indexmap::IndexMap;
use std::f64::consts::PI;

/// More elements in one link than any convergence study needs.
const MOST_ELEMENTS: i64 = 10_000;

/// The bodies and what joints need besides.
pub(super) struct Bodies {
    pub bodies: IndexMap<String, Body>,
    pub materials: IndexMap<String, Material>,
}

pub(super) fn read(root: &Fields, duration: f64) -> Result<Bodies, SceneError> {
    let materials = named(root.optional("materials"), material)?;
    let sections = named(root.optional("sections"), section)?;
    let table = root.required("bodies", "the tables of ground, links and rigid bodies")?;
    let bodies = named(Some(table), |field| {
        check_name(field, &RESERVED)?;
        let span = field.node.span;
        let kind = body(field, &materials, &sections, duration)?;
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
    duration: f64,
) -> Result<BodyKind, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        Ground,
        Link,
        Rigid,
        PointMass,
        Moving,
    }
    let mut table = field.fields()?;
    let types = [
        ("ground", Type::Ground),
        ("link", Type::Link),
        ("rigid_body", Type::Rigid),
        ("point_mass", Type::PointMass),
        ("moving", Type::Moving),
    ];
    let purpose =
        "the kind of body: \"ground\", \"link\", \"rigid_body\", \"point_mass\" or \"moving\"";
    match table.required("type", purpose)?.choice(&types)? {
        Type::Ground => {
            table.only(&["type", "points"])?;
            Ok(BodyKind::Ground {
                points: points(&table)?,
            })
        }
        Type::Link => {
            table.only(&[
                "type",
                "model",
                "length",
                "section",
                "material",
                "elements",
                "points",
                "kelvin_voigt",
                "rayleigh",
            ])?;
            Ok(BodyKind::Link(link(&table, materials, sections)?))
        }
        Type::Rigid => {
            table.only(&[
                "type",
                "mass",
                "inertia",
                "plate",
                "center_of_mass",
                "points",
            ])?;
            let (mass, inertia) = inertia(&table, materials)?;
            let center = table.optional("center_of_mass");
            let center = center.map(|c| c.numbers::<2>("[x, y]")).transpose()?;
            let center = center.unwrap_or([0.0; 2]);
            let mut points = points(&table)?;
            for point in &mut points {
                point.at = [point.at[0] - center[0], point.at[1] - center[1]];
            }
            Ok(BodyKind::Rigid(RigidBody {
                mass,
                inertia,
                points,
            }))
        }
        Type::PointMass => {
            table.only(&["type", "mass"])?;
            let mass = table.required("mass", "the mass [kg]")?.positive()?;
            Ok(BodyKind::PointMass { mass })
        }
        Type::Moving => {
            table.only(&["type", "path", "points"])?;
            let field = table.required("path", "the path of its reference point and its angle")?;
            Ok(BodyKind::Moving {
                path: path(&field, duration)?,
                points: points(&table)?,
            })
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
        points: link_points(table, length, elements, flexible)?,
        damping: damping(table, flexible)?,
    })
}

/// Inner points of a flexible link, as their distance from `start`.
fn link_points(
    table: &Fields,
    length: f64,
    elements: usize,
    flexible: bool,
) -> Result<Vec<LinkPoint>, SceneError> {
    let points = table.optional("points");
    if let Some(field) = points.as_ref().filter(|_| !flexible) {
        let message = format!(
            "`{}`: a rigid link has only the points `start` and `end`",
            field.path
        );
        let error = field.key_fault(message, "not on a rigid link");
        return Err(error.with_help("a body of type \"rigid_body\" has points anywhere"));
    }
    let points = named(points, |field| {
        if ["start", "end"].contains(&field.name.as_str()) {
            let message = format!("`{}` is already the name of an end of the link", field.name);
            return Err(field.key_fault(message, "taken"));
        }
        let place = field.number()? / length * elements as f64;
        let node = place.round();
        if !(node > 0.0 && node < elements as f64 && (place - node).abs() <= 1e-9 * node) {
            let requirement = format!(
                "lie at a node between the ends: a multiple of {} m, less than {} m",
                numbers::exact(length / elements as f64),
                numbers::exact(length)
            );
            return Err(field.must(&requirement));
        }
        Ok(LinkPoint {
            name: field.name.clone(),
            node: node as usize,
        })
    })?;
    Ok(points.into_values().collect())
}

/// `kelvin_voigt` and `rayleigh = { mass, stiffness }`; none where all of them are zero.
fn damping(table: &Fields, flexible: bool) -> Result<Option<Damping>, SceneError> {
    let mut damping = Damping {
        strain: 0.0,
        mass: 0.0,
    };
    let fields = ["kelvin_voigt", "rayleigh"].map(|key| table.optional(key));
    if let Some(field) = fields.iter().flatten().next().filter(|_| !flexible) {
        let message = format!("`{}`: a rigid link has no structural damping", field.path);
        return Err(field.key_fault(message, "not on a rigid link"));
    }
    let [kelvin_voigt, rayleigh] = fields;
    if let Some(field) = kelvin_voigt {
        damping.strain = field.non_negative()?;
    }
    if let Some(field) = rayleigh {
        let mut table = field.fields()?;
        table.only(&["mass", "stiffness"])?;
        let purpose = "the factor of the mass matrix [1/s]";
        damping.mass = table.required("mass", purpose)?.non_negative()?;
        let purpose = "the factor of the stiffness [s]; it acts on strain rates, as `kelvin_voigt`";
        damping.strain += table.required("stiffness", purpose)?.non_negative()?;
    }
    Ok((damping.strain > 0.0 || damping.mass > 0.0).then_some(damping))
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
        let message = format!("`{}` is already given by the plate", typed.path);
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
