//! `[contacts.NAME]`: geometry and laws of a joint with clearance.

use crate::body::Materials;
use crate::contact::friction::Ambrosio;
use crate::contact::geometry::Geometry;
use crate::contact::normal::{NormalLaw, NormalLawKind, NormalParameters};
use crate::contact::{ContactPair, FrictionalPair, FrictionlessPair, Slip};
use crate::document::{Field, Fields, Key, NumberRange, SceneError, Takes, derived};
use crate::marker::Spin;

const LAW: Key = Key::name_in("law", "normal laws", "the normal law, see below");

/// The keys of a contact, beside those that its law alone has.
pub static KEYS: [Key; 10] = [
    LAW,
    Key::positive("bearing_radius", "m", "the radius R_i of the bearing")
        .or("required in a revolute joint"),
    Key::positive(
        "clearance",
        "m",
        "R_i - R_j, with R_j the radius of the journal; below `bearing_radius`",
    ),
    Key::name_in(
        "bearing_material",
        "materials",
        "the material of the bearing; or give `stiffness`",
    )
    .or("required without `stiffness`"),
    Key::name_in(
        "journal_material",
        "materials",
        "the material of the journal; or give `stiffness`",
    )
    .or("required without `stiffness`"),
    Key::positive(
        "stiffness",
        "N/m^exponent",
        "the stiffness K; excludes the two materials",
    )
    .or("from the materials"),
    Key::within(
        "exponent",
        // below 1 the stiffness is infinite at first touch
        NumberRange::AtLeast(1.0),
        "the exponent n of the penetration, 1.5 for metals",
    ),
    Key::within(
        "restitution",
        NumberRange::Between(0.0, 1.0),
        "the coefficient of restitution c_e; `\"hertz\"` takes no other than 1, `\"flores\"` not 0",
    )
    .or("required; 1 for `\"hertz\"`"),
    Key::positive(
        "impact_velocity_floor",
        "m/s",
        "the lower bound of v in the formula below",
    )
    .or("required; `\"hertz\"` does not use it"),
    Key::new("friction", Takes::Table, "the table of the friction law").or("none"),
];

/// Slip below which there is no friction, where the scene says nothing \[m/s\]: the transition velocity that Adams has by default,
/// 0.1 mm/s.
pub const V0: f64 = 1e-4;
/// Slip above which friction is full, where the scene says nothing \[m/s\]: the characteristic slip velocity that COMSOL has by default,
/// 1e-3/s times the diagonal of the geometry, of a mechanism of a metre.
pub const V1: f64 = 1e-3;

/// The keys of a friction law.
pub static FRICTION: [Key; 5] = [
    Key::word("law", &["ambrosio"], "the friction law"),
    Key::non_negative("coefficient", "", "the coefficient of friction c_f"),
    Key::non_negative("v0", "m/s", "the slip below which there is no friction").or("1e-4"),
    Key::positive(
        "v1",
        "m/s",
        "the slip above which friction is full, greater than `v0`",
    )
    .or("1e-3"),
    Key::word("slip", &["paper", "material"], "which slip velocity enters").or("`\"material\"`"),
];

/// Geometry and laws of a loose joint.
#[derive(Debug, Clone)]
pub struct Contact {
    /// The name the user wrote.
    pub name: String,
    /// Bearing radius R_i \[m\]; none of a straight slot.
    pub bearing_radius: Option<f64>,
    /// Radial clearance c = R_i - R_j \[m\].
    pub clearance: f64,
    /// Normal law.
    pub law: &'static NormalLawKind,
    /// Contact stiffness K \[N/m^exponent\], typed or from eq. 25.
    pub stiffness: f64,
    /// True of a stiffness from eq. 25.
    pub from_materials: bool,
    /// Exponent n.
    pub exponent: f64,
    /// Restitution coefficient c_e as typed; 1 for Hertz.
    pub restitution: f64,
    /// Smallest impact velocity that the damping term divides by \[m/s\].
    pub impact_velocity_floor: f64,
    /// Values of the keys that the law alone has.
    pub own: Vec<f64>,
    /// Friction, absent when the scene names none.
    pub friction: Option<Friction>,
}

/// Friction of eq. 26.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// Coefficient c_f.
    pub coefficient: f64,
    /// Slip below which there is no friction \[m/s\].
    pub v0: f64,
    /// Slip above which friction is full \[m/s\].
    pub v1: f64,
    /// Which slip velocity enters.
    pub slip: Slip,
}

impl Contact {
    /// The normal law with its parameters.
    pub fn normal_law(&self) -> Box<dyn NormalLaw> {
        (self.law.build)(&NormalParameters {
            stiffness: self.stiffness,
            exponent: self.exponent,
            restitution: self.restitution,
            impact_velocity_floor: self.impact_velocity_floor,
            own: &self.own,
        })
    }

    /// The contact of these surfaces, on bodies that turn with the given spins.
    pub fn pair<G: Geometry + 'static>(
        &self,
        geometry: G,
        spins: [Spin; 2],
    ) -> Box<dyn ContactPair> {
        let law = self.normal_law();
        let surface = FrictionlessPair { geometry, law };
        let Some(f) = self.friction else {
            return Box::new(surface);
        };
        let law = Ambrosio {
            coefficient: f.coefficient,
            v0: f.v0,
            v1: f.v1,
        };
        Box::new(FrictionalPair::new(surface, Box::new(law), f.slip, spins))
    }

    /// Reads `[contacts.NAME]`.
    pub(crate) fn read(
        field: &Field,
        materials: &Materials,
        laws: &[&'static NormalLawKind],
    ) -> Result<Contact, SceneError> {
        let mut table = field.fields()?;
        let choices: Vec<_> = laws.iter().map(|k| (k.name, *k)).collect();
        let law = table.required("law", &LAW.description())?;
        let law = law.choice(&choices)?;
        table.declare(&[], KEYS.iter().chain(law.keys))?;
        let bearing_radius = table.optional_number("bearing_radius")?;
        let clearance = table.number("clearance")?;
        if bearing_radius.is_some_and(|radius| clearance >= radius) {
            let field = table.field("clearance")?;
            return Err(field.must("be less than `bearing_radius`, or no journal is left"));
        }
        let friction = table.optional("friction");
        let own = law.keys.iter().map(|key| table.number(key.name));
        let contact = Contact {
            name: field.name.clone(),
            own: own.collect::<Result<_, _>>()?,
            bearing_radius,
            clearance,
            law,
            stiffness: stiffness(field, &table, materials, bearing_radius, clearance)?,
            from_materials: table.optional("stiffness").is_none(),
            exponent: table.number("exponent")?,
            restitution: restitution(&table, law)?,
            impact_velocity_floor: floor(&table, law)?,
            friction: friction.map(|f| read_friction(&f)).transpose()?.flatten(),
        };
        // a law may divide by the restitution
        let force = contact.normal_law().force(contact.clearance, 1.0, 1.0);
        if contact.restitution == 0.0 && !force.value.is_finite() {
            let field = table.field("restitution")?;
            let must = format!("be greater than zero for law {:?}", law.name);
            return Err(field.must(&must));
        }
        Ok(contact)
    }
}

/// Typed, or that of a sphere in a spherical cup, whatever the length of the pin: K = 4 / (3 (h_i + h_j)) sqrt(R_i R_j / (R_i - R_j)) with h = (1 - nu^2) / E (eq. 25).
fn stiffness(
    contact: &Field,
    table: &Fields,
    materials: &Materials,
    bearing_radius: Option<f64>,
    clearance: f64,
) -> Result<f64, SceneError> {
    let keys = ["bearing_material", "journal_material"];
    let material = keys.iter().find_map(|key| table.optional(key));
    match (
        table.optional_number("stiffness")?,
        material,
        bearing_radius,
    ) {
        (Some(_), Some(material), _) => {
            let message = format!(
                "`{}` cannot be combined with a given `stiffness`",
                material.path
            );
            Err(material.key_fault(message, "remove this or the stiffness"))
        }
        (Some(typed), None, _) => Ok(typed),
        (None, None, None) => {
            let message = format!(
                "`{}` has neither a `bearing_radius` nor a `stiffness`",
                contact.path
            );
            let error = contact.key_fault(message, "needs one of them");
            Err(error.with_help(
                "the contact of a bearing needs `bearing_radius`, that of a slot `stiffness`",
            ))
        }
        (None, Some(material), None) => {
            let message = format!(
                "`{}` gives a stiffness by eq. 25, which needs a `bearing_radius`",
                material.path
            );
            Err(material.key_fault(message, "give `bearing_radius`, or `stiffness` instead"))
        }
        (None, _, Some(bearing_radius)) => {
            let mut compliance = 0.0;
            for key in keys {
                compliance += materials.compliance(table, key)?;
            }
            let radii = bearing_radius * (bearing_radius - clearance) / clearance;
            let stiffness = 4.0 / (3.0 * compliance) * radii.sqrt();
            derived(contact, "a stiffness", stiffness)
        }
    }
}

fn restitution(table: &Fields, law: &NormalLawKind) -> Result<f64, SceneError> {
    let field = match (law.is_damped, table.optional("restitution")) {
        (false, None) => return Ok(1.0),
        (false, Some(field)) if field.number()? != 1.0 => {
            let message = format!(
                "law \"{}\" has no damping: it cannot deliver a restitution of {}",
                law.name,
                field.written()
            );
            let error = field.fault(message, "leave this out");
            return Err(error.with_help("or choose another `law`"));
        }
        (_, Some(field)) => field,
        (_, None) => table.field("restitution")?,
    };
    field.number()
}

fn floor(table: &Fields, law: &NormalLawKind) -> Result<f64, SceneError> {
    match (law.is_damped, table.optional("impact_velocity_floor")) {
        // there is no damping term; one keeps the quotient harmless
        (false, None) => Ok(1.0),
        _ => table.number("impact_velocity_floor"),
    }
}

/// None for a coefficient of zero: what does not act does not exist.
fn read_friction(field: &Field) -> Result<Option<Friction>, SceneError> {
    let mut table = field.fields()?;
    table.declare(&[], &FRICTION)?;
    table.word("law")?;
    let coefficient = table.number("coefficient")?;
    let v0 = table.optional_number("v0")?.unwrap_or(V0);
    let v1 = table.optional_number("v1")?.unwrap_or(V1);
    if v1 <= v0 {
        return Err(match (table.optional("v1"), table.optional("v0")) {
            (Some(v1), _) => v1.must(&format!("be greater than `v0` = {v0:?}")),
            (None, v0) => v0
                .unwrap_or_else(|| field.clone())
                .must(&format!("be less than `v1` = {v1:?}")),
        });
    }
    let slip = match table.optional_word("slip")? {
        Some(0) => Slip::Paper,
        _ => Slip::Material,
    };
    Ok((coefficient > 0.0).then_some(Friction {
        coefficient,
        v0,
        v1,
        slip,
    }))
}
