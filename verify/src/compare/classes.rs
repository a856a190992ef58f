//! Channels of the same kind: a difference is measured in units of the largest value of its kind.

use crate::check::{Agreement, LargestDifference, largest};
use crate::trajectory::Trajectory;
use std::f64::consts::TAU;

/// Number of kinds.
pub const KINDS: usize = 16;
/// Kinds: name and the quantities of it. Every channel is of one kind, but for those that [`class`] names.
#[rustfmt::skip]
pub const CLASSES: [(&str, &[&str]); KINDS] = [
    ("positions of bodies and points", &["x", "y", "travel"]),
    ("velocities of bodies and points", &["vx", "vy", "travel_rate"]),
    ("accelerations of bodies and points", &["ax", "ay"]),
    ("slopes of links", &["slope_x", "slope_y"]),
    (ANGLES, &["theta", "angle"]),
    ("angular velocities", &["omega", "speed"]),
    ("angular accelerations", &["alpha", "acceleration"]),
    ("strains of links", &["strain"]),
    ("eccentricities of joints", &["ex", "ey", "eccentricity", "penetration"]),
    ("rates of eccentricities", &["ex_rate", "ey_rate", "eccentricity_rate"]),
    ("forces", &["fx", "fy", "force"]),
    ("torques and couples", &["torque"]),
    ("lengths of springs", &["length", "elongation"]),
    ("rates of lengths of springs", &["rate"]),
    ("kinetic energy and work", &["kinetic", "work"]),
    ("stored energies and dissipations",
     &["axial", "bending", "contact", "gravity", "springs", "contact_dissipated", "friction_dissipated",
       "damping_dissipated", "clamp"]),
];
/// Smallest size of a kind, in SI units: with a tolerance of 1e-9 differences of 1e-14 are rounding of numbers of size 1.
const FLOOR: f64 = 1e-5;
/// Known to a full turn.
const ANGLES: &str = "angles";

/// The kind of a channel. None for t; for deviations of a platform, which are small and have rows of their own; for the state
/// of a contact, whose changes are compared; and for what the integrator loses, since the two integrators differ.
pub fn class(channel: &str) -> Option<usize> {
    let (owner, quantity) = channel.rsplit_once('.')?;
    if owner == "error"
        || channel == "energy.numerical"
        || (quantity == "contact" && owner != "energy")
    {
        return None;
    }
    let of = |(_, quantities): &(&str, &[&str])| quantities.contains(&quantity);
    let found = CLASSES.iter().position(of);
    Some(found.unwrap_or_else(|| panic!("channel {channel} is of no kind")))
}

/// One row a kind, all its channels at all rows that both have, measured in units of the largest value or of `floors`.
pub fn agreements(
    floors: [f64; KINDS],
    scene: &str,
    rust: &Trajectory,
    cpp: &Trajectory,
    tolerance: f64,
    reason: &str,
) -> Vec<Agreement> {
    let names = |run: &Trajectory| run.columns.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(rust), names(cpp), "channels of {scene}");
    let common = rust.get("t").len().min(cpp.get("t").len());
    assert_eq!(
        rust.get("t")[..common],
        cpp.get("t")[..common],
        "rows of one instant"
    );
    let mut rows = Vec::new();
    for (index, (kind, _)) in CLASSES.iter().enumerate() {
        let names = rust.columns.keys();
        let members: Vec<_> = names.filter(|name| class(name) == Some(index)).collect();
        let column = |run: &'_ Trajectory, name| run.get(name)[..common].to_vec();
        let size = |run| {
            let sizes = members.iter().map(|name| largest(&column(run, name)));
            sizes.fold(floors[index], f64::max)
        };
        // a kind that is zero on one side alone differs by all that the other side has
        let Some(size) = [size(cpp), size(rust)].into_iter().find(|s| *s != 0.0) else {
            continue;
        };
        let size = size.max(FLOOR);
        let mut worst = LargestDifference::default();
        for name in &members {
            let (mut r, c) = (column(rust, name), column(cpp, name));
            if *kind == ANGLES {
                for (r, c) in r.iter_mut().zip(&c) {
                    *r = c + (*r - c + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                }
            }
            worst.see_scaled(&r, &c, size);
        }
        let quantity = format!("{kind}, channels: {}", members.len());
        rows.push(worst.row(&quantity, scene, tolerance, reason));
    }
    rows
}
