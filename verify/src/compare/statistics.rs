//! Cases 3 and 4 beyond the chaos horizon: what does not depend on the instant of each impact.
//!
//! Two runs part after some tens of milliseconds, whoever computes them. What is compared are sizes, means and energies over
//! two cycles, beside the spread of each side over its own steps or tolerances.

use crate::check::{Agreement, largest};
use crate::trajectory::{Plan, Trajectory, tolerances};
use miette::Result;
use rayon::prelude::*;

/// Time from which the motion counts \[s\]: the bouncing of the start is over.
pub const FROM: f64 = 1.0;
/// Cycles that count.
pub const CYCLES: f64 = 2.0;
/// Time between rows \[s\].
const INTERVAL: f64 = 2e-5;
/// Steps of Looselink \[s\]; the one in the middle is the scenes' own.
pub const STEPS: [f64; 3] = [2.5e-6, 1.25e-6, 6.25e-7];
/// Relative tolerances of IDA; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
pub const RELATIVE: [f64; 3] = [1e-6, 1e-7, 1e-8];

/// The measures of one run.
#[derive(Debug, Clone, Copy)]
pub struct Measures {
    /// In the order of [`QUANTITIES`].
    pub values: [f64; 6],
    /// Processor time of the run \[s\].
    pub seconds: f64,
}

/// What is measured: name, unit, largest difference, and whether it is relative.
pub const QUANTITIES: [(&str, &str, f64, bool); 6] = [
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

/// All runs of a case: by step on the one side, by tolerance on the other.
#[derive(Debug)]
pub struct Spread {
    /// Case 3 or 4.
    pub case: u32,
    /// Looselink, one for each of [`STEPS`].
    pub rust: Vec<Measures>,
    /// The reference, one for each of [`RELATIVE`].
    pub cpp: Vec<Measures>,
}

fn plan(case: u32) -> Plan {
    let scene = if case == 3 {
        "3rrr/case3"
    } else {
        "3rrr/case4"
    };
    Plan::new(scene, FROM + CYCLES, INTERVAL)
}

impl Measures {
    fn of(run: &Trajectory) -> Measures {
        let first = run.t.partition_point(|&t| t < FROM - 0.5 * INTERVAL);
        let part = |name: &str| &run.get(name)[first..];
        let (x, y) = (part("error.x"), part("error.y"));
        let count = x.len() as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
        let square = x.iter().zip(y).map(|(x, y)| x * x + y * y).sum::<f64>();
        let joints = ["B1", "B2", "B3", "C1", "C2", "C3"];
        let contact = joints.iter().map(|j| mean(part(&format!("{j}.contact"))));
        let dissipated = part("energy.contact_dissipated");
        let energy = dissipated[dissipated.len() - 1] - dissipated[0];
        let values = [
            largest(x),
            largest(y),
            (square / count).sqrt(),
            mean(part("B1.force")),
            contact.sum::<f64>() / joints.len() as f64,
            energy / CYCLES,
        ];
        Measures {
            values,
            seconds: run.seconds,
        }
    }
}

fn rust(case: u32, step: f64) -> Result<Measures> {
    Ok(Measures::of(&plan(case).rust(step)?))
}

fn cpp(case: u32, relative: f64) -> Result<Measures> {
    let tolerances = tolerances(relative, 1e-3 * relative, 0.1 * relative);
    Ok(Measures::of(&plan(case).cpp(&tolerances)?))
}

/// The rows of a case: Looselink with the scene's step, the reference with the middle tolerance.
///
/// # Errors
/// A run that fails.
pub fn agreements(case: u32) -> Result<Vec<Agreement>> {
    let (rust, cpp) = rayon::join(|| rust(case, STEPS[1]), || cpp(case, RELATIVE[1]));
    Ok(rows(case, rust?, cpp?))
}

/// All runs of a case.
///
/// # Errors
/// A run that fails.
pub fn spread(case: u32) -> Result<Spread> {
    let (cpp, rust) = rayon::join(
        || {
            RELATIVE
                .par_iter()
                .with_max_len(1)
                .map(|&r| cpp(case, r))
                .collect::<Result<_>>()
        },
        || {
            STEPS
                .par_iter()
                .with_max_len(1)
                .map(|&h| rust(case, h))
                .collect::<Result<_>>()
        },
    );
    Ok(Spread {
        case,
        rust: rust?,
        cpp: cpp?,
    })
}

impl Spread {
    /// The rows, from the runs in the middle.
    pub fn agreements(&self) -> Vec<Agreement> {
        rows(self.case, self.rust[1], self.cpp[1])
    }
}

fn rows(case: u32, rust: Measures, cpp: Measures) -> Vec<Agreement> {
    let row =
        |((name, unit, tolerance, relative), (r, c)): ((&str, &str, f64, bool), (&f64, &f64))| {
            let measure = if relative { "relative" } else { "absolute" };
            Agreement {
                quantity: format!("{name} [{unit}]"),
                scene: format!("case{case}, cycles 2 and 3"),
                rust: *r,
                cpp: *c,
                difference: (r - c).abs() / if relative { c.abs() } else { 1.0 },
                tolerance,
                reason: format!("{measure}; scatter between chaotic runs"),
            }
        };
    QUANTITIES
        .into_iter()
        .zip(rust.values.iter().zip(&cpp.values))
        .map(row)
        .collect()
}
