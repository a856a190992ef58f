//! Explicit and implicit methods in counted work, and what they do over many cycles.

use crate::ensembles::{MOVED, moved};
use crate::interval::STARTS;
use crate::kinematics::MechanismGeometry;
use crate::measures::deviation;
use crate::record::{Long, MethodWork};
use crate::runs::{CaseRecording, RunPace, RunPlan, causes, each};
use crate::signal::{peak, rms};
use miette::Result;

/// Methods that are compared, the implicit ones first.
const METHODS: [&str; 6] = [
    "bathe",
    "trapezoidal",
    "generalized_alpha",
    "hht",
    "dormand_prince",
    "velocity_verlet",
];
/// Spectral radius at infinite frequency of generalised-alpha and HHT.
const RADIUS: f64 = 0.8;
/// Compared over this time \[s\], which the first impacts of case 4 fall into.
pub const HORIZON: f64 = 6e-3;
/// Time between compared rows \[s\]; no step is longer.
const ROWS: f64 = 1e-4;
/// Steps, as parts of the time between rows.
const PARTS: [u32; 18] = [
    1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512,
];
/// Step of the reference, Dormand and Prince's pair of order 5 \[s\].
const REFERENCE: f64 = 5e-8;
/// Cases, steps \[s\], cycles and starts of the long runs; case 4 is chaotic.
const LONG: [(u32, f64, f64, usize); 3] = [
    (2, 1e-3, 34.0, 1),
    (2, 1e-4, 34.0, 1),
    (4, 1e-4, 10.0, STARTS),
];

/// Whether a method is explicit.
pub fn explicit(method: &str) -> bool {
    method == "dormand_prince" || method == "velocity_verlet"
}

fn plan(case: u32, method: &'static str, step: f64, interval: f64, duration: f64) -> RunPlan {
    let plan = RunPlan::new(case, RunPace::Steps(method, step), interval, duration);
    if method == "generalized_alpha" || method == "hht" {
        plan.with("integrator.spectral_radius", RADIUS)
    } else {
        plan
    }
}

/// Error and counted work of every method over a ladder of steps, in cases 2 and 4.
///
/// # Errors
/// When the reference fails; a run that stops is a result.
pub fn work() -> Result<Vec<MethodWork>> {
    let mut all = Vec::new();
    for case in [2, 4] {
        let reference = plan(case, "dormand_prince", REFERENCE, ROWS, HORIZON).run()?;
        let reference = reference.column("error.x");
        // velocity Verlet keeps no constraints, and case 2 has those of its ideal joints
        let methods = METHODS
            .iter()
            .filter(|m| case > 2 || **m != "velocity_verlet");
        let jobs: Vec<(&'static str, f64)> = methods
            .flat_map(|m| PARTS.map(|parts| (*m, ROWS / f64::from(parts))))
            .collect();
        let run = |&(method, step): &(&'static str, f64)| {
            let mut work = MethodWork {
                case,
                method: method.into(),
                step,
                evaluations: 0,
                error: None,
                size: peak(reference),
                warnings: Vec::new(),
            };
            match plan(case, method, step, ROWS, HORIZON).run() {
                Err(error) => work.warnings.push(format!("stopped: {}", causes(&error))),
                Ok(done) => {
                    let pairs = done.column("error.x").iter().zip(reference);
                    let apart: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
                    work.error = Some(peak(&apart));
                    work.evaluations = evaluations(&done);
                    work.warnings.clone_from(&done.warnings);
                }
            }
            work
        };
        all.extend(each(&jobs, run));
    }
    Ok(all)
}

/// How often the elastic force of an element was evaluated; implicit methods evaluate its tangent with it.
pub fn evaluations(recording: &CaseRecording) -> u64 {
    let effects = &recording.report.effects;
    effects.get("ancf_elastic_force").copied().unwrap_or(0)
}

/// The implicit methods over many cycles. A run that stops is a result.
pub fn long(g: &MechanismGeometry) -> Vec<Long> {
    let methods = METHODS.iter().filter(|m| !explicit(m));
    let groups: Vec<(&'static str, u32, f64, f64, usize)> = methods
        .flat_map(|m| LONG.map(|(case, step, cycles, starts)| (*m, case, step, cycles, starts)))
        .collect();
    let jobs: Vec<(usize, usize)> = (0..groups.len())
        .flat_map(|i| (0..groups[i].4).map(move |k| (i, k)))
        .collect();
    let run = |&(i, k): &(usize, usize)| {
        let (method, case, step, cycles, _) = groups[i];
        let mut plan = plan(case, method, step, step, cycles / g.frequency);
        if case > 2 {
            plan.overrides.push(moved(g, MOVED, k));
        }
        match plan.run() {
            Err(error) => (None, vec![format!("stopped: {}", causes(&error))]),
            Ok(done) => {
                let cycle = |last: f64| {
                    let end = last / g.frequency;
                    rms(&deviation(g, &done, end - 1.0 / g.frequency, end))
                };
                (Some(cycle(cycles) / cycle(2.0)), done.warnings)
            }
        }
    };
    let done: Vec<(Option<f64>, Vec<String>)> = each(&jobs, run);
    let of = |i: usize| jobs.iter().zip(&done).filter(move |((j, _), _)| *j == i);
    let long = |(i, &(method, case, step, cycles, _)): (usize, &(_, u32, f64, f64, usize))| Long {
        case,
        method: str::to_owned(method),
        step,
        cycles,
        stopped: of(i).filter(|(_, (growth, _))| growth.is_none()).count(),
        growth: of(i).filter_map(|(_, (growth, _))| *growth).collect(),
        warnings: of(i).map(|(_, (_, warnings))| warnings.clone()).collect(),
    };
    groups.iter().enumerate().map(long).collect()
}
