//! A scene as the reference implementation takes it, read from the TOML text on its own.
//!
//! Nothing passes through Looselink's reader: sections, densities, moduli and radii reach the C++ side as they are typed,
//! and it derives masses, stiffnesses and inertias itself.

use crate::reference::{
    Body, Contact, Function, Joint, Leg, Load, Mechanism, Motion, Path, Point, Spring,
    TorsionSpring, body_kind, function_kind, joint_kind, load_kind, motion_kind,
};
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
    /// Named points of bodies but the ground: body, name, place in the terms of the mechanism \[m\].
    pub points: Vec<(usize, String, [f64; 2])>,
    /// Names of the driven joint or point, of the drive, and of what is driven, for each motion.
    pub motions: Vec<[String; 3]>,
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
#[serde(tag = "type", rename_all = "snake_case")]
enum JointText {
    Revolute {
        bearing: String,
        journal: String,
        model: String,
        contact: Option<String>,
    },
    Prismatic {
        guide: String,
        direction: [f64; 2],
        slider: String,
        rotation: String,
        #[serde(default)]
        angle: f64,
    },
    Weld {
        first: String,
        second: String,
        #[serde(default)]
        angle: f64,
        slope: Option<String>,
    },
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
        #[serde(default)]
        points: HashMap<String, f64>,
        #[serde(default)]
        kelvin_voigt: f64,
        #[serde(default)]
        rayleigh: Rayleigh,
    },
    RigidBody {
        #[serde(default)]
        mass: f64,
        #[serde(default)]
        inertia: f64,
        plate: Option<Plate>,
        #[serde(default)]
        center_of_mass: [f64; 2],
        #[serde(default)]
        points: HashMap<String, Place>,
    },
    PointMass {
        mass: f64,
    },
    Moving {
        path: PathText,
        #[serde(default)]
        points: HashMap<String, Place>,
    },
}

#[derive(Deserialize, Default)]
struct Rayleigh {
    mass: f64,
    stiffness: f64,
}

#[derive(Deserialize)]
struct Plate {
    shape: String,
    circumradius: f64,
    thickness: f64,
    material: String,
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum DriveText {
    InverseKinematics {
        joints: Vec<String>,
        body: String,
        path: PathText,
    },
    Angle {
        joint: String,
        angle: FunctionText,
    },
    Point {
        point: String,
        x: Option<FunctionText>,
        y: Option<FunctionText>,
    },
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum PathText {
    Circle {
        center: [f64; 2],
        radius: f64,
        frequency: f64,
        phase: f64,
        theta: f64,
    },
    Line {
        from: [f64; 3],
        to: [f64; 3],
        duration: f64,
    },
    Coordinates {
        x: FunctionText,
        y: FunctionText,
        theta: FunctionText,
    },
}

#[derive(Deserialize)]
#[serde(untagged)]
enum FunctionText {
    Number(f64),
    Named(NamedFunction),
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum NamedFunction {
    Polynomial {
        coefficients: Vec<f64>,
    },
    Harmonic {
        mean: f64,
        amplitude: f64,
        frequency: f64,
        phase: f64,
    },
    Ramp {
        from: f64,
        to: f64,
        start: f64,
        duration: f64,
    },
    SmoothStep {
        from: f64,
        to: f64,
        start: f64,
        duration: f64,
    },
    SpinUp {
        start: f64,
        speed: f64,
        duration: f64,
    },
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
enum ForceText {
    SpringDamper {
        from: String,
        to: String,
        stiffness: f64,
        damping: f64,
        rest_length: f64,
    },
    TorsionSpring {
        joint: String,
        stiffness: f64,
        damping: f64,
        rest_angle: f64,
    },
    Force {
        point: String,
        x: FunctionText,
        y: FunctionText,
        frame: String,
    },
    Torque {
        point: String,
        reaction: Option<String>,
        value: FunctionText,
    },
}

#[derive(Deserialize, Default)]
struct InitialText {
    #[serde(default)]
    sketch: Table,
}

/// All that the reference needs of a scene; order of bodies and joints is that of the file.
struct Text {
    materials: HashMap<String, Material>,
    sections: HashMap<String, Section>,
    contacts: HashMap<String, ContactText>,
    bodies: Vec<(String, BodyText)>,
    joints: Vec<(String, JointText)>,
    drives: Vec<(String, DriveText)>,
    forces: Vec<(String, ForceText)>,
    gravity: [f64; 2],
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
        let gravity = simulation.and_then(|s| s.get("gravity")).cloned();
        let gravity = gravity.map(Value::try_into).transpose();
        let initial = table.remove("initial").map(Value::try_into::<InitialText>);
        Ok(Text {
            materials: entries(&mut table, "materials")?.into_iter().collect(),
            sections: entries(&mut table, "sections")?.into_iter().collect(),
            contacts: entries(&mut table, "contacts")?.into_iter().collect(),
            bodies: entries(&mut table, "bodies")?,
            joints: entries(&mut table, "joints")?,
            drives: entries(&mut table, "drives")?,
            forces: entries(&mut table, "forces")?,
            gravity: gravity.into_diagnostic()?.unwrap_or_default(),
            initial: initial.transpose().into_diagnostic()?.unwrap_or_default(),
        })
    }

    fn translate(&self) -> Result<Description> {
        let mut mechanism = Mechanism {
            gravity: self.gravity,
            ..Mechanism::default()
        };
        for (name, body) in &self.bodies {
            let body = self.body(name, body, &mut mechanism.functions)?;
            mechanism.bodies.push(body);
        }
        for (_, joint) in &self.joints {
            let joint = self.joint(joint, &mut mechanism.contacts)?;
            mechanism.joints.push(joint);
        }
        for (_, force) in &self.forces {
            self.force(force, &mut mechanism)?;
        }
        let mut description = Description {
            mechanism,
            bodies: self.bodies.iter().map(|(name, _)| name.clone()).collect(),
            joints: self.joints.iter().map(|(name, _)| name.clone()).collect(),
            points: self.named_points(),
            motions: Vec::new(),
        };
        for (name, drive) in &self.drives {
            self.drive(name, drive, &mut description)?;
        }
        Ok(description)
    }

    /// Named points of bodies but the ground, by name.
    fn named_points(&self) -> Vec<(usize, String, [f64; 2])> {
        let mut found = Vec::new();
        for (b, (_, body)) in self.bodies.iter().enumerate() {
            match body {
                BodyText::Ground { .. } => {}
                BodyText::RigidBody {
                    points,
                    center_of_mass: [x, y],
                    ..
                } => {
                    let from_centre = |at: &Place| {
                        let [px, py] = at.xy();
                        [px - x, py - y]
                    };
                    let points = points.iter();
                    found.extend(points.map(|(name, at)| (b, name.clone(), from_centre(at))));
                }
                BodyText::Moving { points, .. } => {
                    let points = points.iter();
                    found.extend(points.map(|(name, at)| (b, name.clone(), at.xy())));
                }
                BodyText::PointMass { .. } => found.push((b, "center".into(), [0.0; 2])),
                BodyText::Link { length, points, .. } => {
                    found.push((b, "start".into(), [0.0; 2]));
                    found.push((b, "end".into(), [*length, 0.0]));
                    let points = points.iter();
                    found.extend(points.map(|(name, at)| (b, name.clone(), [*at, 0.0])));
                }
            }
        }
        found.sort_by(|a, b| (a.0, &a.1).cmp(&(b.0, &b.1)));
        found
    }

    fn material(&self, name: &str) -> Result<&Material> {
        let found = self.materials.get(name);
        found.ok_or_else(|| miette!("no material `{name}`"))
    }

    fn body(&self, name: &str, body: &BodyText, functions: &mut Vec<Function>) -> Result<Body> {
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
                kelvin_voigt,
                rayleigh,
                ..
            } => {
                let found = self.sections.get(section);
                let section = found.ok_or_else(|| miette!("no section `{section}`"))?;
                let material = self.material(material)?;
                let rigid = Body {
                    kind: body_kind::RIGID_LINK,
                    length: *length,
                    width: section.width,
                    height: section.height,
                    density: material.density,
                    ..Body::default()
                };
                if model != "flexible" {
                    return Ok(rigid);
                }
                Body {
                    kind: body_kind::FLEXIBLE_LINK,
                    elements: elements.unwrap_or(1),
                    youngs_modulus: material.youngs_modulus,
                    strain_damping: kelvin_voigt + rayleigh.stiffness,
                    mass_damping: rayleigh.mass,
                    ..rigid
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
                    if plate.shape != "equilateral_triangle" || *mass > 0.0 {
                        let shape = &plate.shape;
                        return Err(miette!(
                            "the reference has no plate `{shape}` of a given mass"
                        ));
                    }
                    body.plate_circumradius = plate.circumradius;
                    body.plate_thickness = plate.thickness;
                    body.density = self.material(&plate.material)?.density;
                } else if *mass <= 0.0 {
                    return Err(miette!("`{name}` has neither a plate nor a mass"));
                }
                body
            }
            BodyText::PointMass { mass } => Body {
                kind: body_kind::POINT_MASS,
                mass: *mass,
                ..Body::default()
            },
            BodyText::Moving { path, .. } => {
                let function = small(functions.len());
                functions.extend(path.functions()?);
                Body {
                    kind: body_kind::MOVING_BODY,
                    function,
                    ..Body::default()
                }
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
        if let BodyText::Ground { points } = &self.bodies[index].1 {
            let found = points.get(point);
            let found = found.ok_or_else(|| miette!("the ground has no point `{point}`"))?;
            let [x, y] = found.xy();
            let body = small(index);
            return Ok(Point {
                body,
                reserved: 0,
                x,
                y,
            });
        }
        let points = self.named_points();
        let found = points.iter().find(|(b, p, _)| *b == index && p == point);
        let [x, y] = found
            .ok_or_else(|| miette!("`{body}` has no point `{point}`"))?
            .2;
        Ok(Point {
            body: small(index),
            reserved: 0,
            x,
            y,
        })
    }

    fn joint(&self, joint: &JointText, contacts: &mut Vec<Contact>) -> Result<Joint> {
        let ideal = Joint {
            contact: -1,
            ..Joint::default()
        };
        Ok(match joint {
            JointText::Revolute {
                bearing,
                journal,
                model,
                contact,
            } => {
                let mut joint = Joint {
                    kind: joint_kind::REVOLUTE,
                    bearing: self.point(bearing)?,
                    journal: self.point(journal)?,
                    ..ideal
                };
                if model == "clearance" {
                    let name = contact.as_deref().unwrap_or_default();
                    let text = self.contacts.get(name);
                    let text = text.ok_or_else(|| miette!("no contact `{name}`"))?;
                    joint.contact = small(contacts.len());
                    contacts.push(self.contact(text)?);
                }
                joint
            }
            JointText::Prismatic {
                guide,
                direction: [x, y],
                slider,
                rotation,
                angle,
            } => Joint {
                kind: joint_kind::PRISMATIC,
                bearing: self.point(guide)?,
                journal: self.point(slider)?,
                direction: y.atan2(*x),
                hold_rotation: i32::from(rotation == "locked"),
                angle: *angle,
                ..ideal
            },
            JointText::Weld {
                first,
                second,
                angle,
                slope,
            } => Joint {
                kind: joint_kind::WELD,
                bearing: self.point(first)?,
                journal: self.point(second)?,
                hold_slope: i32::from(
                    slope.as_deref() == Some("vector")
                        && [first, second].iter().any(|point| self.bends(point)),
                ),
                angle: *angle,
                ..ideal
            },
        })
    }

    /// Whether a point belongs to a flexible link.
    fn bends(&self, point: &str) -> bool {
        let body = point.split('.').next().unwrap_or_default();
        let found = self.bodies.iter().find(|(name, _)| name == body);
        matches!(found, Some((_, BodyText::Link { model, .. })) if model == "flexible")
    }

    /// Adds a spring or a load.
    fn force(&self, force: &ForceText, mechanism: &mut Mechanism) -> Result<()> {
        let mut function = |text: &FunctionText| -> Result<i32> {
            mechanism.functions.push(text.function()?);
            Ok(small(mechanism.functions.len() - 1))
        };
        let nowhere = Point {
            body: -1,
            ..Point::default()
        };
        match force {
            ForceText::SpringDamper {
                from,
                to,
                stiffness,
                damping,
                rest_length,
            } => mechanism.springs.push(Spring {
                from: self.point(from)?,
                to: self.point(to)?,
                stiffness: *stiffness,
                damping: *damping,
                rest_length: *rest_length,
            }),
            ForceText::TorsionSpring {
                joint,
                stiffness,
                damping,
                rest_angle,
            } => mechanism.torsion_springs.push(TorsionSpring {
                joint: small(self.joint_index(joint)?),
                reserved: 0,
                stiffness: *stiffness,
                damping: *damping,
                rest_angle: *rest_angle,
            }),
            ForceText::Force { point, x, y, frame } => {
                let load = Load {
                    kind: if frame == "body" {
                        load_kind::FOLLOWER_FORCE
                    } else {
                        load_kind::DEAD_FORCE
                    },
                    x: function(x)?,
                    y: function(y)?,
                    reserved: 0,
                    point: self.point(point)?,
                    reaction: nowhere,
                };
                mechanism.loads.push(load);
            }
            ForceText::Torque {
                point,
                reaction,
                value,
            } => {
                let value = function(value)?;
                let reaction = reaction.as_ref().map(|point| self.point(point));
                mechanism.loads.push(Load {
                    kind: load_kind::TORQUE,
                    x: value,
                    y: value,
                    reserved: 0,
                    point: self.point(point)?,
                    reaction: reaction.transpose()?.unwrap_or(nowhere),
                });
            }
        }
        Ok(())
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

    /// Path and legs A-B-C of a driven body, or the motion of an angle or of a point.
    fn drive(&self, name: &str, drive: &DriveText, description: &mut Description) -> Result<()> {
        let mechanism = &mut description.mechanism;
        match drive {
            DriveText::InverseKinematics { joints, body, path } => {
                let PathText::Circle {
                    center: [centre_x, centre_y],
                    radius,
                    frequency,
                    phase,
                    theta,
                } = *path
                else {
                    return Err(miette!("the reference's legs follow circles alone"));
                };
                mechanism.path = Path {
                    body: small(self.body_index(body)?),
                    reserved: 0,
                    centre_x,
                    centre_y,
                    radius,
                    frequency,
                    phase,
                    theta,
                };
                for name in joints {
                    let leg = self.leg(name, mechanism)?;
                    mechanism.legs.push(leg);
                }
            }
            DriveText::Angle { joint, angle } => {
                mechanism.functions.push(angle.function()?);
                mechanism.motions.push(Motion {
                    kind: motion_kind::ANGLE,
                    function: small(mechanism.functions.len() - 1),
                    joint: small(self.joint_index(joint)?),
                    ..Motion::default()
                });
                let names = [joint, name, "angle"].map(str::to_owned);
                description.motions.push(names);
            }
            DriveText::Point { point, x, y } => {
                for (value, part, [nx, ny]) in [(x, "x", [1.0, 0.0]), (y, "y", [0.0, 1.0])] {
                    let Some(value) = value else {
                        continue;
                    };
                    mechanism.functions.push(value.function()?);
                    mechanism.motions.push(Motion {
                        kind: motion_kind::COORDINATE,
                        function: small(mechanism.functions.len() - 1),
                        joint: -1,
                        reserved: 0,
                        point: self.point(point)?,
                        nx,
                        ny,
                    });
                    let names = [point, name, part].map(str::to_owned);
                    description.motions.push(names);
                }
            }
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
        let sketch = self.initial.sketch.get(b_name).cloned();
        let sketch = sketch.ok_or_else(|| miette!("no sketch of {b_name}"))?;
        let [bx, by]: [f64; 2] = sketch.try_into().into_diagnostic()?;
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

impl PathText {
    /// x, y and theta.
    fn functions(&self) -> Result<[Function; 3]> {
        Ok(match self {
            PathText::Circle {
                center: [x, y],
                radius,
                frequency,
                phase,
                theta,
            } => {
                let wave = |mean: f64, phase: f64| Function {
                    kind: function_kind::HARMONIC,
                    reserved: 0,
                    c: [mean, *radius, *frequency, phase, 0.0, 0.0],
                };
                // cos is sin a quarter turn ahead
                [
                    wave(*x, phase + 0.25 * TAU),
                    wave(*y, *phase),
                    FunctionText::Number(*theta).function()?,
                ]
            }
            PathText::Line { from, to, duration } => [0, 1, 2].map(|i| Function {
                kind: function_kind::SMOOTH_STEP,
                reserved: 0,
                c: [from[i], to[i], 0.0, *duration, 0.0, 0.0],
            }),
            PathText::Coordinates { x, y, theta } => {
                [x.function()?, y.function()?, theta.function()?]
            }
        })
    }
}

impl FunctionText {
    fn function(&self) -> Result<Function> {
        let (kind, values): (i32, &[f64]) = match self {
            FunctionText::Number(value) => (function_kind::POLYNOMIAL, &[*value]),
            FunctionText::Named(NamedFunction::Polynomial { coefficients }) => {
                (function_kind::POLYNOMIAL, coefficients)
            }
            FunctionText::Named(NamedFunction::Harmonic {
                mean,
                amplitude,
                frequency,
                phase,
            }) => (
                function_kind::HARMONIC,
                &[*mean, *amplitude, *frequency, *phase],
            ),
            FunctionText::Named(NamedFunction::Ramp {
                from,
                to,
                start,
                duration,
            }) => (function_kind::RAMP, &[*from, *to, *start, *duration]),
            FunctionText::Named(NamedFunction::SmoothStep {
                from,
                to,
                start,
                duration,
            }) => (function_kind::SMOOTH_STEP, &[*from, *to, *start, *duration]),
            FunctionText::Named(NamedFunction::SpinUp {
                start,
                speed,
                duration,
            }) => (function_kind::SPIN_UP, &[*start, *speed, *duration]),
        };
        let mut c = [0.0; 6];
        let places = c.get_mut(..values.len());
        let places = places.ok_or_else(|| miette!("the reference's polynomials end at t^5"))?;
        places.copy_from_slice(values);
        Ok(Function {
            kind,
            reserved: 0,
            c,
        })
    }
}

fn small(index: usize) -> i32 {
    i32::try_from(index).expect("a mechanism is small")
}
