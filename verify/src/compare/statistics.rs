//! Cases 3 and 4 beyond the chaos horizon: what does not depend on the instant of each impact.
//!
//! Two runs part after some tens of milliseconds, whoever computes them. What is compared are sizes, means and energies over
//! two cycles.

use crate::check::{Agreement, LargestDifference, largest};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use miette::Result;

/// Time from which the motion counts \[s\]: the bouncing of the start is over.
const FROM: f64 = 1.0;
/// Cycles that count.
const CYCLES: f64 = 2.0;
/// Time between rows \[s\].
const INTERVAL: f64 = 2e-5;
/// Step of Looselink \[s\], that of the scenes.
const STEP: f64 = 1.25e-6;
/// Relative tolerance of IDA; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
const RELATIVE: f64 = 1e-7;

/// What is measured: name, unit, largest difference, and whether it is relative.
const QUANTITIES: [(&str, &str, f64, bool); 6] = [
    ("largest |eₓ| of the platform", "m", 0.01, true),
    ("largest |e_y| of the platform", "m", 0.01, true),
    ("rms of the platform's error", "m", 0.01, true),
    ("mean force in B1", "N", 0.01, true),
    (
        "share of time in contact, mean of B and C",
        "1",
        0.03,
        false,
    ),
    ("energy dissipated in contact per cycle", "J", 0.2, true),
];

fn plan(case: u32) -> ComparisonPlan {
    let scene = if case == 3 {
        "3rrr/case3"
    } else {
        "3rrr/case4"
    };
    ComparisonPlan::new(scene, FROM + CYCLES, INTERVAL)
}

/// The quantities of a run, in the order of [`QUANTITIES`].
fn measures(run: &Trajectory) -> [f64; 6] {
    let first = run.get("t").partition_point(|&t| t < FROM - 0.5 * INTERVAL);
    let part = |name: &str| &run.get(name)[first..];
    let (x, y) = (part("error.x"), part("error.y"));
    let count = x.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let square = x.iter().zip(y).map(|(x, y)| x * x + y * y).sum::<f64>();
    let joints = ["B1", "B2", "B3", "C1", "C2", "C3"];
    let contact = joints.iter().map(|j| mean(part(&format!("{j}.contact"))));
    let dissipated = part("energy.contact_dissipated");
    let energy = dissipated[dissipated.len() - 1] - dissipated[0];
    [
        largest(x),
        largest(y),
        (square / count).sqrt(),
        mean(part("B1.force")),
        contact.sum::<f64>() / joints.len() as f64,
        energy / CYCLES,
    ]
}

/// The rows of a case.
pub fn agreements(case: u32) -> Result<Vec<Agreement>> {
    let tolerances = tolerances(RELATIVE);
    let (rust, cpp) = rayon::join(|| plan(case).rust(STEP), || plan(case).cpp(&tolerances));
    let both = measures(&rust?).into_iter().zip(measures(&cpp?));
    let row = |((name, unit, tolerance, relative), (rust, cpp)): (_, (f64, f64))| {
        let (measure, scale) = match relative {
            true => ("relative", cpp.abs()),
            false => ("absolute", 1.0),
        };
        LargestDifference::of(rust, cpp, scale).row(
            &format!("{name} [{unit}]"),
            &format!("case{case}, cycles 2 and 3"),
            tolerance,
            &format!("{measure}; scatter between chaotic runs"),
        )
    };
    Ok(QUANTITIES.into_iter().zip(both).map(row).collect())
}
