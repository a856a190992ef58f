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

use crate::ensembles::{MOVED, moved};
use crate::interval::STARTS;
use crate::kinematics::MechanismGeometry;
use crate::record::Exponents;
use crate::runs::{RunPace, RunPlan, each};
use looselink::simulate::Simulation;
use looselink::system::State;
use miette::{IntoDiagnostic, Result};

/// Time between two returns to d0 \[s\].
const RETURN: f64 = 1e-3;
/// Simulated time \[s\].
pub const DURATION: f64 = 2.0;
/// Part of it in which the direction settles, which is not counted \[s\].
pub const LEFT_OUT: f64 = 0.5;
/// Time that turns a rate into a length \[s\].
const RATES: f64 = 1e-3;
/// Returns between two values of the growth that are kept.
const KEPT_EVERY: usize = 20;
/// Steps at which the energy ledger closes to 5 % of the contact dissipation, and distances d0.
///
/// With loose joints a distance has to be far below a penetration, some 1e-8 m. In case 2 nothing magnifies it, so that
/// what rounding and Newton's tolerance add to it shows: measured 4/s at a distance of 1e-12 and 0.3/s at 1e-10.
const MOTIONS: [(u32, RunPace, [f64; 2]); 3] = [
    (4, RunPace::Steps("trapezoidal", 2.5e-6), [1e-10, 1e-12]),
    (3, RunPace::Steps("trapezoidal", 5e-6), [1e-10, 1e-12]),
    (2, RunPace::Steps("trapezoidal", 2e-5), [1e-8, 1e-10]),
];

/// Time between two kept values of the growth \[s\].
pub const KEPT_INTERVAL: f64 = RETURN * KEPT_EVERY as f64;

/// Exponents of cases 2, 3 and 4 at two distances.
///
/// # Errors
/// The first run that fails.
pub fn run(g: &MechanismGeometry) -> Result<Vec<Exponents>> {
    let jobs: Vec<(u32, RunPace, f64, usize)> = MOTIONS
        .iter()
        .flat_map(|&(case, pace, distances)| distances.map(|distance| (case, pace, distance)))
        .flat_map(|(case, pace, distance)| (0..STARTS).map(move |k| (case, pace, distance, k)))
        .collect();
    let run = |&(case, pace, distance, k): &(u32, RunPace, f64, usize)| {
        growth(g, case, pace, distance, k)
    };
    let done = each(&jobs, run)
        .into_iter()
        .collect::<Result<Vec<Growth>>>()?;
    let groups = jobs.chunks(STARTS).zip(done.chunks(STARTS));
    Ok(groups.map(|(jobs, done)| together(jobs[0], done)).collect())
}

/// What one pair of motions gave.
struct Growth {
    /// Sums of ln(d_k/d0) after every return.
    sums: Vec<f64>,
    warnings: Vec<String>,
}

fn together((case, pace, distance, _): (u32, RunPace, f64, usize), done: &[Growth]) -> Exponents {
    let from = (LEFT_OUT / RETURN) as usize;
    let counted = |sums: &[f64]| {
        let (first, last) = (sums[from - 1], sums[sums.len() - 1]);
        (last - first) / (RETURN * (sums.len() - from) as f64)
    };
    let mean = |i: usize| done.iter().map(|d| d.sums[i]).sum::<f64>() / done.len() as f64;
    let kept = (KEPT_EVERY - 1..done[0].sums.len()).step_by(KEPT_EVERY);
    Exponents {
        case,
        distance,
        how: pace.label(),
        values: done.iter().map(|d| counted(&d.sums)).collect(),
        growth: kept.map(mean).collect(),
        warnings: done.iter().map(|d| d.warnings.clone()).collect(),
    }
}

fn growth(
    g: &MechanismGeometry,
    case: u32,
    pace: RunPace,
    distance: f64,
    k: usize,
) -> Result<Growth> {
    let mut plan = RunPlan::new(case, pace, RETURN, DURATION);
    // the starts of an ensemble; case 2 has no loose joint that would let the platform start elsewhere
    if case > 2 {
        plan.overrides.push(moved(g, MOVED, k));
    }
    let scene = plan.scene()?;
    let mut motion = Simulation::new(&scene)?;
    let mut neighbour = Simulation::new(&scene)?;
    let unknowns = motion.model().shape().unknowns;
    let mut pair = StatePair {
        unknowns,
        next: motion.state().clone(),
    };
    motion.advance_to(0.0, &mut ()).into_diagnostic()?;
    // every start has a direction of its own to begin with
    for (i, q) in pair.next.v[..unknowns].iter_mut().enumerate() {
        *q += distance * (1.0 + (i * STARTS + k) as f64).sin() / RATES;
    }
    neighbour.continue_from(&pair.next).into_diagnostic()?;
    let mut sums = Vec::new();
    let mut sum = 0.0;
    for i in 1..=(DURATION / RETURN).round() as usize {
        let t = i as f64 * RETURN;
        motion.advance_to(t, &mut ()).into_diagnostic()?;
        neighbour.advance_to(t, &mut ()).into_diagnostic()?;
        let apart = pair.distance(motion.state(), neighbour.state());
        sum += (apart / distance).ln();
        sums.push(sum);
        pair.bring_back(motion.state(), neighbour.state(), distance / apart);
        neighbour.continue_from(&pair.next).into_diagnostic()?;
    }
    Ok(Growth {
        sums,
        warnings: motion.report().warnings(),
    })
}

/// Two neighbouring states.
struct StatePair {
    unknowns: usize,
    next: State,
}

impl StatePair {
    fn distance(&self, one: &State, other: &State) -> f64 {
        let squares = (0..self.unknowns).map(|i| {
            let q = (other.q[i] - one.q[i]) + (other.q_low[i] - one.q_low[i]);
            q.powi(2) + (RATES * (other.v[i] - one.v[i])).powi(2)
        });
        squares.sum::<f64>().sqrt()
    }

    /// Writes one + factor (other - one) into `next`. A contact that both have closed keeps its memory in the same
    /// proportion; one that only one of them has closed is closed where the gap says so.
    fn bring_back(&mut self, one: &State, other: &State, factor: f64) {
        let next = &mut self.next;
        next.copy_from(one);
        for i in 0..self.unknowns {
            let q = (other.q[i] - one.q[i]) + (other.q_low[i] - one.q_low[i]);
            next.q[i] += factor * q;
            next.v[i] += factor * (other.v[i] - one.v[i]);
        }
        for (memory, other) in next.z.iter_mut().zip(&other.z) {
            if *memory > 0.0 && *other > 0.0 {
                *memory = (*memory + factor * (other - *memory)).max(f64::MIN_POSITIVE);
            }
        }
    }
}
