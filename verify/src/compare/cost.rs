//! Processor time of both sides at the same achieved error.
//!
//! Each side is measured against the finest run of the other, so that neither is its own truth.

use crate::check::largest;
use crate::trajectory::{Plan, Trajectory, tolerances};
use miette::Result;

/// Runs are repeated and the shortest time is kept: what disturbs a run only lengthens it.
const REPEATS: usize = 3;
/// Steps of Looselink \[s\], coarse to fine.
const STEPS: [f64; 7] = [4e-6, 2e-6, 1e-6, 5e-7, 2.5e-7, 1.25e-7, 6.25e-8];
/// Relative tolerances of IDA, coarse to fine.
const RELATIVE: [f64; 8] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 3e-12, 1e-12];
/// Errors at which times are compared \[m\].
pub const ERRORS: [f64; 4] = [1e-8, 1e-9, 1e-10, 1e-11];

/// A run: its error \[m\], its time \[s\].
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub error: f64,
    pub seconds: f64,
}

/// Both sides on one scene, coarse to fine.
#[derive(Debug)]
pub struct Curves {
    pub plan: Plan,
    pub rust: Vec<Point>,
    pub cpp: Vec<Point>,
}

/// The scenes: smooth motion with flexible links, then impacts up to the chaos horizon.
pub fn plans() -> [Plan; 3] {
    [
        Plan::new("3rrr/case2", 0.1, 1e-3),
        Plan::new("3rrr/case3", 0.006, 1e-4),
        Plan::new("3rrr/case4", 0.0044, 1e-4),
    ]
}

fn error(run: &Trajectory, truth: &Trajectory) -> f64 {
    let channel = |name: &str| -> Vec<f64> {
        let pairs = run.get(name).iter().zip(truth.get(name));
        pairs.map(|(a, b)| a - b).collect()
    };
    largest(&channel("error.x")).max(largest(&channel("error.y")))
}

/// Repeats a run; the trajectory and the shortest time.
fn repeated(run: impl Fn() -> Result<Trajectory>) -> Result<(Trajectory, f64)> {
    let first = run()?;
    let mut seconds = first.seconds;
    for _ in 1..REPEATS {
        seconds = seconds.min(run()?.seconds);
    }
    Ok((first, seconds))
}

/// Runs both sides, one run at a time.
///
/// # Errors
/// A run that fails.
pub fn curves(plan: Plan) -> Result<Curves> {
    let rust = STEPS.iter().map(|&h| repeated(|| plan.rust(h)));
    let rust = rust.collect::<Result<Vec<_>>>()?;
    let cpp = RELATIVE
        .iter()
        .map(|&r| repeated(|| plan.cpp(&tolerances(r, 1e-3 * r, 0.1 * r))));
    let cpp = cpp.collect::<Result<Vec<_>>>()?;
    let against = |runs: &[(Trajectory, f64)], truth: &Trajectory| {
        let point = |(run, seconds): &(Trajectory, f64)| Point {
            error: error(run, truth),
            seconds: *seconds,
        };
        runs.iter().map(point).collect()
    };
    Ok(Curves {
        rust: against(&rust, &cpp[cpp.len() - 1].0),
        cpp: against(&cpp, &rust[rust.len() - 1].0),
        plan,
    })
}

/// Time at an error, on the straight line between neighbours in the log-log plane; none outside the curve.
pub fn time_at(curve: &[Point], error: f64) -> Option<f64> {
    let pair = curve
        .windows(2)
        .find(|p| p[0].error >= error && p[1].error <= error)?;
    let share = (pair[0].error / error).ln() / (pair[0].error / pair[1].error).ln();
    Some(pair[0].seconds * (pair[1].seconds / pair[0].seconds).powf(share))
}
