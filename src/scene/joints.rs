//! `[contacts]` and `[joints]`.

use super::bodies::Bodies;
use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::names::{check_name, derived, named};
use super::{BodyKind, Contact, Friction, Joint, JointModel, NormalLawKind, PointRef, Slip};
use indexmap::IndexMap;

pub(super) fn read(root: &Fields, bodies: &Bodies) -> Result<IndexMap<String, Joint>, SceneError> {
    let contacts = named(root.optional("contacts"), |field| contact(field, bodies))?;
    named(root.optional("joints"), |field| {
        check_name(field, &["error", "energy", "t"])?;
        if bodies.bodies.contains_key(&field.name) {
            let message = format!("`{}` is the name of a body and of a joint", field.name);
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
    let mut table = field.fields()?;
    table.only(&["type", "bearing", "journal", "model", "contact"])?;
    table
        .required("type", "the kind of joint: \"revolute\"")?
        .choice(&[("revolute", ())])?;
    let bearing = table.required(
        "bearing",
        "the point that carries the bearing, as \"body.point\"",
    )?;
    let bearing = point(&bearing, bodies)?;
    let journal_field = table.required(
        "journal",
        "the point that carries the journal, as \"body.point\"",
    )?;
    let journal = point(&journal_field, bodies)?;
    if bearing.body == journal.body {
        let message = format!("`{}` connects a body to itself", field.path);
        return Err(journal_field.fault(message, "on the same body as the bearing"));
    }
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
    let model = match contact {
        Some((_, contact)) if loose => JointModel::Clearance(contact.clone()),
        _ => JointModel::Ideal,
    };
    Ok(Joint {
        name: field.name.clone(),
        span: field.node.span,
        bearing,
        journal,
        model,
    })
}

/// `"body.point"`
fn point(field: &Field, bodies: &Bodies) -> Result<PointRef, SceneError> {
    let text = field.text()?;
    let Some((body, point)) = text.split_once('.') else {
        let message = format!("`{}` must be \"body.point\", not \"{text}\"", field.path);
        return Err(field.fault(message, "no `.` here"));
    };
    let Some((index, _, found)) = bodies.bodies.get_full(body) else {
        return Err(field.dangling("body", body, bodies.bodies.keys().map(String::as_str)));
    };
    let names: Vec<&str> = match &found.kind {
        BodyKind::Link(_) => vec!["start", "end"],
        BodyKind::Ground { points } => points.iter().map(|p| p.name.as_str()).collect(),
        BodyKind::Rigid(rigid) => rigid.points.iter().map(|p| p.name.as_str()).collect(),
    };
    match names.iter().position(|name| *name == point) {
        Some(point) => Ok(PointRef { body: index, point }),
        None => {
            let kind = format!("point of `{body}` called");
            Err(field.dangling(&kind, point, names.into_iter()))
        }
    }
}

fn contact(field: &Field, bodies: &Bodies) -> Result<Contact, SceneError> {
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
    let laws = [
        ("lankarani_nikravesh", NormalLawKind::LankaraniNikravesh),
        ("hertz", NormalLawKind::Hertz),
        ("hunt_crossley", NormalLawKind::HuntCrossley),
        ("flores", NormalLawKind::Flores),
    ];
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
                "`{}` and a typed `stiffness` exclude each other",
                material.path
            );
            return Err(material.key_fault(message, "remove this or the stiffness"));
        }
        return typed.positive();
    }
    let mut compliance = 0.0;
    for key in keys {
        let purpose = "the name of a material, for the stiffness of eq. 25; or type `stiffness`";
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

fn restitution(table: &Fields, law: NormalLawKind) -> Result<f64, SceneError> {
    let purpose = "the coefficient of restitution, in (0, 1]";
    let field = match (law, table.optional("restitution")) {
        (NormalLawKind::Hertz, None) => return Ok(1.0),
        (NormalLawKind::Hertz, Some(field)) if field.number()? != 1.0 => {
            let message = format!(
                "law \"hertz\" has no damping: it cannot deliver a restitution of {}",
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

fn floor(table: &Fields, law: NormalLawKind) -> Result<f64, SceneError> {
    let purpose = "the smallest impact velocity the damping term divides by [m/s]";
    match (law, table.optional("impact_velocity_floor")) {
        // Hertz has no damping term; one keeps the quotient harmless.
        (NormalLawKind::Hertz, None) => Ok(1.0),
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
