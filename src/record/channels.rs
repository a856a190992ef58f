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

/// Everything a scene can record, in a fixed order.
pub(super) fn available(model: &Model, analysis: Analysis) -> Vec<(Channel, Quantity)> {
    let mut list = vec![(
        Channel {
            name: "t".to_owned(),
            unit: "s",
        },
        Quantity::Time,
    )];
    let mut add = |name: String, unit, quantity| list.push((Channel { name, unit }, quantity));
    let levels = [
        [("x", "m"), ("y", "m"), ("theta", "rad")],
        [("vx", "m/s"), ("vy", "m/s"), ("omega", "rad/s")],
        [("ax", "m/s2"), ("ay", "m/s2"), ("alpha", "rad/s2")],
    ];
    for (b, body) in model.bodies().iter().enumerate() {
        if matches!(
            body.coordinates,
            crate::model::BodyCoordinates::Ground { .. }
        ) {
            continue;
        }
        for (l, level) in levels.iter().enumerate() {
            for (i, (name, unit)) in level.iter().enumerate() {
                add(
                    format!("{}.{name}", body.name),
                    unit,
                    Quantity::Pose(b, l, i),
                );
            }
        }
        if matches!(
            body.coordinates,
            crate::model::BodyCoordinates::FlexibleLink { .. }
        ) {
            add(format!("{}.strain", body.name), "1", Quantity::Strain(b));
        }
        if body.prescribed.is_some() {
            for (i, (name, unit)) in levels[0].iter().enumerate() {
                add(format!("error.{name}"), unit, Quantity::Error(b, i));
            }
        }
    }
    for (j, joint) in model.joints().iter().enumerate() {
        use JointQuantity::{
            Angle, Contact, Couple, Eccentricity, EccentricityRate, Ex, ExRate, Ey, EyRate, Force,
            Fx, Fy, Penetration, Speed, Travel, TravelRate,
        };
        let mut joint_channel = |name: &str, unit, q| {
            add(
                format!("{}.{name}", joint.name),
                unit,
                Quantity::Joint(j, q),
            )
        };
        for (name, q) in [("fx", Fx), ("fy", Fy), ("force", Force)] {
            joint_channel(name, "N", q);
        }
        if model.is_loose(j) {
            for (name, q) in [
                ("ex", Ex),
                ("ey", Ey),
                ("eccentricity", Eccentricity),
                ("penetration", Penetration),
            ] {
                joint_channel(name, "m", q);
            }
            for (name, q) in [
                ("ex_rate", ExRate),
                ("ey_rate", EyRate),
                ("eccentricity_rate", EccentricityRate),
            ] {
                joint_channel(name, "m/s", q);
            }
            joint_channel("contact", "1", Contact);
        }
        if joint.couple.is_some() {
            let turned = joint
                .turned
                .map(|_| [("angle", "rad", Angle), ("speed", "rad/s", Speed)]);
            for (name, unit, q) in turned.into_iter().flatten() {
                joint_channel(name, unit, q);
            }
            joint_channel("torque", "N m", Couple);
        }
        if joint.slide.is_some() {
            joint_channel("travel", "m", Travel);
            joint_channel("travel_rate", "m/s", TravelRate);
        }
        if joint.actuator.is_some() {
            for (k, (name, unit)) in [("angle", "rad"), ("speed", "rad/s"), ("torque", "N m")]
                .into_iter()
                .enumerate()
            {
                add(
                    format!("{}.{name}", joint.name),
                    unit,
                    Quantity::Actuator(j, k),
                );
            }
        }
    }
    for (b, body) in model.bodies().iter().enumerate() {
        for (p, point) in body.points.iter().enumerate() {
            let name = |quantity| format!("points.{}.{}.{quantity}", body.name, point.name);
            for (l, level) in levels.iter().enumerate() {
                for (i, (quantity, unit)) in level[..2].iter().enumerate() {
                    add(name(quantity), unit, Quantity::Point(b, p, l, i));
                }
            }
            if point.slope.is_some() {
                for (i, quantity) in ["slope_x", "slope_y"].iter().enumerate() {
                    add(name(quantity), "1", Quantity::Slope(b, p, i));
                }
            }
        }
    }
    for (f, (force, quantities)) in model.named_forces().enumerate() {
        for (k, (name, unit)) in quantities.iter().enumerate() {
            add(format!("{force}.{name}"), unit, Quantity::Force(f, k));
        }
    }
    for (name, energy) in [
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
    ] {
        let present = match energy {
            // a load path has no balance of powers
            Energy::Integral(_) | Energy::Numerical => analysis == Analysis::Dynamic,
            Energy::Springs => model.has_springs(),
            _ => true,
        };
        if present {
            add(format!("energy.{name}"), "J", Quantity::Energy(energy));
        }
    }
    list
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
