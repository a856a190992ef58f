//! The names of all channels of a mechanism, and what each shows.

use crate::model::Model;
use crate::scene::Analysis;
use crate::system::Integral;

/// A recorded quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// The name in the scene and in the header.
    pub name: String,
    /// The unit.
    pub unit: &'static str,
}

/// What a channel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    /// Body, level (position, velocity, acceleration), component.
    Pose(usize, usize, usize),
    Joint(usize, JointQuantity),
    /// Joint; angle, speed, torque.
    Actuator(usize, usize),
    Strain(usize),
    /// Body, point, level, component.
    Point(usize, usize, usize, usize),
    /// Body, point, component of the slope.
    Slope(usize, usize, usize),
    /// Named force, which of its quantities.
    Force(usize, usize),
    /// Driven body, component.
    Error(usize, usize),
    Energy(Energy),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JointQuantity {
    Fx,
    Fy,
    Force,
    Ex,
    Ey,
    Eccentricity,
    ExRate,
    EyRate,
    EccentricityRate,
    Penetration,
    Contact,
    /// Couple of the first side on the second.
    Couple,
    Angle,
    Speed,
    Travel,
    TravelRate,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Energy {
    Kinetic,
    Axial,
    Bending,
    Contact,
    Gravity,
    Springs,
    Integral(Integral),
    Numerical,
}

/// Names and units of a pose at the levels of position, velocity and acceleration.
const LEVELS: [[(&str, &str); 3]; 3] = [
    [("x", "m"), ("y", "m"), ("theta", "rad")],
    [("vx", "m/s"), ("vy", "m/s"), ("omega", "rad/s")],
    [("ax", "m/s2"), ("ay", "m/s2"), ("alpha", "rad/s2")],
];

/// Quantities of every joint, of those with clearance, with a motion that is prescribed, and with a line.
const FORCE: [(&str, &str, JointQuantity); 3] = [
    ("fx", "N", JointQuantity::Fx),
    ("fy", "N", JointQuantity::Fy),
    ("force", "N", JointQuantity::Force),
];
const CLEARANCE: [(&str, &str, JointQuantity); 8] = [
    ("ex", "m", JointQuantity::Ex),
    ("ey", "m", JointQuantity::Ey),
    ("eccentricity", "m", JointQuantity::Eccentricity),
    ("penetration", "m", JointQuantity::Penetration),
    ("ex_rate", "m/s", JointQuantity::ExRate),
    ("ey_rate", "m/s", JointQuantity::EyRate),
    ("eccentricity_rate", "m/s", JointQuantity::EccentricityRate),
    ("contact", "1", JointQuantity::Contact),
];
const TURNED: [(&str, &str, JointQuantity); 2] = [
    ("angle", "rad", JointQuantity::Angle),
    ("speed", "rad/s", JointQuantity::Speed),
];
const COUPLE: [(&str, &str, JointQuantity); 1] = [("torque", "N m", JointQuantity::Couple)];
const LINE: [(&str, &str, JointQuantity); 2] = [
    ("travel", "m", JointQuantity::Travel),
    ("travel_rate", "m/s", JointQuantity::TravelRate),
];
const ACTUATOR: [(&str, &str); 3] = [("angle", "rad"), ("speed", "rad/s"), ("torque", "N m")];

const ENERGIES: [(&str, Energy); 12] = [
    ("kinetic", Energy::Kinetic),
    ("axial", Energy::Axial),
    ("bending", Energy::Bending),
    ("contact", Energy::Contact),
    ("gravity", Energy::Gravity),
    ("springs", Energy::Springs),
    ("work", Energy::Integral(Integral::Work)),
    (
        "contact_dissipated",
        Energy::Integral(Integral::ContactDissipated),
    ),
    (
        "friction_dissipated",
        Energy::Integral(Integral::FrictionDissipated),
    ),
    (
        "damping_dissipated",
        Energy::Integral(Integral::DampingDissipated),
    ),
    ("clamp", Energy::Integral(Integral::Clamp)),
    ("numerical", Energy::Numerical),
];

/// A list of channels.
#[derive(Default)]
struct List(Vec<(Channel, Quantity)>);

impl List {
    fn add(&mut self, name: String, unit: &'static str, quantity: Quantity) {
        self.0.push((Channel { name, unit }, quantity));
    }

    fn bodies(&mut self, model: &Model) {
        for (b, body) in model
            .bodies()
            .iter()
            .enumerate()
            .filter(|(_, body)| body.moves)
        {
            for (l, level) in LEVELS.iter().enumerate() {
                for (i, (name, unit)) in level.iter().enumerate() {
                    self.add(
                        format!("{}.{name}", body.name),
                        unit,
                        Quantity::Pose(b, l, i),
                    );
                }
            }
            if !body.placed.kind.is_rigid() {
                self.add(format!("{}.strain", body.name), "1", Quantity::Strain(b));
            }
            if body.prescribed.is_some() {
                for (i, (name, unit)) in LEVELS[0].iter().enumerate() {
                    self.add(format!("error.{name}"), unit, Quantity::Error(b, i));
                }
            }
        }
    }

    fn joints(&mut self, model: &Model) {
        for (j, joint) in model.joints().iter().enumerate() {
            let has =
                |present: bool, quantities: &'static [_]| if present { quantities } else { &[] };
            let quantities = [
                &FORCE[..],
                has(model.is_loose(j), &CLEARANCE),
                has(
                    joint.terms.couple.is_some() && joint.terms.turned.is_some(),
                    &TURNED,
                ),
                has(joint.terms.couple.is_some(), &COUPLE),
                has(joint.terms.slide.is_some(), &LINE),
            ];
            for (name, unit, quantity) in quantities.into_iter().flatten() {
                let name = format!("{}.{name}", joint.name);
                self.add(name, unit, Quantity::Joint(j, *quantity));
            }
            let actuator = joint.actuator.iter().flat_map(|_| ACTUATOR);
            for (k, (name, unit)) in actuator.enumerate() {
                self.add(
                    format!("{}.{name}", joint.name),
                    unit,
                    Quantity::Actuator(j, k),
                );
            }
        }
    }

    fn points(&mut self, model: &Model) {
        for (b, body) in model.bodies().iter().enumerate() {
            for (p, point) in body.points.iter().enumerate() {
                let name =
                    |quantity: &str| format!("points.{}.{}.{quantity}", body.name, point.name);
                for (l, level) in LEVELS.iter().enumerate() {
                    for (i, (quantity, unit)) in level[..2].iter().enumerate() {
                        self.add(name(quantity), unit, Quantity::Point(b, p, l, i));
                    }
                }
                let slope = point.slope.iter().flat_map(|_| ["slope_x", "slope_y"]);
                for (i, quantity) in slope.enumerate() {
                    self.add(name(quantity), "1", Quantity::Slope(b, p, i));
                }
            }
        }
    }
}

/// Everything a scene can record, in a fixed order.
pub(super) fn available(model: &Model, analysis: Analysis) -> Vec<(Channel, Quantity)> {
    let mut list = List::default();
    list.add("t".to_owned(), "s", Quantity::Time);
    list.bodies(model);
    list.joints(model);
    list.points(model);
    for (f, (force, quantities)) in model.named_forces().enumerate() {
        for (k, (name, unit)) in quantities.iter().enumerate() {
            list.add(format!("{force}.{name}"), unit, Quantity::Force(f, k));
        }
    }
    for (name, energy) in ENERGIES {
        let present = match energy {
            // a load path has no balance of powers
            Energy::Integral(_) | Energy::Numerical => analysis == Analysis::Dynamic,
            Energy::Springs => model.has_springs(),
            _ => true,
        };
        if present {
            list.add(format!("energy.{name}"), "J", Quantity::Energy(energy));
        }
    }
    list.0
}

/// True where `name` has the form of `pattern`, in which `*` stands for any run of characters.
pub(super) fn matches(pattern: &str, name: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = name.strip_prefix(first) else {
        return false;
    };
    let parts: Vec<&str> = parts.collect();
    let Some((last, middle)) = parts.split_last() else {
        return rest.is_empty();
    };
    for part in middle {
        match rest.find(part) {
            Some(at) => rest = &rest[at + part.len()..],
            None => return false,
        }
    }
    rest.ends_with(last)
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn patterns() {
        for (pattern, name, expected) in [
            ("platform.*", "platform.x", true),
            ("platform.*", "error.x", false),
            ("*.force", "B1.force", true),
            ("*", "t", true),
            ("B1.f*e", "B1.force", true),
            ("B1.fx", "B1.fx", true),
            ("B1.f", "B1.fx", false),
            ("a*a", "a", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
