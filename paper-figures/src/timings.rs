//! Times the routes to the elastic force and a step, for the statements that are about time.

use crate::methods::evaluations;
use crate::record::KernelTimings;
use crate::runs::{RunPace, RunPlan};
use looselink::link::{AncfCable, ElasticRoute, GaussCable, LiteralCable};
use miette::Result;
use std::hint::black_box;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Length \[m\], axial stiffness \[N\] and bending stiffness \[N m2\] of the passive link of Tables 1 and 2.
const LINK: (f64, f64, f64) = (0.242, 1.05e6, 2.1875);
/// Repetitions; the least of them is that which nothing has disturbed.
const TIMES: usize = 15;
/// Calls a repetition.
const CALLS: usize = 20_000;

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
        day: today(),
        literal: call(&LiteralCable::new(l, ea, ei)),
        gauss: call(&GaussCable::new(l, ea, ei)),
        reduced: call(&AncfCable::new(l, ea, ei)),
        step,
        evaluations: evaluations_a_step,
    })
}

/// The time of one evaluation of force and tangent \[s\].
fn call(route: &impl ElasticRoute) -> f64 {
    let (s, c) = 0.7_f64.sin_cos();
    let (l, stretch) = (LINK.0, 1.0001);
    let q = [
        0.1,
        -0.2,
        c + 1e-4,
        s,
        0.1 + l * c * stretch,
        -0.2 + l * s,
        c,
        s - 1e-3,
    ];
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

/// Today in the Gregorian calendar, UTC, after Hinnant's `civil_from_days`.
fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH);
    let days = seconds.map_or(0, |s| s.as_secs() / 86_400) + 719_468;
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    format!("{}-{month:02}-{day:02}", year + era * 400 + next)
}
