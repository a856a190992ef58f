//! What accuracy costs in time: a scene with several methods and steps, against a reference of its own.
//!
//! A [`Study`] names a scene, channels, a reference and curves; [`run`] makes all runs one after the other, each recorded
//! once and then timed several times without recording, and gives an [`Outcome`]. What it found is in [`Outcome::runs`] and
//! does not differ when the study is repeated; what it took is in [`Outcome::timings`].

mod diagram;
mod elements;
mod errors;
mod files;
mod statistics;
mod study;
mod table;

pub use crate::machine::Timing;
pub use diagram::figure;
pub use errors::Errors;
pub use files::{FILES, Time};
pub use statistics::{Measures, Sampled, Survey};
pub use study::{Curve, Pace, Reference, Statistics, Study, StudyError};
pub use table::{page, table};

use crate::instructions::Instructions;
use cpu_time::ThreadTime;
use errors::Series;
use looselink::scene::{Scene, SceneError};
use looselink::simulate::{Notice, Recording, Report, RunError, Simulation};
use serde::Serialize;

/// How thoroughly a study is made.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Timed runs, after the recorded one, of every point.
    pub repeats: usize,
    /// Only the first point of every curve, to see that the study works.
    pub smoke: bool,
}

/// All runs of a study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// The study's title.
    pub title: String,
    /// Difference between the two runs of the reference: nothing below it is distinguished.
    pub floor: Errors,
    /// Warnings of the two runs of the reference, coarse and fine.
    pub reference_warnings: [Vec<String>; 2],
    /// All points, curve by curve.
    pub runs: Vec<Run>,
    /// Their times, in the same order.
    #[serde(skip)]
    pub timings: Vec<Option<Timing>>,
    /// What the reference recorded.
    #[serde(skip)]
    exact: Series,
}

impl Outcome {
    /// Adds a point of another program, which has recorded the channels of the study at the same instants.
    ///
    /// # Errors
    /// A channel that it did not record.
    pub fn add(
        &mut self,
        study: &Study,
        curve: &str,
        pace: Pace,
        made: Result<Made, String>,
    ) -> Result<(), StudyError> {
        let (result, warnings, timing) = match made {
            Ok(made) => {
                let errors = Series::of(study, made.columns)?.errors(&self.exact);
                let work = made.work;
                let measured = Measured { errors, work };
                (Ok(measured), made.warnings, Some(made.timing))
            }
            Err(error) => (Err(error), Vec::new(), None),
        };
        self.runs.push(Run {
            curve: curve.to_owned(),
            pace,
            result,
            warnings,
        });
        self.timings.push(timing);
        Ok(())
    }

    /// Names of the curves in the order of their first points.
    pub fn curves(&self) -> Vec<&str> {
        distinct(self.runs.iter().map(|run| &*run.curve))
    }

    /// The time of every point.
    pub fn times(&self) -> Vec<Time<'_>> {
        let runs = self.runs.iter().map(|run| (&*run.curve, run.pace));
        Time::of(runs, &self.timings)
    }

    /// All warnings, each after the name of its run.
    pub fn warnings(&self) -> Vec<String> {
        let runs = self.runs.iter();
        let runs = runs.map(|run| (&*run.curve, run.pace, &*run.warnings));
        named_warnings(&self.reference_warnings, runs)
    }
}

fn named_warnings<'a>(
    reference: &[Vec<String>; 2],
    runs: impl Iterator<Item = (&'a str, Pace, &'a [String])>,
) -> Vec<String> {
    let mut all = Vec::new();
    let mut add = |name: &str, warnings: &[String]| {
        all.extend(warnings.iter().map(|warning| format!("{name}: {warning}")));
    };
    for (name, warnings) in ["coarse reference", "fine reference"].iter().zip(reference) {
        add(name, warnings);
    }
    for (curve, pace, warnings) in runs {
        add(&format!("{curve}, {pace}"), warnings);
    }
    all
}

/// Names without those that came before.
fn distinct<'a>(all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names = Vec::new();
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// A run that reached its end.
#[derive(Clone)]
pub struct Made<'a> {
    /// What it recorded, by the names of channels.
    pub columns: Columns<'a>,
    /// Work done.
    pub work: Work,
    /// What it warns of.
    pub warnings: Vec<String>,
    /// Its time.
    pub timing: Timing,
}

/// One point of a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Run {
    /// Name of the curve.
    pub curve: String,
    /// Step or accuracy.
    pub pace: Pace,
    /// What came of it.
    pub result: Result<Measured, String>,
    /// What a run that reached its end warns of.
    pub warnings: Vec<String>,
}

/// What a run that reached its end gave.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// Against the reference.
    pub errors: Errors,
    /// Work done.
    pub work: Work,
}

/// Counts of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[expect(missing_docs, reason = "the names are those of the report of a run")]
pub struct Work {
    pub steps: u64,
    pub rejected_steps: u64,
    pub location_trials: u64,
    pub newton_iterations: u64,
    pub factorisations: u64,
    pub onsets: u64,
}

impl Work {
    fn of(report: &Report) -> Work {
        let accuracy = report.accuracy.as_ref().map_or(0, |a| a.rejected_steps);
        Work {
            steps: report.steps,
            rejected_steps: report.rejected_steps + accuracy,
            location_trials: report.location_trials,
            newton_iterations: report.newton_iterations,
            factorisations: report.factorisations,
            onsets: report.onsets,
        }
    }
}

/// A scene run to its end, with what it recorded.
fn record(scene: &Scene) -> Result<(Recording, Report), Failed> {
    let mut simulation = Simulation::new(scene)?;
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording)?;
    Ok((recording, simulation.report()))
}

/// Processor times of repeated runs, without recording.
fn time(scene: &Scene, repeats: usize) -> Result<Timing, Failed> {
    let (mut seconds, mut counts) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        let mut simulation = Simulation::new(scene)?;
        let (clock, mut instructions) = (ThreadTime::now(), Instructions::start());
        simulation.run(&mut ())?;
        seconds.push(clock.elapsed().as_secs_f64());
        counts.push(instructions.count());
    }
    Ok(Timing::of(seconds).with_instructions(&counts))
}

/// Why a point of a curve is missing.
#[derive(Debug, thiserror::Error)]
enum Failed {
    /// The method does not take the scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The run ended early.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Makes all runs of a study; `tell` is called before each with its name, and with its warnings.
///
/// # Errors
/// A study that cannot be made: a faulty scene, a channel that the scene does not have, a reference that fails. A point of a
/// curve that fails is part of the outcome.
pub fn run(
    study: &Study,
    effort: Effort,
    tell: &mut dyn FnMut(Notice),
) -> Result<Outcome, StudyError> {
    let ([rough, exact], reference_warnings) = references(study, tell, Series::of)?;
    let mut outcome = Outcome {
        title: study.title.clone(),
        floor: rough.errors(&exact),
        reference_warnings,
        runs: Vec::new(),
        timings: Vec::new(),
        exact,
    };
    points(study, effort, tell, &mut |curve, pace, made| {
        outcome.add(study, curve, pace, made)
    })?;
    Ok(outcome)
}

/// What was recorded, by the names of channels.
type Columns<'a> = &'a dyn Fn(&str) -> Option<&'a [f64]>;

/// Takes a point of a curve.
type Add<'a> = &'a mut dyn FnMut(&str, Pace, Result<Made, String>) -> Result<(), StudyError>;

/// Tells the warnings of a run and gives them back.
fn warnings(report: &Report, run: &str, tell: &mut dyn FnMut(Notice)) -> Vec<String> {
    let warnings = report.warnings();
    for warning in &warnings {
        tell(Notice::Warned { run, warning });
    }
    warnings
}

/// Coarse and fine run of the reference, and their warnings.
fn references<T>(
    study: &Study,
    tell: &mut dyn FnMut(Notice),
    of: fn(&Study, Columns) -> Result<T, StudyError>,
) -> Result<([T; 2], [Vec<String>; 2]), StudyError> {
    let mut run = |pace: Pace| {
        let name = format!("reference, {pace}");
        tell(Notice::Begun(&name));
        let scene = study.scene(&study.reference.set, study.reference.elements, pace)?;
        let failed = |e: Failed| match e {
            Failed::Scene(e) => StudyError::Scene(e),
            Failed::Run(e) => StudyError::plain(format!("the reference with {pace} fails: {e}")),
        };
        let (recording, report) = record(&scene).map_err(failed)?;
        let found = of(study, &|name| recording.get(name))?;
        Ok::<_, StudyError>((found, warnings(&report, &name, tell)))
    };
    let [coarse, fine] = study.reference.paces();
    let ((coarse, of_coarse), (fine, of_fine)) = (run(coarse)?, run(fine)?);
    Ok(([coarse, fine], [of_coarse, of_fine]))
}

/// Makes all points of all curves and gives each to `add`.
fn points(
    study: &Study,
    effort: Effort,
    tell: &mut dyn FnMut(Notice),
    add: Add,
) -> Result<(), StudyError> {
    let count = if effort.smoke { 1 } else { usize::MAX };
    for curve in &study.curves {
        for pace in curve.paces().into_iter().take(count) {
            let name = format!("{}, {pace}", curve.name);
            tell(Notice::Begun(&name));
            let scene = study.scene(&curve.set, curve.elements, pace)?;
            let made = record(&scene).and_then(|(recording, report)| {
                Ok((recording, report, time(&scene, effort.repeats)?))
            });
            match made {
                Ok((recording, report, timing)) => {
                    let made = Made {
                        columns: &|name| recording.get(name),
                        work: Work::of(&report),
                        warnings: warnings(&report, &name, tell),
                        timing,
                    };
                    add(&curve.name, pace, Ok(made))?;
                }
                Err(error) => add(&curve.name, pace, Err(error.to_string()))?,
            }
        }
    }
    Ok(())
}
