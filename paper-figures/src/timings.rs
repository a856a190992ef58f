//! Times the routes to the elastic force and a step, for the statements that are about time.

use crate::methods::evaluations;
use crate::runs::{RunPace, RunPlan};
use looselink::link::{AncfCable, ElasticRoute, GaussCable, LiteralCable};
use miette::Result;
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use std::time::Instant;

/// Length \[m\], axial stiffness \[N\] and bending stiffness \[N m2\] of the passive link of Tables 1 and 2.
pub const LINK: (f64, f64, f64) = (0.242, 1.05e6, 2.1875);
/// Repetitions; the least of them is that which nothing has disturbed.
const TIMES: usize = 15;
/// Calls a repetition.
const CALLS: usize = 20_000;

/// Times of kernels and of a step.
#[derive(Debug, Serialize, Deserialize)]
pub struct KernelTimings {
    /// Elastic force and tangent of an element by the transcription of eqs. 14 and 15 \[s\].
    pub literal: f64,
    /// The same by five-point Gauss quadrature \[s\].
    pub gauss: f64,
    /// The same by the reduced tensor that simulations use \[s\].
    pub reduced: f64,
    /// One step of Bathe's method in case 2, reduced tensor \[s\].
    pub step: f64,
    /// Evaluations of force and tangent in that step.
    pub evaluations: f64,
}

/// Times everything, on one thread.
///
/// # Errors
/// When the run fails.
pub fn run() -> Result<KernelTimings> {
    let (l, ea, ei) = LINK;
    let plan = RunPlan::new(2, RunPace::bathe(1e-5), 1e-3, 0.05);
    let mut step = f64::INFINITY;
    let mut evaluations_a_step = 0.0;
    for _ in 0..TIMES {
        let start = Instant::now();
        let done = plan.run()?;
        let steps = done.report.steps as f64;
        step = step.min(start.elapsed().as_secs_f64() / steps);
        evaluations_a_step = evaluations(&done) as f64 / steps;
    }
    Ok(KernelTimings {
        literal: call(&LiteralCable::new(l, ea, ei)),
        gauss: call(&GaussCable::new(l, ea, ei)),
        reduced: call(&AncfCable::new(l, ea, ei)),
        step,
        evaluations: evaluations_a_step,
    })
}

/// The time of one evaluation of force and tangent \[s\].
fn call(route: &impl ElasticRoute) -> f64 {
    let [_, q, _] = states();
    let once = || {
        let start = Instant::now();
        for _ in 0..CALLS {
            let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
            route.force_and_tangent(black_box(&q), &mut f, &mut k);
            black_box((f, k));
        }
        start.elapsed().as_secs_f64() / CALLS as f64
    };
    (0..TIMES).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// States of the passive link: straight, stretched, bent.
fn states() -> [[f64; 8]; 3] {
    let l = LINK.0;
    let (x, y) = (0.1 + 0.81 * l, -0.2 + 0.6 * l);
    [
        [0.0, 0.0, 1.0, 0.0, l, 0.0, 1.0, 0.0],
        [0.1, -0.2, 0.8, 0.6, x, y, 0.8, 0.61],
        [0.0, 0.0, 0.9, 0.4, 0.95 * l, 0.05 * l, 0.9, -0.3],
    ]
}

/// Largest difference between force and tangent by eqs. 14 and 15 and by five-point Gauss quadrature, of the passive link: straight,
/// stretched and bent. Relative to the axial stiffness and to the largest entry of the tangent.
pub fn invariants_apart() -> f64 {
    let (l, ea, ei) = LINK;
    let (literal, gauss) = (LiteralCable::new(l, ea, ei), GaussCable::new(l, ea, ei));
    let mut worst: f64 = 0.0;
    for q in states() {
        let ([mut f, mut g], [mut k, mut m]) = ([[0.0; 8]; 2], [[[0.0; 8]; 8]; 2]);
        literal.force_and_tangent(&q, &mut f, &mut k);
        gauss.force_and_tangent(&q, &mut g, &mut m);
        let largest = m.iter().flatten().fold(0.0_f64, |a, x| a.max(x.abs()));
        let tangents = k.iter().flatten().zip(m.iter().flatten());
        let tangents = tangents.map(|(a, b)| (a - b).abs() / largest);
        // a force is of the size of the axial stiffness times the part of it that does not cancel
        let forces = f.iter().zip(g).map(|(a, b)| (a - b).abs() / ea);
        worst = tangents.chain(forces).fold(worst, f64::max);
    }
    worst
}
