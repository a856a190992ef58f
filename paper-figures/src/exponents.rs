//! Largest Lyapunov exponents after Benettin et al. (1980), DOI 10.1007/BF02128236.
//!
//! A neighbouring motion runs beside the motion. After every interval tau its distance d has grown from d0 by d/d0; it is
//! brought back to the distance d0 in the direction that it has, and
//!
//! ```text
//! lambda = sum ln(d_k / d0) / (sum of the tau)
//! ```
//!
//! d is the Euclidean norm of the differences of all unknown coordinates and, times a millisecond, of their rates; the
//! limit does not depend on the norm. Both motions take equal steps: steps that follow an error would differ between the
//! two.

use crate::kinematics::MechanismGeometry;
use crate::runs::{RunPace, RunPlan};
use crate::variants::{MOVED, STARTS, moved};
use crate::warned::merged;
use looselink::simulate::Simulation;
use looselink::system::State;
use miette::{IntoDiagnostic, Result};
use numbers::rounded;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use statistics::Interval;

/// Time between two returns to d0 \[s\].
const RETURN: f64 = 1e-3;
/// Simulated time \[s\].
pub const DURATION: f64 = 2.0;
/// Part of it in which the direction settles, which is not counted \[s\].
pub const LEFT_OUT: f64 = 0.5;
/// Time that turns a rate into a length \[s\].
const RATES: f64 = 1e-3;
/// Steps at which the energy ledger closes to 5 % of the contact dissipation, and distances d0.
///
/// With loose joints a distance has to be far below a penetration, some 1e-8 m. In case 2 nothing magnifies it, so that
/// what rounding and Newton's tolerance add to it shows: measured 4/s at a distance of 1e-12 and 0.3/s at 1e-10.
const MOTIONS: [(u32, RunPace, [f64; 2]); 3] = [
    (4, RunPace::Steps("trapezoidal", 2.5e-6), [1e-10, 1e-12]),
    (3, RunPace::Steps("trapezoidal", 5e-6), [1e-10, 1e-12]),
    (2, RunPace::Steps("trapezoidal", 2e-5), [1e-8, 1e-10]),
];

/// Largest Lyapunov exponents of one case, one for each start.
#[derive(Debug, Serialize, Deserialize)]
pub struct Exponents {
    /// Case of Table 2.
    pub case: u32,
    /// Distance to which the neighbouring motion is brought back.
    pub distance: f64,
    /// Method and step.
    pub how: String,
    /// The exponents \[1/s\].
    pub values: Vec<f64>,
    /// What the runs warn of.
    pub warnings: Vec<String>,
}

impl Exponents {
    /// Mean and interval \[1/s\].
    pub fn mean(&self) -> Interval {
        Interval::of(&self.values)
    }
}

/// Exponents of cases 2, 3 and 4 at two distances.
///
/// # Errors
/// The first run that fails.
pub fn run(g: &MechanismGeometry, journal: &Journal) -> Result<Vec<Exponents>> {
    let mut all = Vec::new();
    for (case, pace, distances) in MOTIONS {
        for distance in distances {
            let starts: Vec<usize> = (0..STARTS).collect();
            let name = |k: &usize| format!("exponent {case} {distance:e} {k}");
            let run = |k: &usize| {
                let mut plan = RunPlan::new(case, pace, RETURN, DURATION);
                // the starts of an ensemble; case 2 has no loose joint that would let the platform start elsewhere
                if case > 2 {
                    plan.overrides.push(moved(g, MOVED, *k));
                }
                exponent(&plan, distance, *k)
            };
            let done = journal.items(&starts, threads(), name, run)?;
            let (values, warnings): (Vec<f64>, Vec<Vec<String>>) = done.into_iter().unzip();
            all.push(Exponents {
                case,
                distance,
                how: pace.label(),
                values,
                warnings: merged(&warnings),
            });
        }
    }
    Ok(all)
}

/// The exponent of one pair of motions, and warnings.
fn exponent(plan: &RunPlan, distance: f64, k: usize) -> Result<(f64, Vec<String>)> {
    let scene = plan.scene()?;
    let mut motion = Simulation::new(&scene)?;
    let mut neighbour = Simulation::new(&scene)?;
    let unknowns = motion.model().shape().unknowns;
    let mut next = motion.state().clone();
    motion.advance_to(0.0, &mut ()).into_diagnostic()?;
    // every start has a direction of its own to begin with
    for (i, q) in next.v[..unknowns].iter_mut().enumerate() {
        *q += distance * (1.0 + (i * STARTS + k) as f64).sin() / RATES;
    }
    neighbour.continue_from(&next).into_diagnostic()?;
    let mut sum = 0.0;
    for i in 1..=(DURATION / RETURN).round() as usize {
        let t = i as f64 * RETURN;
        motion.advance_to(t, &mut ()).into_diagnostic()?;
        neighbour.advance_to(t, &mut ()).into_diagnostic()?;
        let (one, other) = (motion.state(), neighbour.state());
        let square = |i| apart(one, other, i).powi(2) + (RATES * (other.v[i] - one.v[i])).powi(2);
        let apart = (0..unknowns).map(square).sum::<f64>().sqrt();
        if t > LEFT_OUT {
            sum += (apart / distance).ln();
        }
        bring_back(&mut next, one, other, unknowns, [distance / apart; 2]);
        neighbour.continue_from(&next).into_diagnostic()?;
    }
    let exponent = rounded(sum / (DURATION - LEFT_OUT), 9);
    Ok((exponent, motion.report().warnings()))
}

/// By how much a coordinate of another state is larger.
pub fn apart(one: &State, other: &State, i: usize) -> f64 {
    (other.q[i] - one.q[i]) + (other.q_low[i] - one.q_low[i])
}

/// Writes one + factor (other - one) into `next`, with factors of coordinates and of rates. A contact that both have closed keeps its
/// memory in the proportion of rates; one that only one of them has closed is closed where the gap says so.
pub fn bring_back(
    next: &mut State,
    one: &State,
    other: &State,
    unknowns: usize,
    [of_q, of_v]: [f64; 2],
) {
    next.copy_from(one);
    for i in 0..unknowns {
        next.q[i] += of_q * apart(one, other, i);
        next.v[i] += of_v * (other.v[i] - one.v[i]);
    }
    for (memory, other) in next.memory.iter_mut().zip(&other.memory) {
        if *memory > 0.0 && *other > 0.0 {
            *memory = (*memory + of_v * (other - *memory)).max(f64::MIN_POSITIVE);
        }
    }
}
