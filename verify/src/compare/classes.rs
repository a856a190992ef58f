//! Channels of the same kind: a difference is measured in units of the largest value of its kind.

use crate::check::{Agreement, LargestDifference, Standing, largest};
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

/// Two runs of one scene.
struct Pair<'a> {
    rust: &'a Trajectory,
    cpp: &'a Trajectory,
    /// Rows that both have.
    rows: usize,
}

impl<'a> Pair<'a> {
    fn new(scene: &str, rust: &'a Trajectory, cpp: &'a Trajectory) -> Pair<'a> {
        let names = |run: &'a Trajectory| run.columns.keys();
        assert!(names(rust).eq(names(cpp)), "channels of {scene}");
        let rows = rust.get("t").len().min(cpp.get("t").len());
        let [own, other] = [rust, cpp].map(|run| &run.get("t")[..rows]);
        assert_eq!(own, other, "rows of one instant");
        Pair { rust, cpp, rows }
    }

    /// The channels of a kind.
    fn members(&self, kind: usize) -> Vec<&'a str> {
        let names = self.rust.columns.keys().map(String::as_str);
        names.filter(|name| class(name) == Some(kind)).collect()
    }

    /// Both columns of a channel.
    fn columns(&self, name: &str) -> [&'a [f64]; 2] {
        [self.rust, self.cpp].map(|run| &run.get(name)[..self.rows])
    }

    /// Looks at a channel, in units of `scale`.
    fn see(&self, worst: &mut LargestDifference, kind: usize, name: &str, scale: f64) {
        let [rust, cpp] = self.columns(name);
        for (&r, &c) in rust.iter().zip(cpp) {
            let r = match CLASSES[kind].0 {
                ANGLES => c + (r - c + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU,
                _ => r,
            };
            worst.see(r, c, scale);
        }
    }
}

/// One row a kind, all its channels at all rows that both have, measured in units of the largest value, or of what `rounding` of the
/// state does to it over the tolerance. A kind that is below rounding on both sides counts as zero.
pub fn agreements(
    rounding: [f64; KINDS],
    scene: &str,
    rust: &Trajectory,
    cpp: &Trajectory,
    tolerance: f64,
    reason: &str,
) -> Vec<Agreement> {
    let pair = Pair::new(scene, rust, cpp);
    let mut rows = Vec::new();
    for (index, (kind, _)) in CLASSES.iter().enumerate() {
        let members = pair.members(index);
        let columns = members.iter().map(|name| pair.columns(name));
        let [rust, cpp] = columns.fold([0.0_f64; 2], |sizes, columns| {
            [0, 1].map(|side| sizes[side].max(largest(columns[side])))
        });
        // a kind that is zero on one side alone differs by all that the other side has
        let size = if cpp > 0.0 { cpp } else { rust };
        let scale = size.max(rounding[index] / tolerance).max(FLOOR);
        let mut worst = LargestDifference::default();
        for name in &members {
            pair.see(&mut worst, index, name, scale);
        }
        if worst.is_seen() {
            let quantity = format!("{kind}, channels: {}", members.len());
            let mut row = worst.row(&quantity, scene, tolerance, reason);
            if worst.size <= rounding[index] {
                row.standing = Standing::Zero;
            }
            rows.push(row);
        }
    }
    rows
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
    let pair = Pair::new(scene, &fine[0], &fine[1]);
    let own = [0, 1].map(|side| Pair::new(scene, &coarse[side], &fine[side]));
    let mut rows = Vec::new();
    for (index, (kind, _)) in CLASSES.iter().enumerate() {
        // the range of a channel, its value if it is constant; below `least` it rests, and is measured by the others
        let least = rounding[index] / LARGEST;
        let range = |name: &str| {
            let [_, column] = pair.columns(name);
            let [low, high] =
                [f64::min, f64::max].map(|f| column.iter().copied().fold(column[0], f));
            let range = high - low;
            if range > least {
                range
            } else {
                largest(column)
            }
        };
        let ranges = pair
            .members(index)
            .into_iter()
            .map(|name| (name, range(name)));
        let ranges: Vec<_> = ranges.collect();
        let widest = ranges
            .iter()
            .fold(least, |widest, (_, range)| range.max(widest));
        let channels = ranges.into_iter().map(|(name, range)| {
            let scale = match range > least {
                true => range,
                false => widest.max(f64::MIN_POSITIVE),
            };
            let see = |pair: &Pair| {
                let mut worst = LargestDifference::default();
                pair.see(&mut worst, index, name, scale);
                worst
            };
            let [rust, cpp] = own.each_ref().map(|own| see(own).difference);
            let allowed = SAFETY * (rust + cpp) + rounding[index] / scale + ROUNDING;
            (see(&pair), allowed)
        });
        let (sharp, blunt): (Vec<_>, Vec<_>) =
            channels.partition(|(_, allowed)| *allowed <= LARGEST);
        for (group, reason) in [(sharp, CONVERGED), (blunt, APART)] {
            let used = |(worst, allowed): &(LargestDifference, f64)| worst.difference / allowed;
            let nearest = group.iter().max_by(|a, b| used(a).total_cmp(&used(b)));
            let Some((worst, allowed)) = nearest else {
                continue;
            };
            let quantity = format!("{kind}, channels: {}", group.len());
            let mut row = worst.row(&quantity, scene, *allowed, reason);
            let size = group
                .iter()
                .fold(0.0, |size, (worst, _)| worst.size.max(size));
            if size <= least {
                row.standing = Standing::Zero;
            } else if *allowed > LARGEST {
                row.standing = Standing::Apart;
            }
            rows.push(row);
        }
    }
    rows
}
