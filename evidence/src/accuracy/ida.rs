//! The second implementation as a rival: full coordinates, stabilised index 2, IDA with located onsets.

use crate::accuracy::settings::{ORDERS, RATIOS, SettingsSweep, TOLERANCES, Trial};
use looselink::simulate::Notice;
use miette::{Result, miette};
use studies::StudyError;
use studies::precision::{CompletedRun, RunTiming, Study, StudyOutcome, StudyPace, WorkCounts};
use verify::ida_of_system::{IdaSettings, NEWTON};
use verify::reference::LsTolerances;
use verify::trajectory::{ComparisonPlan, Trajectory, linear_solver, tolerances};

/// A run that takes longer is not repeated: its time has no jitter that matters \[s\].
const LONG_RUN: f64 = 5.0;
/// After a run that takes longer no tighter tolerance is asked for \[s\].
pub const LAST_RUN: f64 = 20.0;

/// Name of the curve with a largest order.
pub fn name(max_order: i32) -> String {
    format!("IDA (second implementation), order up to {max_order}")
}

/// Adds a curve for each largest order, each with the best of the ratios of tolerances, and returns what was tried.
///
/// # Errors
/// A channel of the study that it does not have.
pub fn add_curves(
    study: &Study,
    study_name: &str,
    outcome: &mut StudyOutcome,
    repeats: usize,
    tell: &mut dyn FnMut(Notice),
) -> Result<Vec<SettingsSweep>> {
    let plan = plan(study);
    let mut sweeps = Vec::new();
    for max_order in ORDERS {
        let curve = name(max_order);
        let usual = usual_settings(study, max_order)?;
        let candidates = RATIOS.map(|ratio| IdaSettings { ratio, ..usual });
        tell(Notice::Begun(&format!("{curve}, ratios of tolerances")));
        let trial = |settings, tolerance| {
            let run = run(&plan, settings, tolerance).map_err(|e| e.root_cause().to_string())?;
            let columns = |name: &str| run.columns.get(name).map(Vec::as_slice);
            let measured = outcome.measure(study, &columns, None, work(&run));
            let measured = measured.map_err(|e| e.to_string())?;
            Ok(Trial {
                tolerance,
                error: measured.errors.position,
                seconds: run.seconds,
                residuals: measured.work.newton_iterations,
                jacobians: measured.work.factorisations,
            })
        };
        let sweep = SettingsSweep::new(study_name, &curve, &candidates, trial);
        let settings = sweep.settings();
        points(
            study,
            settings,
            &TOLERANCES,
            repeats,
            tell,
            &mut |pace, made| outcome.add(study, &curve, pace, made),
        )?;
        sweeps.push(sweep);
    }
    Ok(sweeps)
}

/// The ratio and the linear solver with which the second implementation is compared.
///
/// # Errors
/// A fault of the scene.
pub fn usual_settings(study: &Study, max_order: i32) -> Result<IdaSettings> {
    Ok(IdaSettings {
        max_order,
        ratio: 1.0,
        linear_solver: linear_solver(&plan(study).reference()?),
        newton: NEWTON[0],
    })
}

/// Takes a point.
type Add<'a> = &'a mut dyn FnMut(StudyPace, Result<CompletedRun, String>) -> Result<(), StudyError>;

/// Makes the points of a curve and gives each to `add`.
///
/// # Errors
/// A channel of the study that it does not have.
pub fn points(
    study: &Study,
    settings: IdaSettings,
    tolerances: &[f64],
    repeats: usize,
    tell: &mut dyn FnMut(Notice),
    add: Add,
) -> Result<()> {
    let (plan, name) = (plan(study), name(settings.max_order));
    for &tolerance in tolerances {
        tell(Notice::Begun(&format!("{name}, tolerance {tolerance:e}")));
        let made = repeated(&plan, settings, tolerance, repeats);
        let pace = StudyPace::Tolerance(tolerance);
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

fn plan(study: &Study) -> ComparisonPlan {
    // IDA has steps of its own; that of the scene may not divide the interval of the study
    let step = format!("integrator.step={:e}", study.interval);
    let set = [&study.set[..], &[step]].concat();
    ComparisonPlan::of_file(&study.scene, &set, study.duration, study.interval)
}

fn run(plan: &ComparisonPlan, settings: IdaSettings, tolerance: f64) -> Result<Trajectory> {
    plan.cpp(&LsTolerances {
        relative: settings.ratio * tolerance,
        max_order: settings.max_order,
        newton: settings.newton,
        ..tolerances(tolerance)
    })
}

/// A first run, which is recorded, and the times of those after it.
fn repeated(
    plan: &ComparisonPlan,
    settings: IdaSettings,
    tolerance: f64,
    repeats: usize,
) -> Result<(Trajectory, RunTiming)> {
    let run = || run(plan, settings, tolerance);
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
