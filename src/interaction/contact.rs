//! `[contacts.NAME]`: geometry and laws of a joint with clearance.

use crate::body::Materials;
use crate::contact::friction::{FrictionKind, FrictionLaw};
use crate::contact::geometry::Geometry;
use crate::contact::normal::{NormalLaw, NormalLawKind, NormalParameters};
use crate::contact::{ContactPair, FrictionalPair, FrictionlessPair, Slip};
use crate::document::{Field, Fields, Key, Kind, NumberRange, SceneError, Takes, derived};
use crate::marker::Spin;
use crate::system::InternalState;
use std::sync::Arc;

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

/// Friction of a contact.
#[derive(Debug, Clone)]
pub struct Friction {
    /// The law.
    pub law: Arc<dyn FrictionLaw>,
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

    /// The internal states of its friction law, one at most.
    pub fn states(&self) -> Vec<InternalState> {
        let friction = self.friction.iter();
        friction
            .filter_map(|friction| friction.law.state())
            .collect()
    }

    /// The contact of these surfaces, on bodies that turn with the given spins, with its internal states.
    pub fn pair<G: Geometry + 'static>(
        &self,
        geometry: G,
        spins: [Spin; 2],
        states: &[usize],
    ) -> Box<dyn ContactPair> {
        let law = self.normal_law();
        let surface = FrictionlessPair { geometry, law };
        let Some(Friction { law, slip }) = &self.friction else {
            return Box::new(surface);
        };
        let state = states.first().copied();
        Box::new(FrictionalPair::new(
            surface,
            law.clone(),
            *slip,
            spins,
            state,
        ))
    }

    /// Reads `[contacts.NAME]`.
    pub(crate) fn read(
        field: &Field,
        materials: &Materials,
        laws: &[&'static NormalLawKind],
        frictions: &[&'static FrictionKind],
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
            friction: friction
                .map(|f| read_friction(&f, frictions))
                .transpose()?
                .flatten(),
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

/// None where the law would not act: what does not act does not exist.
fn read_friction(
    field: &Field,
    frictions: &[&'static FrictionKind],
) -> Result<Option<Friction>, SceneError> {
    let (kind, table) = Kind::by("law", field, "the friction law", frictions)?;
    let law = (kind.read)(&table)?;
    let slip = match table.optional_word("slip")? {
        Some(0) => Slip::Paper,
        _ => Slip::Material,
    };
    Ok(law.map(|law| Friction { law, slip }))
}
