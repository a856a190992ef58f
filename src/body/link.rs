//! `type = "link"`: a slender uniform link that is straight when undeformed.

use super::rigid_body::AS_IT_IS_HELD;
use super::{BodyKind, Damping, FlexibleLink, LinkCoordinates, Point, RigidLink};
use crate::document::{Fields, Key, SceneError, Takes, named};
use crate::math::plane::Vec2;
use std::sync::Arc;

/// More elements in one link than any convergence study needs.
const MOST_ELEMENTS: i64 = 10_000;

pub(super) static KIND: BodyKind = BodyKind {
    name: "link",
    keys: &[
        Key::word("model", &["rigid", "flexible"], "how the link deforms; a flexible one consists of planar cubic ANCF elements"),
        Key::positive("length", "m", "the length of the link"),
        Key::name_in("section", "sections", "the name of a section"),
        Key::name_in("material", "materials", "the name of a material; a flexible link needs its `youngs_modulus`"),
        Key::new(
            "elements",
            Takes::Whole(1, MOST_ELEMENTS),
            "the number of equal elements of a flexible link, 1 to 10000; a rigid link ignores it",
        )
        .or("required if flexible"),
        Key::word(
            "coordinates",
            &["natural", "center"],
            "the unknowns of a rigid link, see [Coordinates of rigid bodies](#coordinates-of-rigid-bodies); flexible and driven links ignore it",
        )
        .or(AS_IT_IS_HELD),
        Key::new(
            "points",
            Takes::Table,
            "named points by their distance from `start`, between the ends; of a flexible link each at a node between elements [m]",
        )
        .or("none"),
        Key::non_negative(
            "kelvin_voigt",
            "s",
            "of a flexible link, a rigid one ignores it: the retardation time tau; the stress is E tau times the strain rate",
        )
        .or("0"),
        Key::new(
            "rayleigh",
            Takes::Table,
            "Rayleigh damping; a rigid link ignores it",
        )
        .or("none"),
    ],
    read: |table, known| {
        let flexible = table.word("model")? == 1;
        let length = table.number("length")?;
        let section = known.section(table, "section")?;
        let material = known.material(table, "material")?;
        let elements = elements(table, flexible)?;
        let modulus = flexible.then(|| known.youngs_modulus(table, "material"));
        let modulus = modulus.transpose()?;
        let coordinates = table.optional_word("coordinates")?;
        let coordinates = coordinates.map(|word| match word {
            0 => LinkCoordinates::Natural,
            _ => LinkCoordinates::Centre,
        });
        let inner = inner_points(table, length, flexible.then_some(elements))?;
        let damping = damping(table)?;
        let shares: Vec<f64> = [0.0, 1.0]
            .into_iter()
            .chain(inner.iter().map(|(_, share)| *share))
            .collect();
        let names = ["start", "end"].map(str::to_owned).into_iter();
        let names = names.chain(inner.iter().map(|(name, _)| name.clone()));
        let points = names.zip(&shares);
        let link = Link {
            length,
            area: section.area,
            second_moment: section.second_moment,
            density: material.density,
            points: points
                .map(|(name, share)| Point::new(&name, Vec2::new(share * length, 0.0)))
                .collect(),
            shares,
        };
        Ok(match modulus {
            None => Arc::new(RigidLink { link, coordinates }),
            Some(youngs_modulus) => Arc::new(FlexibleLink {
                nodes: link
                    .shares
                    .iter()
                    .map(|share| (share * elements as f64).round() as usize)
                    .collect(),
                link,
                elements,
                youngs_modulus,
                damping,
            }),
        })
    },
};

/// What rigid and flexible links have in common.
#[derive(Debug, Clone)]
pub struct Link {
    /// Length l \[m\].
    pub length: f64,
    /// Cross-section A \[m2\].
    pub area: f64,
    /// Second moment of area I about the axis normal to the plane \[m4\].
    pub second_moment: f64,
    /// Density \[kg/m3\].
    pub density: f64,
    /// `start`, `end`, and points at nodes between them.
    pub points: Vec<Point>,
    /// Where the points are, as shares of the length.
    pub shares: Vec<f64>,
}

impl Link {
    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.density * self.area * self.length
    }
}

fn elements(table: &Fields, flexible: bool) -> Result<usize, SceneError> {
    let field = match flexible {
        true => Some(table.field("elements")?),
        false => table.optional("elements"),
    };
    let Some(field) = field else {
        return Ok(1);
    };
    match field.integer()? {
        n @ 1..=MOST_ELEMENTS => Ok(n as usize),
        _ => Err(field.must(&format!("lie between 1 and {MOST_ELEMENTS}"))),
    }
}

/// Names of the inner points of a link and their shares of its length; of a flexible link they lie at nodes of its elements.
fn inner_points(
    table: &Fields,
    length: f64,
    elements: Option<usize>,
) -> Result<Vec<(String, f64)>, SceneError> {
    let points = named(table.optional("points"), |field| {
        if ["start", "end"].contains(&field.name.as_str()) {
            let message = format!("`{}` is already the name of an end of the link", field.name);
            return Err(field.key_fault(message, "taken"));
        }
        let share = field.number()? / length;
        let Some(elements) = elements else {
            return match share > 0.0 && share < 1.0 {
                true => Ok(share),
                false => Err(field.must(&format!(
                    "lie between the ends: more than 0 m, less than {} m",
                    numbers::exact(length)
                ))),
            };
        };
        let elements = elements as f64;
        let place = share * elements;
        let node = place.round();
        if !(node > 0.0 && node < elements && (place - node).abs() <= 1e-9 * node) {
            let requirement = format!(
                "lie at a node between the ends: a multiple of {} m, less than {} m",
                numbers::exact(length / elements),
                numbers::exact(length)
            );
            return Err(field.must(&requirement));
        }
        Ok(node / elements)
    })?;
    Ok(points.into_iter().collect())
}

/// The keys of Rayleigh damping.
pub static RAYLEIGH: [Key; 2] = [
    Key::non_negative("mass", "1/s", "the factor of the mass matrix"),
    Key::non_negative(
        "stiffness",
        "s",
        "the factor of the stiffness, which acts on strain rates as `kelvin_voigt` does",
    ),
];

/// `kelvin_voigt` and `rayleigh = { mass, stiffness }`; none where all of them are zero.
fn damping(table: &Fields) -> Result<Option<Damping>, SceneError> {
    let mut damping = Damping {
        strain: table.optional_number("kelvin_voigt")?.unwrap_or(0.0),
        mass: 0.0,
    };
    if let Some(rayleigh) = table.optional("rayleigh") {
        let mut table = rayleigh.fields()?;
        table.declare(&[], &RAYLEIGH)?;
        damping.mass = table.number("mass")?;
        damping.strain += table.number("stiffness")?;
    }
    Ok((damping.strain > 0.0 || damping.mass > 0.0).then_some(damping))
}
