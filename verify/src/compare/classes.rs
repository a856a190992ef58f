//! Channels of the same kind: a difference is measured in units of the largest value of its kind.

use crate::check::{Agreement, Worst, largest};
use crate::trajectory::Trajectory;
use std::f64::consts::TAU;

/// Kinds: name and the quantities of it.
pub const CLASSES: [(&str, &[&str]); 12] = [
    ("positions of bodies and points", &["x", "y"]),
    ("velocities of bodies and points", &["vx", "vy"]),
    ("accelerations of bodies and points", &["ax", "ay"]),
    ("slopes of links", &["slope_x", "slope_y"]),
    ("angular velocities", &["omega"]),
    ("angular accelerations", &["alpha"]),
    ("joint forces", &["fx", "fy", "force"]),
    ("crank angles", &["angle"]),
    ("crank speeds", &["speed"]),
    ("drive torques and couples", &["torque"]),
    ("kinetic energy and work", &["kinetic", "work"]),
    (
        "strain and contact energies, dissipations",
        &[
            "axial",
            "bending",
            "contact",
            "gravity",
            "springs",
            "contact_dissipated",
            "friction_dissipated",
            "damping_dissipated",
            "clamp",
        ],
    ),
];

/// The channels of a kind that both sides have.
fn members<'a>(
    rust: &'a Trajectory,
    cpp: &'a Trajectory,
    quantities: &'a [&str],
) -> impl Iterator<Item = (&'a String, &'a [f64], &'a [f64])> {
    let both = rust
        .columns
        .iter()
        .filter_map(|(name, r)| Some((name, &r[..], &cpp.columns.get(name)?[..])));
    both.filter(move |(name, ..)| {
        let owner = name.split('.').next().unwrap_or_default();
        let quantity = name.rsplit('.').next().unwrap_or_default();
        // deviations are small: the table has rows of their own for them
        owner != "error"
            && quantities.contains(&quantity)
            && !(quantity == "contact" && owner != "energy")
    })
}

/// One row a kind, all its channels at all rows that both have.
pub fn agreements(
    scene: &str,
    rust: &Trajectory,
    cpp: &Trajectory,
    tolerance: f64,
    reason: &str,
) -> Vec<Agreement> {
    let common = rust.t.len().min(cpp.t.len());
    assert_eq!(rust.t[..common], cpp.t[..common], "rows of one instant");
    let mut rows = Vec::new();
    for (class, quantities) in CLASSES {
        let members: Vec<_> = members(rust, cpp, quantities).collect();
        let size = members
            .iter()
            .fold(0.0_f64, |m, (_, _, c)| m.max(largest(&c[..common])));
        if size == 0.0 {
            continue;
        }
        let mut worst = Worst::default();
        for (_, r, c) in &members {
            let (r, c) = (&r[..common], &c[..common]);
            if class == "crank angles" {
                // known to a full turn
                for (r, c) in r.iter().zip(c) {
                    worst.see(
                        c + (r - c + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU,
                        *c,
                        size,
                    );
                }
            } else {
                worst.see_scaled(r, c, size);
            }
        }
        let quantity = format!("{class} ({} channels)", members.len());
        rows.push(worst.row(&quantity, scene, tolerance, reason));
    }
    rows
}

/// Names of Looselink's channels that the reference does not have.
pub fn missing(rust: &Trajectory, cpp: &Trajectory) -> Vec<String> {
    let names = rust.columns.keys();
    names
        .filter(|name| !cpp.columns.contains_key(*name))
        .cloned()
        .collect()
}
