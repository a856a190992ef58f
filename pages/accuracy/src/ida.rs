//! The second implementation as a rival: full coordinates, stabilised index 2, IDA with located onsets.

use looselink::simulate::Notice;
use miette::{Result, miette};
use studies::StudyError;
use studies::precision::{CompletedRun, RunTiming, Study, StudyPace, WorkCounts};
use verify::trajectory::{ComparisonPlan, Trajectory, tolerances};

/// Name of its curve.
pub const NAME: &str = "IDA (second implementation)";

/// Relative tolerances; positions are held to a thousandth of a metre of that, velocities to 0.1 m/s.
pub const RELATIVE: [f64; 9] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// A run that takes longer is not repeated: its time has no jitter that matters \[s\].
const LONG_RUN: f64 = 5.0;
/// After a run that takes longer no tighter tolerance is asked for \[s\].
pub const LAST_RUN: f64 = 20.0;

/// Takes a point.
type Add<'a> = &'a mut dyn FnMut(StudyPace, Result<CompletedRun, String>) -> Result<(), StudyError>;

/// Makes the points of its curve and gives each to `add`.
///
/// # Errors
/// A channel of the study that it does not have.
pub fn points(
    study: &Study,
    tolerances: &[f64],
    repeats: usize,
    tell: &mut dyn FnMut(Notice),
    add: Add,
) -> Result<()> {
    // IDA has steps of its own; that of the scene may not divide the interval of the study
    let step = format!("integrator.step={:e}", study.interval);
    let set = [&study.set[..], &[step]].concat();
    let plan = ComparisonPlan::of_file(&study.scene, &set, study.duration, study.interval);
    for &relative in tolerances {
        tell(Notice::Begun(&format!("{NAME}, tolerance {relative:e}")));
        let made = repeated(&plan, relative, repeats);
        let pace = StudyPace::Tolerance(relative);
        let added = match &made {
            Ok((run, timing)) => {
                let made = CompletedRun {
                    columns: &|name| run.columns.get(name).map(Vec::as_slice),
                    motion: None,
                    work: work(run),
                    // IDA reports failures alone
                    warnings: Vec::new(),
                    timing: timing.clone(),
                };
                add(pace, Ok(made))
            }
            // around it are the names of the study and of its files
            Err(error) => add(pace, Err(error.root_cause().to_string())),
        };
        added.map_err(|e| miette!("{e}"))?;
        if made.is_ok_and(|(run, _)| run.seconds > LAST_RUN) {
            break;
        }
    }
    Ok(())
}

/// A first run, which is recorded, and the times of those after it.
fn repeated(
    plan: &ComparisonPlan,
    relative: f64,
    repeats: usize,
) -> Result<(Trajectory, RunTiming)> {
    let run = || plan.cpp(&tolerances(relative));
    let first = run()?;
    let seconds = times(first.seconds, repeats, || Ok(run()?.seconds))?;
    Ok((first, RunTiming::of(seconds)))
}

/// The times of runs after a first one, or its own if it was long \[s\].
///
/// # Errors
/// When a run fails.
pub fn times(first: f64, repeats: usize, run: impl Fn() -> Result<f64>) -> Result<Vec<f64>> {
    match first > LONG_RUN {
        true => Ok(vec![first]),
        false => (0..repeats).map(|_| run()).collect(),
    }
}

fn work(run: &Trajectory) -> WorkCounts {
    let counts = &run.counts;
    let count = |n: i64| u64::try_from(n).unwrap_or(0);
    WorkCounts {
        steps: count(counts.steps),
        rejected_steps: count(counts.error_failures + counts.convergence_failures),
        location_trials: count(counts.restarts),
        newton_iterations: count(counts.residuals),
        factorisations: count(counts.jacobians),
        onsets: run.impacts.len() as u64,
    }
}
