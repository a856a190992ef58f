//! What no machine has, and what is therefore most likely a number in another unit than that of SI, or in another key.
//!
//! The bounds are those of nature and of engineering as a whole, not those of a good design: whatever lies within them is left alone.

use super::{MotionKind, Scene};
use crate::body::{Body, Known, Link};
use crate::interaction::{Contact, TorsionSpringModel};
use crate::motion::{Circle, Function, Path};
use numbers::{exact, number};
use std::any::Any;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

/// Densities \[kg/m3\]: from light foams, about 10, to osmium, 22,590.
const DENSITY: [f64; 2] = [10.0, 25_000.0];
/// Between what solids have in g/cm3, 0.1 at least, and what they have in kg/mm3, 2.3e-5 at most, lie densities of parts that are meant
/// to have no mass.
const MASSLESS: [f64; 2] = [1e-4, 0.1];
/// Young's moduli \[Pa\]: from soft gels and silicones, about 1e5, to diamond, 1.2e12.
const YOUNGS_MODULUS: [f64; 2] = [1e5, 2e12];
/// Largest width of a flexible link over its length. Shear, which a slender link does not have, adds E/(4 k G) (w/l)^2 to the
/// deflection of a cantilever, with k = 5/6 and E/G = 2.6 0.78 (w/l)^2: 3 % here.
const FLEXIBLE_WIDTH: f64 = 0.2;
/// The same of a rigid link, whose moment of inertia m l^2/12 leaves out m w^2/12: as much as it has here.
const RIGID_WIDTH: f64 = 1.0;
/// Largest clearance over the radius of the bearing. The loosest fit of ISO 286 for running parts, H11/c11, has 2.6 % of play at a
/// diameter of 10 mm.
const PLAY: f64 = 0.1;
/// Sizes of mechanisms \[m\]: a millionth of a metre, below which continuum mechanics of links ends, and a kilometre, as long as the
/// largest conveyors and bridges that move as one mechanism.
const SIZE: [f64; 2] = [1e-6, 1e3];
/// Largest mass of a body \[kg\]: a loaded mining truck has 6e5.
const MASS: f64 = 1e6;
/// Gravity \[m/s2\]: from Ceres, 0.28, to Jupiter, 24.8.
const GRAVITY: [f64; 2] = [0.1, 30.0];
/// Largest coefficient of friction: racing tyres reach 2; only clean metals in a vacuum exceed this.
const FRICTION: f64 = 5.0;
/// How much larger than the mechanism the radius of a bearing or the radius of gyration of a body can be: an eccentric and a flywheel
/// are larger than their cranks, but not by an order of magnitude.
const BEYOND: f64 = 10.0;
/// How much larger a body can be than all others: less than the thousand between two prefixes of SI units.
const ALONE: f64 = 100.0;
/// Fewest steps \[1\] that are told: a run with an accuracy is refused beyond them.
const STEPS: f64 = 1e8;

const ASK: &str = "are these SI units?";

impl Scene {
    /// What lies outside of what any machine has, each with its value and a question.
    pub fn implausible(&self) -> Vec<String> {
        let mut told = Vec::new();
        self.judge_simulation(&mut told);
        self.judge_materials(&mut told);
        self.judge_bodies(&mut told);
        self.judge_contacts(&mut told);
        self.judge_angles(&mut told);
        told
    }

    fn judge_simulation(&self, told: &mut Vec<String>) {
        let [least, most] = GRAVITY;
        let gravity = self.simulation.gravity.map_or(0.0, |[x, y]| x.hypot(y));
        if gravity != 0.0 && !(least..=most).contains(&gravity) {
            told.push(format!(
                "simulation.gravity is {} m/s2, out of the range of all planets: {ASK} The earth has 9.81 m/s2",
                number(gravity, 4)
            ));
        }
        // no step is longer than the time between rows
        let step = self.integrator.step().unwrap_or(self.output.interval);
        let steps = self.simulation.duration / step;
        if steps >= STEPS * (1.0 - f64::EPSILON) {
            told.push(format!(
                "simulation.duration is {} s, which takes {} steps of {} s at least: is it in seconds?",
                exact(self.simulation.duration),
                number(steps, 2),
                exact(step)
            ));
        }
    }

    fn judge_materials(&self, told: &mut Vec<String>) {
        let out = |[least, most]: [f64; 2], x: f64| !(least..=most).contains(&x);
        for (name, material) in &self.materials {
            if out(DENSITY, material.density) && out(MASSLESS, material.density) {
                told.push(format!(
                    "materials.{name}.density is {} kg/m3, out of the range of all materials: {ASK} The density of steel is 7850 kg/m3",
                    number(material.density, 4)
                ));
            }
            if let Some(modulus) = material.youngs_modulus.filter(|e| out(YOUNGS_MODULUS, *e)) {
                told.push(format!(
                    "materials.{name}.youngs_modulus is {} Pa, out of the range of all materials: {ASK} Young's modulus of steel is \
                     210e9 Pa",
                    number(modulus, 4)
                ));
            }
        }
    }

    /// The sizes of the two largest bodies \[m\].
    fn two_largest(&self) -> [f64; 2] {
        let extents = self.bodies.iter().map(|body| extent(&*body.kind));
        extents.fold([0.0; 2], |[first, second], extent| match () {
            () if extent > first => [extent, first],
            () => [first, second.max(extent)],
        })
    }

    fn judge_bodies(&self, told: &mut Vec<String>) {
        let [largest, second] = self.two_largest();
        for body in &self.bodies {
            let name = &body.name;
            let own = extent(&*body.kind);
            let moves = body.kind.known().is_none();
            let others = if own < largest { largest } else { second };
            if own > SIZE[1] || own > 0.0 && largest < SIZE[0] {
                told.push(format!("body {name} is {} m large: {ASK}", number(own, 4)));
            } else if moves && others > 0.0 && own > ALONE * others {
                told.push(format!(
                    "body {name} is {} m large, but the next largest {} m: {ASK}",
                    number(own, 4),
                    number(others, 4)
                ));
            }
            let (slender, theory) = match body.kind.is_rigid() {
                true => (RIGID_WIDTH, "A link is longer than wide"),
                false => (
                    FLEXIBLE_WIDTH,
                    "The theory of flexible links is that of slender beams, with a width of at most a fifth of the length",
                ),
            };
            if let Some(link) = body.kind.link()
                && width(link) > slender * link.length
            {
                told.push(format!(
                    "link {name} is {} m wide in the plane and {} m long: {ASK} {theory}",
                    number(width(link), 4),
                    number(link.length, 4)
                ));
            }
            let Some(mass) = body.kind.mass() else {
                continue;
            };
            if mass > MASS {
                let mass = number(mass, 4);
                told.push(format!("the mass of body {name} is {mass} kg: {ASK}"));
            }
            let gyration = body.kind.size();
            if largest > 0.0 && gyration > BEYOND * largest {
                told.push(format!(
                    "the inertia of body {name} is that of its mass at {} m from its centre, but the largest body has a size of {} m: \
                     {ASK} The unit of inertia is kg m2",
                    number(gyration, 4),
                    number(largest, 4)
                ));
            }
        }
    }

    fn judge_contacts(&self, told: &mut Vec<String>) {
        let [largest, _] = self.two_largest();
        let mut seen = BTreeSet::new();
        let contacts = self.joints.iter().filter_map(|joint| joint.contact());
        for contact in contacts.filter(|contact| seen.insert(&contact.name)) {
            let Contact {
                name, clearance, ..
            } = contact;
            if let Some(radius) = contact.bearing_radius {
                let shown = number(radius, 4);
                if *clearance > PLAY * radius {
                    told.push(format!(
                        "contacts.{name}.clearance is {} m in a bearing_radius of {shown} m: {ASK} The play of a bearing is far less \
                         than a tenth of its radius",
                        number(*clearance, 4)
                    ));
                }
                if largest > 0.0 && radius > BEYOND * largest {
                    told.push(format!(
                        "contacts.{name}.bearing_radius is {shown} m, but the largest body has a size of {} m: {ASK}",
                        number(largest, 4)
                    ));
                }
            }
            let coefficient = contact.friction.iter();
            let coefficient = coefficient.map(|friction| friction.law.largest_coefficient());
            for (key, value) in coefficient.filter(|(_, value)| *value > FRICTION) {
                told.push(format!(
                    "contacts.{name}.friction.{key} is {}: is it in per cent? Dry steel has about 0.1 to 0.6",
                    number(value, 4)
                ));
            }
        }
    }

    /// Angles that are numbers of degrees.
    fn judge_angles(&self, told: &mut Vec<String>) {
        let mut judge = |what: String, angle: f64| {
            if is_in_degrees(angle) {
                told.push(format!(
                    "{what} is {} rad, {} turns: are these degrees? Angles are in radians, and {} degrees are {} rad",
                    exact(angle),
                    number(angle / TAU, 3),
                    exact(angle),
                    number(angle.to_radians(), 6)
                ));
            }
        };
        for state in self.initial.bodies.values() {
            let name = &self.bodies[state.body].name;
            let [.., theta] = state.position;
            judge(format!("initial.bodies.{name}.theta"), theta);
        }
        for motion in &self.motions {
            if let MotionKind::Angle { angle, .. } = &motion.kind {
                let typed = typed(angle);
                let degrees = typed.into_iter().find(|angle| is_in_degrees(*angle));
                degrees
                    .into_iter()
                    .for_each(|angle| judge(format!("drives.{}.angle", motion.name), angle));
            }
        }
        let driven = self
            .drives
            .iter()
            .map(|drive| (format!("drives.{}", drive.name), &drive.path));
        let moving = self
            .bodies
            .iter()
            .filter_map(|body| match body.kind.known()? {
                Known::Path(path) => Some((format!("bodies.{}", body.name), path)),
                Known::Fixed => None,
            });
        for (owner, path) in driven.chain(moving) {
            let path: &dyn Path = &**path;
            let [.., theta] = path.at(0.0).position;
            judge(format!("the theta of {owner}.path at t = 0"), theta);
            if let Some(circle) = (path as &dyn Any).downcast_ref::<Circle>() {
                judge(format!("{owner}.path.phase"), circle.phase);
            }
        }
        for force in &self.forces {
            if let Some(spring) = force.kind.get::<TorsionSpringModel>() {
                judge(
                    format!("forces.{}.rest_angle", force.name),
                    spring.rest_angle,
                );
            }
        }
        for joint in &self.joints {
            if let Some(angle) = joint.model.angle() {
                judge(format!("joints.{}.angle", joint.name), angle);
            }
        }
    }
}

/// The diagonal of a box around the points of a body, or its diameter \[m\].
fn extent(body: &dyn Body) -> f64 {
    let points = || body.points().iter().map(|point| point.at);
    let box_of_points = points().next().map_or(0.0, |first| {
        let least = points().fold(first, |a, b| a.inf(&b));
        let most = points().fold(first, |a, b| a.sup(&b));
        (most - least).norm()
    });
    box_of_points.max(2.0 * body.radius().unwrap_or(0.0))
}

/// The width of a rectangular section w h, whose second moment is h w^3/12 \[m\].
fn width(link: &Link) -> f64 {
    (12.0 * link.second_moment / link.area).sqrt()
}

/// True of more than a turn in a whole number of halves: multiples of pi are no such numbers, degrees usually are.
fn is_in_degrees(angle: f64) -> bool {
    angle.abs() > TAU && is_halves(angle)
}

/// True of a whole number of halves.
fn is_halves(angle: f64) -> bool {
    (2.0 * angle).fract() == 0.0
}

/// The angles among the numbers of a function of time.
fn typed(function: &Function) -> Vec<f64> {
    // one row of many may be a whole number by chance
    let all_halves = |values: &[[f64; 1]]| -> Vec<f64> {
        let values = values.iter().map(|[value]| *value);
        match values.clone().all(is_halves) {
            true => values.collect(),
            false => Vec::new(),
        }
    };
    match function {
        Function::Constant(value) => vec![*value],
        Function::Polynomial(coefficients) => coefficients.iter().take(1).copied().collect(),
        Function::Harmonic {
            mean, amplitude, ..
        } => vec![*mean, *amplitude],
        Function::Ramp(step) | Function::SmoothStep(step) => vec![step.from, step.to],
        Function::SpinUp { start, .. } => vec![*start],
        Function::Piecewise(rows) => rows.iter().map(|[_, value]| *value).collect(),
        Function::Table(table) => all_halves(table.values()),
        Function::MonotoneTable(table) => all_halves(table.values()),
        Function::Expression(expression) => {
            let [at_start, ..] = expression.at(0.0);
            vec![at_start]
        }
        Function::Own(_) => Vec::new(),
    }
}
