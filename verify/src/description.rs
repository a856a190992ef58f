//! A scene as the reference implementation takes it, read from the TOML text on its own.
//!
//! Nothing passes through Looselink's reader: sections, densities, moduli and radii reach the C++ side as they are typed,
//! and it derives masses, stiffnesses and inertias itself.

use crate::reference::{Body, Contact, Joint, Leg, Mechanism, Path, Point, body_kind};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Deserialize;
use std::collections::HashMap;
use std::f64::consts::TAU;
use toml::{Table, Value};

/// A scene in the terms of the reference, with the names of its parts.
#[derive(Debug, Clone)]
pub struct Description {
    /// What the reference computes.
    pub mechanism: Mechanism,
    /// Names of the bodies, in the order of the mechanism.
    pub bodies: Vec<String>,
    /// Names of the joints, in the order of the mechanism.
    pub joints: Vec<String>,
    /// Named points of rigid bodies: body, name, place in its frame \[m\].
    pub points: Vec<(usize, String, [f64; 2])>,
}

#[derive(Deserialize)]
struct Material {
    density: f64,
    #[serde(default)]
    youngs_modulus: f64,
    #[serde(default)]
    poissons_ratio: f64,
}

#[derive(Deserialize)]
struct Section {
    width: f64,
    height: f64,
}

#[derive(Deserialize)]
struct ContactText {
    law: String,
    bearing_radius: f64,
    clearance: f64,
    bearing_material: Option<String>,
    journal_material: Option<String>,
    #[serde(default)]
    stiffness: f64,
    exponent: f64,
    restitution: f64,
    impact_velocity_floor: f64,
    friction: Option<FrictionText>,
}

#[derive(Deserialize)]
struct FrictionText {
    law: String,
    coefficient: f64,
    v0: f64,
    v1: f64,
    slip: Option<String>,
}

#[derive(Deserialize)]
struct JointText {
    bearing: String,
    journal: String,
    model: String,
    contact: Option<String>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Place {
    Polar { radius: f64, degrees: f64 },
    Cartesian([f64; 2]),
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum BodyText {
    Ground {
        #[serde(default)]
        points: HashMap<String, Place>,
    },
    Link {
        model: String,
        length: f64,
        section: String,
        material: String,
        elements: Option<i32>,
    },
    RigidBody {
        #[serde(default)]
        mass: f64,
        #[serde(default)]
        inertia: f64,
        plate: Option<Plate>,
        #[serde(default)]
        points: HashMap<String, Place>,
    },
}

#[derive(Deserialize)]
struct Plate {
    circumradius: f64,
    thickness: f64,
    material: String,
}

#[derive(Deserialize)]
struct DriveText {
    joints: Vec<String>,
    body: String,
    path: PathText,
}

#[derive(Deserialize)]
struct PathText {
    center: [f64; 2],
    radius: f64,
    frequency: f64,
    phase: f64,
    theta: f64,
}

#[derive(Deserialize, Default)]
struct InitialText {
    #[serde(default)]
    sketch: HashMap<String, [f64; 2]>,
}

/// All that the reference needs of a scene; order of bodies and joints is that of the file.
struct Text {
    materials: HashMap<String, Material>,
    sections: HashMap<String, Section>,
    contacts: HashMap<String, ContactText>,
    bodies: Vec<(String, BodyText)>,
    joints: Vec<(String, JointText)>,
    drives: HashMap<String, DriveText>,
    initial: InitialText,
}

impl Place {
    fn xy(&self) -> [f64; 2] {
        match *self {
            Place::Cartesian(xy) => xy,
            Place::Polar { radius, degrees } => {
                let angle = degrees / 360.0 * TAU;
                [radius * angle.cos(), radius * angle.sin()]
            }
        }
    }
}

/// Reads a scene and applies `path=value` overrides.
///
/// # Errors
/// A scene with parts that the reference does not know, by name.
pub fn describe(text: &str, overrides: &[String]) -> Result<Description> {
    let mut table: Table = text.parse().into_diagnostic()?;
    for text in overrides {
        apply(&mut table, text)?;
    }
    Text::read(table)?.translate()
}

/// Sets one existing or new value.
fn apply(table: &mut Table, text: &str) -> Result<()> {
    let (path, value) = text
        .split_once('=')
        .ok_or_else(|| miette!("no `=` in the override {text}"))?;
    let value = format!("x = {value}")
        .parse::<Table>()
        .or_else(|_| format!("x = {value:?}").parse::<Table>())
        .into_diagnostic()?
        .remove("x")
        .ok_or_else(|| miette!("no value in the override {text}"))?;
    let mut parts: Vec<&str> = path.split('.').collect();
    let last = parts
        .pop()
        .ok_or_else(|| miette!("no path in the override {text}"))?;
    let mut at = table;
    for part in parts {
        at = at
            .get_mut(part)
            .and_then(Value::as_table_mut)
            .ok_or_else(|| miette!("the scene has no table `{part}` for the override {text}"))?;
    }
    at.insert(last.to_owned(), value);
    Ok(())
}

/// The entries of a table in the order of the file.
fn entries<T: for<'a> Deserialize<'a>>(table: &mut Table, key: &str) -> Result<Vec<(String, T)>> {
    let Some(value) = table.remove(key) else {
        return Ok(Vec::new());
    };
    let Value::Table(inner) = value else {
        return Err(miette!("`{key}` is not a table"));
    };
    let entry = |(name, value): (String, Value)| {
        let what = format!("`{key}.{name}` is not known to the reference");
        let value = value.try_into().into_diagnostic().wrap_err(what)?;
        Ok((name, value))
    };
    inner.into_iter().map(entry).collect()
}

impl Text {
    fn read(mut table: Table) -> Result<Text> {
        let simulation = table.get("simulation").and_then(Value::as_table);
        if simulation.is_some_and(|s| s.contains_key("gravity")) {
            return Err(miette!("the reference has no gravity"));
        }
        if let Some(forces) = table.get("forces").and_then(Value::as_table)
            && !forces.is_empty()
        {
            return Err(miette!("the reference has no forces but those of joints"));
        }
        let initial = table.remove("initial").map(Value::try_into::<InitialText>);
        Ok(Text {
            materials: entries(&mut table, "materials")?.into_iter().collect(),
            sections: entries(&mut table, "sections")?.into_iter().collect(),
            contacts: entries(&mut table, "contacts")?.into_iter().collect(),
            bodies: entries(&mut table, "bodies")?,
            joints: entries(&mut table, "joints")?,
            drives: entries(&mut table, "drives")?.into_iter().collect(),
            initial: initial.transpose().into_diagnostic()?.unwrap_or_default(),
        })
    }

    fn translate(&self) -> Result<Description> {
        let mut contacts = Vec::new();
        let mechanism = Mechanism {
            bodies: self
                .bodies
                .iter()
                .map(|(name, body)| self.body(name, body))
                .collect::<Result<_>>()?,
            joints: self
                .joints
                .iter()
                .map(|(_, joint)| self.joint(joint, &mut contacts))
                .collect::<Result<_>>()?,
            contacts,
            ..Mechanism::default()
        };
        let mut description = Description {
            mechanism,
            bodies: self.bodies.iter().map(|(name, _)| name.clone()).collect(),
            joints: self.joints.iter().map(|(name, _)| name.clone()).collect(),
            points: self.rigid_points(),
        };
        self.drive(&mut description)?;
        Ok(description)
    }

    /// Named points of rigid bodies, by name.
    fn rigid_points(&self) -> Vec<(usize, String, [f64; 2])> {
        let mut found = Vec::new();
        for (b, (_, body)) in self.bodies.iter().enumerate() {
            if let BodyText::RigidBody { points, .. } = body {
                let points = points.iter().map(|(name, at)| (b, name.clone(), at.xy()));
                found.extend(points);
            }
        }
        found.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
        found
    }

    fn material(&self, name: &str) -> Result<&Material> {
        let found = self.materials.get(name);
        found.ok_or_else(|| miette!("no material `{name}`"))
    }

    fn body(&self, name: &str, body: &BodyText) -> Result<Body> {
        Ok(match body {
            BodyText::Ground { .. } => Body {
                kind: body_kind::GROUND,
                ..Body::default()
            },
            BodyText::Link {
                model,
                length,
                section,
                material,
                elements,
            } => {
                let flexible = model == "flexible";
                let found = self.sections.get(section);
                let section = found.ok_or_else(|| miette!("no section `{section}`"))?;
                let material = self.material(material)?;
                Body {
                    kind: if flexible {
                        body_kind::FLEXIBLE_LINK
                    } else {
                        body_kind::RIGID_LINK
                    },
                    elements: if flexible { elements.unwrap_or(1) } else { 0 },
                    length: *length,
                    width: section.width,
                    height: section.height,
                    density: material.density,
                    youngs_modulus: if flexible {
                        material.youngs_modulus
                    } else {
                        0.0
                    },
                    ..Body::default()
                }
            }
            BodyText::RigidBody {
                mass,
                inertia,
                plate,
                ..
            } => {
                let mut body = Body {
                    kind: body_kind::RIGID_BODY,
                    mass: *mass,
                    inertia: *inertia,
                    ..Body::default()
                };
                if let Some(plate) = plate {
                    body.plate_circumradius = plate.circumradius;
                    body.plate_thickness = plate.thickness;
                    body.density = self.material(&plate.material)?.density;
                } else if *mass <= 0.0 {
                    return Err(miette!("`{name}` has neither a plate nor a mass"));
                }
                body
            }
        })
    }

    fn body_index(&self, name: &str) -> Result<usize> {
        let found = self.bodies.iter().position(|(n, _)| n == name);
        found.ok_or_else(|| miette!("no body `{name}`"))
    }

    fn joint_index(&self, name: &str) -> Result<usize> {
        let found = self.joints.iter().position(|(n, _)| n == name);
        found.ok_or_else(|| miette!("no joint `{name}`"))
    }

    /// `body.point`
    fn point(&self, text: &str) -> Result<Point> {
        let (body, point) = text
            .split_once('.')
            .ok_or_else(|| miette!("`{text}` is not a point"))?;
        let index = self.body_index(body)?;
        let [x, y] = match &self.bodies[index].1 {
            BodyText::Link { length, .. } => match point {
                "start" => [0.0, 0.0],
                "end" => [*length, 0.0],
                _ => return Err(miette!("a link has no point `{point}`")),
            },
            BodyText::Ground { points } | BodyText::RigidBody { points, .. } => {
                let found = points.get(point);
                found
                    .ok_or_else(|| miette!("`{body}` has no point `{point}`"))?
                    .xy()
            }
        };
        Ok(Point {
            body: small(index),
            reserved: 0,
            x,
            y,
        })
    }

    fn joint(&self, joint: &JointText, contacts: &mut Vec<Contact>) -> Result<Joint> {
        let mut contact = -1;
        if joint.model == "clearance" {
            let name = joint.contact.as_deref().unwrap_or_default();
            let text = self.contacts.get(name);
            let text = text.ok_or_else(|| miette!("no contact `{name}`"))?;
            contact = small(contacts.len());
            contacts.push(self.contact(text)?);
        }
        Ok(Joint {
            bearing: self.point(&joint.bearing)?,
            journal: self.point(&joint.journal)?,
            contact,
            reserved: 0,
        })
    }

    fn contact(&self, text: &ContactText) -> Result<Contact> {
        let mut contact = Contact {
            normal: match text.law.as_str() {
                "lankarani_nikravesh" => 0,
                "hunt_crossley" => 1,
                "flores" => 2,
                other => return Err(miette!("the reference has no contact law `{other}`")),
            },
            bearing_radius: text.bearing_radius,
            clearance: text.clearance,
            stiffness: text.stiffness,
            exponent: text.exponent,
            restitution: text.restitution,
            impact_velocity_floor: text.impact_velocity_floor,
            ..Contact::default()
        };
        if let (Some(bearing), Some(journal)) = (&text.bearing_material, &text.journal_material) {
            let (bearing, journal) = (self.material(bearing)?, self.material(journal)?);
            contact.bearing_modulus = bearing.youngs_modulus;
            contact.bearing_poisson = bearing.poissons_ratio;
            contact.journal_modulus = journal.youngs_modulus;
            contact.journal_poisson = journal.poissons_ratio;
        }
        if let Some(friction) = &text.friction {
            if friction.law != "ambrosio" {
                let law = &friction.law;
                return Err(miette!("the reference has no friction law `{law}`"));
            }
            contact.friction = 1;
            contact.slip = i32::from(friction.slip.as_deref() != Some("paper"));
            contact.friction_coefficient = friction.coefficient;
            contact.friction_v0 = friction.v0;
            contact.friction_v1 = friction.v1;
        }
        Ok(contact)
    }

    /// Path and legs A-B-C of the driven body.
    fn drive(&self, description: &mut Description) -> Result<()> {
        let mut drives = self.drives.values();
        let Some(drive) = drives.next() else {
            return Ok(());
        };
        if drives.next().is_some() {
            return Err(miette!("the reference follows one drive"));
        }
        let body = self.body_index(&drive.body)?;
        description.mechanism.path = Path {
            body: small(body),
            reserved: 0,
            centre_x: drive.path.center[0],
            centre_y: drive.path.center[1],
            radius: drive.path.radius,
            frequency: drive.path.frequency,
            phase: drive.path.phase,
            theta: drive.path.theta,
        };
        for name in &drive.joints {
            let leg = self.leg(name, &description.mechanism)?;
            description.mechanism.legs.push(leg);
        }
        Ok(())
    }

    /// The joints of a leg, and on which side of A C the sketch puts B.
    fn leg(&self, a_name: &str, mechanism: &Mechanism) -> Result<Leg> {
        let joints = &mechanism.joints;
        let a = self.joint_index(a_name)?;
        let crank = joints[a].journal.body;
        let b = joints
            .iter()
            .position(|j| j.bearing.body == crank)
            .ok_or_else(|| miette!("the crank of {a_name} carries no joint"))?;
        let link = joints[b].journal.body;
        let c = joints
            .iter()
            .position(|j| j.journal.body == link && j.bearing.body == mechanism.path.body)
            .ok_or_else(|| miette!("the leg of {a_name} does not end on the driven body"))?;
        let b_name = &self.joints[b].0;
        let sketch = self.initial.sketch.get(b_name);
        let [bx, by] = *sketch.ok_or_else(|| miette!("no sketch of {b_name}"))?;
        let path = &mechanism.path;
        let (sin, cos) = path.theta.sin_cos();
        let point = joints[c].bearing;
        let cx = path.centre_x + path.radius * path.phase.cos() + cos * point.x - sin * point.y;
        let cy = path.centre_y + path.radius * path.phase.sin() + sin * point.x + cos * point.y;
        let from = joints[a].bearing;
        let turn = (bx - from.x) * (cy - by) - (by - from.y) * (cx - bx);
        Ok(Leg {
            joint_a: small(a),
            joint_b: small(b),
            joint_c: small(c),
            elbow: if turn > 0.0 { 1 } else { -1 },
        })
    }
}

fn small(index: usize) -> i32 {
    i32::try_from(index).expect("a mechanism is small")
}
