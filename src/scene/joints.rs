//! `[contacts]` and `[joints]`.

use super::SlopeClamp;
use super::bodies::Bodies;
use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::names::{RESERVED, check_name, derived, named};
use super::{Body, BodyKind, Contact, Friction, Joint, JointModel, PointRef};
use crate::contact::Slip;
use crate::contact::normal::NormalLawKind;
use crate::registry::Registry;
use indexmap::IndexMap;

pub(super) fn read(
    root: &Fields,
    bodies: &Bodies,
    registry: &Registry,
) -> Result<IndexMap<String, Joint>, SceneError> {
    let contacts = named(root.optional("contacts"), |field| {
        contact(field, bodies, registry)
    })?;
    named(root.optional("joints"), |field| {
        check_name(field, &RESERVED)?;
        if bodies.bodies.contains_key(&field.name) {
            let message = format!("`{}` names both a body and a joint", field.name);
            let help = "channels are called `name.quantity`, so names must differ";
            return Err(field
                .key_fault(message, "a body has this name")
                .with_help(help));
        }
        joint(field, bodies, &contacts)
    })
}

fn joint(
    field: &Field,
    bodies: &Bodies,
    contacts: &IndexMap<String, Contact>,
) -> Result<Joint, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        Revolute,
        Prismatic,
        Weld,
    }
    let types = [
        ("revolute", Type::Revolute),
        ("prismatic", Type::Prismatic),
        ("weld", Type::Weld),
    ];
    let mut table = field.fields()?;
    let purpose = "the kind of joint: \"revolute\", \"prismatic\" or \"weld\"";
    let kind = table.required("type", purpose)?.choice(&types)?;
    let sides: [(&'static str, &str); 2] = match kind {
        Type::Revolute => {
            table.only(&["type", "bearing", "journal", "model", "contact"])?;
            [
                ("bearing", "that carries the bearing"),
                ("journal", "that carries the journal"),
            ]
        }
        Type::Prismatic => {
            table.only(&["type", "guide", "direction", "slider", "rotation", "angle"])?;
            [
                ("guide", "on the line, of the body that carries it"),
                ("slider", "that slides"),
            ]
        }
        Type::Weld => {
            table.only(&["type", "first", "second", "angle", "slope"])?;
            [("first", "of one body"), ("second", "of the other")]
        }
    };
    let side = |(key, role): (&'static str, &str)| {
        let field = table.required(key, &format!("the point {role}, as \"body.point\""))?;
        Ok((point(&field, bodies)?, field))
    };
    let (bearing, _) = side(sides[0])?;
    let (journal, journal_field) = side(sides[1])?;
    if bearing.body == journal.body {
        let message = format!("`{}` connects a body to itself", field.path);
        let label = format!("on the same body as the {}", sides[0].0);
        return Err(journal_field.fault(message, label));
    }
    let model = match kind {
        Type::Revolute => revolute(&table, contacts)?,
        Type::Prismatic => prismatic(&table)?,
        Type::Weld => weld(&table)?,
    };
    let turning = match model {
        JointModel::Weld { .. } => vec![bearing, journal],
        JointModel::Prismatic {
            locked: Some(_), ..
        } => vec![bearing, journal],
        JointModel::Prismatic { locked: None, .. } => vec![bearing],
        JointModel::Ideal | JointModel::Clearance(_) => vec![],
    };
    for p in turning {
        let (name, body) = bodies.bodies.get_index(p.body).expect("a point has a body");
        if matches!(body.kind, BodyKind::PointMass { .. }) {
            let message = format!(
                "`{}` needs the direction of {name}, but a point mass has none",
                field.path
            );
            return Err(field.key_fault(message, "a point has no direction"));
        }
    }
    Ok(Joint {
        name: field.name.clone(),
        span: field.node.span,
        bearing,
        journal,
        model,
    })
}

fn revolute(
    table: &Fields,
    contacts: &IndexMap<String, Contact>,
) -> Result<JointModel, SceneError> {
    let purpose = "how the joint connects: \"ideal\" or \"clearance\"";
    let loose = table
        .required("model", purpose)?
        .choice(&[("ideal", false), ("clearance", true)])?;
    let purpose = "the name of the contact of a joint with clearance";
    let contact = match loose {
        true => Some(table.required("contact", purpose)?),
        false => table.optional("contact"),
    };
    let contact = contact
        .map(|name| name.lookup("contact", contacts))
        .transpose()?;
    Ok(match contact {
        Some((_, contact)) if loose => JointModel::Clearance(contact.clone()),
        _ => JointModel::Ideal,
    })
}

fn prismatic(table: &Fields) -> Result<JointModel, SceneError> {
    let purpose = "the direction of the line in the frame of its body, [dx, dy]";
    let field = table.required("direction", purpose)?;
    let [dx, dy] = field.numbers("[dx, dy]")?;
    if dx == 0.0 && dy == 0.0 {
        return Err(field.must("not be zero"));
    }
    let purpose = "whether the sliding body may turn: \"free\" or \"locked\"";
    let locked = table
        .required("rotation", purpose)?
        .choice(&[("free", false), ("locked", true)])?;
    let angle = table.optional("angle");
    if let Some(angle) = angle.as_ref().filter(|_| !locked) {
        let message = format!(
            "`{}` is the angle of a locked rotation, but this rotation is free",
            angle.path
        );
        return Err(angle.key_fault(message, "remove this, or lock the rotation"));
    }
    let angle = angle.map(|a| a.number()).transpose()?.unwrap_or(0.0);
    Ok(JointModel::Prismatic {
        direction: dy.atan2(dx),
        locked: locked.then_some(angle),
    })
}

fn weld(table: &Fields) -> Result<JointModel, SceneError> {
    let angle = table.optional("angle").map(|a| a.number()).transpose()?;
    let clamps = [
        ("direction", SlopeClamp::Direction),
        ("vector", SlopeClamp::Vector),
    ];
    let slope = table.optional("slope").map(|s| s.choice(&clamps));
    Ok(JointModel::Weld {
        angle: angle.unwrap_or(0.0),
        slope: slope.transpose()?.unwrap_or(SlopeClamp::Direction),
    })
}

/// The points of a body in the order of their indices.
pub(super) fn point_names(body: &Body) -> Vec<&str> {
    match &body.kind {
        BodyKind::Link(link) => {
            let inner = link.points.iter().map(|p| p.name.as_str());
            ["start", "end"].into_iter().chain(inner).collect()
        }
        BodyKind::PointMass { .. } => vec!["center"],
        BodyKind::Ground { points } | BodyKind::Moving { points, .. } => {
            points.iter().map(|p| p.name.as_str()).collect()
        }
        BodyKind::Rigid(rigid) => rigid.points.iter().map(|p| p.name.as_str()).collect(),
    }
}

/// `"body.point"`
pub(super) fn point(field: &Field, bodies: &Bodies) -> Result<PointRef, SceneError> {
    let text = field.text()?;
    let Some((body, point)) = text.split_once('.') else {
        let message = format!("`{}` must be \"body.point\", not \"{text}\"", field.path);
        return Err(field.fault(message, "no `.` here"));
    };
    let Some((index, _, found)) = bodies.bodies.get_full(body) else {
        return Err(field.dangling("body", body, bodies.bodies.keys().map(String::as_str)));
    };
    let names = point_names(found);
    match names.iter().position(|name| *name == point) {
        Some(point) => Ok(PointRef { body: index, point }),
        None => {
            let kind = format!("point of `{body}` called");
            Err(field.dangling(&kind, point, names.into_iter()))
        }
    }
}

fn contact(field: &Field, bodies: &Bodies, registry: &Registry) -> Result<Contact, SceneError> {
    let mut table = field.fields()?;
    table.only(&[
        "law",
        "bearing_radius",
        "clearance",
        "bearing_material",
        "journal_material",
        "stiffness",
        "exponent",
        "restitution",
        "impact_velocity_floor",
        "friction",
    ])?;
    let laws: Vec<_> = registry.laws.iter().map(|k| (k.name, *k)).collect();
    let law = table
        .required("law", "the normal contact law")?
        .choice(&laws)?;
    let bearing_radius = table
        .required("bearing_radius", "the radius of the bearing [m]")?
        .positive()?;
    let clearance_field = table.required("clearance", "bearing radius less journal radius [m]")?;
    let clearance = clearance_field.positive()?;
    if clearance >= bearing_radius {
        return Err(clearance_field.must("be less than `bearing_radius`, or no journal is left"));
    }
    let exponent_field = table.required(
        "exponent",
        "the exponent of the penetration, 1.5 for metals",
    )?;
    let exponent = exponent_field.positive()?;
    if exponent < 1.0 {
        return Err(
            exponent_field.must("be at least 1, or the stiffness is infinite at first touch")
        );
    }
    Ok(Contact {
        bearing_radius,
        clearance,
        law,
        stiffness: stiffness(field, &table, bodies, bearing_radius, clearance)?,
        exponent,
        restitution: restitution(&table, law)?,
        impact_velocity_floor: floor(&table, law)?,
        friction: table
            .optional("friction")
            .map(|f| friction(&f))
            .transpose()?
            .flatten(),
    })
}

/// Typed, or K = 4 / (3 (h_i + h_j)) sqrt(R_i R_j / (R_i - R_j)) with h = (1 - nu^2) / E (eq. 25).
fn stiffness(
    contact: &Field,
    table: &Fields,
    bodies: &Bodies,
    bearing_radius: f64,
    clearance: f64,
) -> Result<f64, SceneError> {
    let keys = ["bearing_material", "journal_material"];
    if let Some(typed) = table.optional("stiffness") {
        if let Some(material) = keys.iter().find_map(|key| table.optional(key)) {
            let message = format!(
                "`{}` cannot be combined with a given `stiffness`",
                material.path
            );
            return Err(material.key_fault(message, "remove this or the stiffness"));
        }
        return typed.positive();
    }
    let mut compliance = 0.0;
    for key in keys {
        let purpose = "the name of a material, for the stiffness of eq. 25; or give `stiffness`";
        let name = table.required(key, purpose)?;
        let (_, material) = name.lookup("material", &bodies.materials)?;
        compliance += material.compliance(&name)?;
    }
    let journal_radius = bearing_radius - clearance;
    let radii = bearing_radius * journal_radius / clearance;
    derived(
        contact,
        "a stiffness",
        4.0 / (3.0 * compliance) * radii.sqrt(),
    )
}

fn restitution(table: &Fields, law: &NormalLawKind) -> Result<f64, SceneError> {
    let purpose = "the coefficient of restitution, in (0, 1]";
    let field = match (law.is_damped, table.optional("restitution")) {
        (false, None) => return Ok(1.0),
        (false, Some(field)) if field.number()? != 1.0 => {
            let message = format!(
                "law \"{}\" has no damping: it cannot deliver a restitution of {}",
                law.name,
                field.written()
            );
            return Err(field
                .fault(message, "leave this out")
                .with_help("or choose another `law`"));
        }
        (_, Some(field)) => field,
        (_, None) => table.required("restitution", purpose)?,
    };
    match field.number()? {
        e if e > 0.0 && e <= 1.0 => Ok(e),
        _ => Err(field.must("lie above 0 and not above 1")),
    }
}

fn floor(table: &Fields, law: &NormalLawKind) -> Result<f64, SceneError> {
    let purpose = "the smallest impact velocity the damping term divides by [m/s]";
    match (law.is_damped, table.optional("impact_velocity_floor")) {
        // there is no damping term; one keeps the quotient harmless
        (false, None) => Ok(1.0),
        _ => table.required("impact_velocity_floor", purpose)?.positive(),
    }
}

/// None for a coefficient of zero: what does not act does not exist.
fn friction(field: &Field) -> Result<Option<Friction>, SceneError> {
    let mut table = field.fields()?;
    table.only(&["law", "coefficient", "v0", "v1", "slip"])?;
    table
        .required("law", "the friction law: \"ambrosio\"")?
        .choice(&[("ambrosio", ())])?;
    let coefficient = table
        .required("coefficient", "the coefficient of friction")?
        .non_negative()?;
    let v0 = table
        .required("v0", "the slip below which there is no friction [m/s]")?
        .non_negative()?;
    let v1_field = table.required("v1", "the slip above which friction is full [m/s]")?;
    let v1 = v1_field.positive()?;
    if v1 <= v0 {
        return Err(v1_field.must("be greater than `v0`"));
    }
    let slips = [("paper", Slip::Paper), ("material", Slip::Material)];
    let slip = table
        .optional("slip")
        .map(|s| s.choice(&slips))
        .transpose()?;
    let slip = slip.unwrap_or(Slip::Material);
    Ok((coefficient > 0.0).then_some(Friction {
        coefficient,
        v0,
        v1,
        slip,
    }))
}
