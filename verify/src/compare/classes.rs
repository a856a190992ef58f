//! Channels of the same kind: a difference is measured in units of the largest value of its kind.

use crate::check::{Agreement, LargestDifference, Standing, largest};
use crate::trajectory::Trajectory;
use std::f64::consts::TAU;

/// Number of kinds.
pub const KINDS: usize = 17;
/// Where differences are large against rounding.
pub const NO_ROUNDING: [f64; KINDS] = [0.0; KINDS];
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
    ("deflections of bristles", &["bristle"]),
    ("rates of lengths of springs", &["rate"]),
    ("kinetic energy and work", &["kinetic", "work"]),
    ("stored energies and dissipations",
     &["axial", "bending", "contact", "gravity", "springs", "contact_dissipated", "friction_dissipated",
       "damping_dissipated", "clamp", "normal_variation"]),
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

/// Part of its range by which a channel that counts may differ at most: a hundred times less than what a picture shows.
const LARGEST: f64 = 1e-4;
/// The difference of two runs of a program is only an estimate of an error.
const SAFETY: f64 = 5.0;
/// What is allowed beside the errors of the runs, over the range of a channel: rounding in thousands of steps.
const ROUNDING: f64 = 1e-9;
const CONVERGED: &str = "of the range of the channel that comes nearest; five times what the two programs differ by from their own runs \
                         with ten times the tolerance";
const APART: &str =
    "likewise; with more than 1e-4 of the range the runs are not accurate enough to count";

/// The channels of a kind.
fn members(run: &Trajectory, kind: usize) -> Vec<&str> {
    let names = run.columns.keys().map(String::as_str);
    names.filter(|name| class(name) == Some(kind)).collect()
}

/// Channels of a kind at all rows that two runs have, in units of `scale`.
fn compare(
    runs: [&Trajectory; 2],
    kind: usize,
    channels: &[&str],
    scale: f64,
) -> LargestDifference {
    let mut worst = LargestDifference::default();
    for name in channels {
        let [rust, cpp] = runs.map(|run| run.get(name));
        for (&r, &c) in rust.iter().zip(cpp) {
            let r = match CLASSES[kind].0 {
                ANGLES => c + (r - c + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU,
                _ => r,
            };
            worst.see(r, c, scale);
        }
    }
    worst
}

fn assert_alike(scene: &str, [rust, cpp]: [&Trajectory; 2]) {
    let names = rust.columns.keys().eq(cpp.columns.keys());
    assert!(names, "channels of {scene}");
    let mut instants = rust.get("t").iter().zip(cpp.get("t"));
    assert!(instants.all(|(r, c)| r == c), "rows of one instant");
}

/// One row a kind, all its channels at all rows that both have, measured in units of the largest value, or of what `rounding` of the
/// state does to it over the tolerance. A kind that is below rounding on both sides counts as zero.
pub fn agreements(
    rounding: [f64; KINDS],
    scene: &str,
    runs: [&Trajectory; 2],
    tolerance: f64,
    reason: &str,
) -> Vec<Agreement> {
    assert_alike(scene, runs);
    let mut rows = Vec::new();
    for (kind, (title, _)) in CLASSES.iter().enumerate() {
        let members = members(runs[0], kind);
        let mut worst = compare(runs, kind, &members, 1.0);
        worst.difference /= worst.size.max(rounding[kind] / tolerance).max(FLOOR);
        if worst.is_seen {
            let quantity = format!("{title}, channels: {}", members.len());
            let mut row = worst.row(&quantity, scene, tolerance, reason);
            if worst.size <= rounding[kind] {
                row.standing = Standing::Zero;
            }
            rows.push(row);
        }
    }
    rows
}

/// The range of a channel, its largest value if it is constant.
fn range(column: &[f64], least: f64) -> f64 {
    let [low, high] = [f64::min, f64::max].map(|f| column.iter().copied().fold(column[0], f));
    match high - low > least {
        true => high - low,
        false => largest(column),
    }
}

/// The channels of each kind, measured in units of their own ranges, in a fine run of each program. Each may differ by `SAFETY` times
/// what the coarse run of either program differs from its fine run, which is about ten times the error of the fine one. Channels for
/// which this is more than `LARGEST` have a row of their own, which does not count.
pub fn converged(
    rounding: [f64; KINDS],
    scene: &str,
    coarse: &[Trajectory; 2],
    fine: &[Trajectory; 2],
) -> Vec<Agreement> {
    assert_alike(scene, fine.each_ref());
    let mut rows = Vec::new();
    for (kind, (title, _)) in CLASSES.iter().enumerate() {
        // below `least` a channel rests, and is measured by the others
        let least = rounding[kind] / LARGEST;
        let members = members(&fine[1], kind);
        let ranges = members.iter().map(|name| range(fine[1].get(name), least));
        let ranges: Vec<f64> = ranges.collect();
        let widest = ranges.iter().copied().fold(least, f64::max);
        let channels = members.iter().zip(&ranges).map(|(name, &range)| {
            let scale = match range > least {
                true => range,
                false => widest.max(f64::MIN_POSITIVE),
            };
            let see = |runs| compare(runs, kind, &[*name], scale);
            let own = [0, 1].map(|side| see([&coarse[side], &fine[side]]).difference);
            let allowed = SAFETY * (own[0] + own[1]) + rounding[kind] / scale + ROUNDING;
            (see(fine.each_ref()), allowed)
        });
        let (sharp, blunt): (Vec<_>, Vec<_>) =
            channels.partition(|(_, allowed)| *allowed <= LARGEST);
        for (group, reason) in [(sharp, CONVERGED), (blunt, APART)] {
            let used = |(worst, allowed): &(LargestDifference, f64)| worst.difference / allowed;
            let nearest = group.iter().max_by(|a, b| used(a).total_cmp(&used(b)));
            let Some((worst, allowed)) = nearest else {
                continue;
            };
            let quantity = format!("{title}, channels: {}", group.len());
            let mut row = worst.row(&quantity, scene, *allowed, reason);
            if group.iter().all(|(worst, _)| worst.size <= least) {
                row.standing = Standing::Zero;
            } else if *allowed > LARGEST {
                row.standing = Standing::Apart;
            }
            rows.push(row);
        }
    }
    rows
}
