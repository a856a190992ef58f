//! What accuracy costs in time: a scene with several methods and steps, against a reference of its own.
//!
//! A [`Study`] names a scene, channels, a reference and curves; [`Found::run`] makes all runs one after the other, each recorded
//! once and then timed several times without recording. What it found is in [`Found::runs`] and does not differ when the study
//! is repeated; what it took is in [`Found::timings`]. Short runs are compared in their [`MotionReference`], long ones in their
//! [`StatisticsReference`].

mod diagram;
mod elements;
mod errors;
mod files;
mod motion;
mod statistics;
mod study;
mod table;

pub use crate::machine::RunTiming;
pub use errors::{Errors, MeasuredRun, MotionReference};
pub use files::{Time, kind};
pub use statistics::{RunStatistics, StatisticsReference};
pub use study::{ReferenceRuns, Sampling, Study, StudyCurve, StudyPace};

use crate::StudyError;
use crate::machine::count_instructions;
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::{Notice, Report, Simulation};
use motion::MotionRecording;
use plot::Figure;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::error::Error;

/// How thoroughly a study is made.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Timed runs, after the recorded one, of every point.
    pub repeats: usize,
    /// Only the first point of every curve, to see that the study works.
    pub smoke: bool,
}

/// What was recorded, by the names of channels.
type ColumnLookup<'a> = &'a dyn Fn(&str) -> Option<&'a [f64]>;

/// A recorded column.
fn column<'a>(get: ColumnLookup<'a>, name: &str) -> Result<&'a [f64], StudyError> {
    let missing = || StudyError::Plain(format!("the scene has no channel {name:?}"));
    get(name).ok_or_else(missing)
}

/// What of the runs of a study is compared with what of its reference.
pub trait Compared: Serialize + DeserializeOwned {
    /// What is kept of a run to compare it.
    type Kept;
    /// What a run that reached its end gave.
    type Measured: Serialize + DeserializeOwned;
    /// What the figure shows, in words.
    const FIGURE: &str;

    /// What is kept of a run, from its columns and the motion of its bodies, where that is known.
    ///
    /// # Errors
    /// A channel that it does not have.
    fn keep(
        study: &Study,
        get: ColumnLookup,
        motion: Option<Vec<f64>>,
    ) -> Result<Self::Kept, StudyError>;

    /// From the coarse and the fine run of the reference.
    fn new(coarse: Self::Kept, fine: Self::Kept) -> Self;

    /// A run against the reference.
    fn measure(&self, kept: Self::Kept, work: WorkCounts) -> Self::Measured;

    /// What was found and what it took, a line a run, in Markdown.
    fn table(found: &Found<Self>, study: &Study) -> String;

    /// The diagrams.
    fn figure(found: &Found<Self>, study: &Study) -> Figure;
}

/// All runs of a study.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Found<C: Compared> {
    /// The study's title.
    pub title: String,
    /// What the runs are compared with.
    #[serde(flatten)]
    pub reference: C,
    /// Warnings of the two runs of the reference, coarse and fine.
    pub reference_warnings: [Vec<String>; 2],
    /// All points, curve by curve.
    pub runs: Vec<CurvePoint<C::Measured>>,
    /// Their times, in the same order.
    #[serde(skip)]
    pub timings: Vec<Option<RunTiming>>,
}

/// Errors of motions.
pub type StudyOutcome = Found<MotionReference>;
/// Statistics of long runs.
pub type Survey = Found<StatisticsReference>;

/// A run that reached its end.
#[derive(Clone)]
pub struct CompletedRun<'a> {
    /// What it recorded, by the names of channels.
    pub columns: ColumnLookup<'a>,
    /// All coordinates as distances \[m\], row after row; none from another program.
    pub motion: Option<Vec<f64>>,
    /// Work done.
    pub work: WorkCounts,
    /// What it warns of.
    pub warnings: Vec<String>,
    /// Its time.
    pub timing: RunTiming,
}

/// One point of a curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint<T> {
    /// Name of the curve.
    pub curve: String,
    /// Step or accuracy.
    pub pace: StudyPace,
    /// What came of it.
    pub result: Result<T, String>,
    /// What a run that reached its end warns of.
    pub warnings: Vec<String>,
}

/// Counts of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are those of the report of a run")]
pub struct WorkCounts {
    pub steps: u64,
    pub rejected_steps: u64,
    pub location_trials: u64,
    pub newton_iterations: u64,
    pub factorisations: u64,
    pub onsets: u64,
}

impl WorkCounts {
    fn of(report: &Report) -> WorkCounts {
        let accuracy = report.accuracy.as_ref().map_or(0, |a| a.rejected_steps);
        WorkCounts {
            steps: report.steps,
            rejected_steps: report.rejected_steps + accuracy,
            location_trials: report.location_trials,
            newton_iterations: report.newton_iterations,
            factorisations: report.factorisations,
            onsets: report.onsets,
        }
    }
}

impl<C: Compared> Found<C> {
    /// Makes all runs of a study; `tell` is called before each with its name, and with its warnings.
    ///
    /// # Errors
    /// A study that cannot be made: a faulty scene, a channel that the scene does not have, a reference that fails. A point of
    /// a curve that fails is part of what is found.
    pub fn run(
        study: &Study,
        effort: Effort,
        tell: &mut dyn FnMut(Notice),
    ) -> Result<Found<C>, StudyError> {
        let shorter = effort.smoke && study.statistics.is_some();
        let study = &if shorter {
            study.brief()
        } else {
            study.clone()
        };
        let [coarse, fine] = study.reference.paces();
        let (coarse, of_coarse) = reference::<C>(study, coarse, tell)?;
        let (fine, of_fine) = reference::<C>(study, fine, tell)?;
        let mut found = Found {
            title: study.title.clone(),
            reference: C::new(coarse, fine),
            reference_warnings: [of_coarse, of_fine],
            runs: Vec::new(),
            timings: Vec::new(),
        };
        let count = if effort.smoke { 1 } else { usize::MAX };
        for curve in &study.curves {
            for pace in curve.paces().into_iter().take(count) {
                let name = format!("{}, {pace}", curve.name);
                tell(Notice::Begun(&name));
                let scene = study.scene(&curve.set, curve.elements, pace)?;
                match record_and_time(&scene, effort.repeats) {
                    Ok((recorded, report, timing)) => {
                        let made = CompletedRun {
                            columns: &|name| recorded.channels.get(name),
                            motion: Some(recorded.motion),
                            work: WorkCounts::of(&report),
                            warnings: warnings(&report, &name, tell),
                            timing,
                        };
                        found.add(study, &curve.name, pace, Ok(made))?;
                    }
                    Err(error) => found.add(study, &curve.name, pace, Err(error.to_string()))?,
                }
            }
        }
        Ok(found)
    }

    /// Adds a point, which may come from another program that has recorded the channels of the study at the same instants.
    ///
    /// # Errors
    /// A channel that it did not record.
    pub fn add(
        &mut self,
        study: &Study,
        curve: &str,
        pace: StudyPace,
        made: Result<CompletedRun, String>,
    ) -> Result<(), StudyError> {
        let (result, warnings, timing) = match made {
            Ok(made) => {
                let kept = C::keep(study, made.columns, made.motion)?;
                let measured = self.reference.measure(kept, made.work);
                (Ok(measured), made.warnings, Some(made.timing))
            }
            Err(error) => (Err(error), Vec::new(), None),
        };
        self.runs.push(CurvePoint {
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
        let mut names = Vec::new();
        for run in &self.runs {
            if !names.contains(&&*run.curve) {
                names.push(&*run.curve);
            }
        }
        names
    }

    /// All warnings, each after the name of its run.
    pub fn warnings(&self) -> Vec<String> {
        let names = ["coarse reference", "fine reference"].map(str::to_owned);
        let of_reference = names.into_iter().zip(&self.reference_warnings);
        let runs = self.runs.iter();
        let of_runs = runs.map(|run| (format!("{}, {}", run.curve, run.pace), &run.warnings));
        let all = of_reference.chain(of_runs);
        all.flat_map(|(name, warnings)| warnings.iter().map(move |w| format!("{name}: {w}")))
            .collect()
    }
}

impl Found<MotionReference> {
    /// Least processor time at which a curve comes below an error of position to stay there; see [`reached`].
    pub fn time_at(&self, curve: &str, error: f64, times: Times) -> Option<CurveTime> {
        let runs = self.runs.iter().zip(&self.timings);
        let own = runs.filter(|(run, _)| run.curve == curve);
        let points = own.filter_map(|(run, timing)| {
            let error = run.result.as_ref().ok()?.errors.position;
            Some(([error, timing.as_ref()?.median], run.pace))
        });
        let (points, paces): (Vec<[f64; 2]>, Vec<StudyPace>) = points.unzip();
        let found = reached(&points, error, times)?;
        let pace = match found.point {
            0 => paces[0],
            k => paces[k - 1].towards(paces[k], |a, b| a * (b / a).powf(found.share)),
        };
        Some(CurveTime {
            seconds: found.seconds,
            pace,
            is_interpolated: found.is_interpolated(),
        })
    }
}

/// The time that an error takes with a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveTime {
    /// Processor time \[s\].
    pub seconds: f64,
    /// Step or accuracy.
    pub pace: StudyPace,
    /// True where no run was made with this step or accuracy.
    pub is_interpolated: bool,
}

/// Which times count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Times {
    /// Those of runs that were made.
    Measured,
    /// Also those on the straight line between two runs in the log-log plane.
    Interpolated,
}

/// Where a curve comes below an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reached {
    /// Its time.
    pub seconds: f64,
    /// Index of the run that is below the error.
    pub point: usize,
    /// Share of the line from the run before to this one; 1 is the run itself.
    pub share: f64,
}

impl Reached {
    /// True between two runs.
    pub fn is_interpolated(&self) -> bool {
        self.share < 1.0
    }
}

/// Least time at which a curve comes below an error to stay there, from its points \[error, time\], coarse ones first. A coarse
/// point may have a small error by chance, so the error of a point is the largest of its own and those of finer points.
pub fn reached(points: &[[f64; 2]], error: f64, times: Times) -> Option<Reached> {
    let mut best: Option<Reached> = None;
    let (mut largest, mut finer): (f64, Option<[f64; 2]>) = (0.0, None);
    for (k, &[own, time]) in points.iter().enumerate().rev() {
        largest = errors::larger(largest, own);
        let candidate = match finer {
            _ if largest <= error => Some((time, k, 1.0)),
            Some([below, later]) if below <= error && times == Times::Interpolated => {
                let share = (largest / error).ln() / (largest / below).ln();
                Some((time * (later / time).powf(share), k + 1, share))
            }
            _ => None,
        };
        let candidate = candidate.map(|(seconds, point, share)| Reached {
            seconds,
            point,
            share,
        });
        best = [best, candidate]
            .into_iter()
            .flatten()
            .min_by(|a, b| a.seconds.total_cmp(&b.seconds));
        finer = Some([largest, time]);
    }
    best
}

/// One run of the reference, and its warnings.
fn reference<C: Compared>(
    study: &Study,
    pace: StudyPace,
    tell: &mut dyn FnMut(Notice),
) -> Result<(C::Kept, Vec<String>), StudyError> {
    let name = format!("reference, {pace}");
    tell(Notice::Begun(&name));
    let scene = study.scene(&study.reference.set, study.reference.elements, pace)?;
    let mut simulation = Simulation::new(&scene)?;
    let mut recorded = MotionRecording::new(&simulation);
    let ended = simulation.run(&mut recorded);
    ended.map_err(|e| StudyError::Plain(format!("the reference with {pace} fails: {e}")))?;
    let MotionRecording {
        channels, motion, ..
    } = recorded;
    let kept = C::keep(study, &|name| channels.get(name), Some(motion))?;
    Ok((kept, warnings(&simulation.report(), &name, tell)))
}

/// Tells the warnings of a run and gives them back.
fn warnings(report: &Report, run: &str, tell: &mut dyn FnMut(Notice)) -> Vec<String> {
    let warnings = report.warnings();
    for warning in &warnings {
        tell(Notice::Warned { run, warning });
    }
    warnings
}

/// Runs a scene to its end, and again without recording for the processor times.
fn record_and_time(
    scene: &Scene,
    repeats: usize,
) -> Result<(MotionRecording, Report, RunTiming), Box<dyn Error>> {
    let mut simulation = Simulation::new(scene)?;
    let mut recorded = MotionRecording::new(&simulation);
    simulation.run(&mut recorded)?;
    let (mut seconds, mut counts) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        let mut simulation = Simulation::new(scene)?;
        let (clock, mut instructions) = (ThreadTime::now(), count_instructions());
        simulation.run(&mut ())?;
        seconds.push(clock.elapsed().as_secs_f64());
        counts.push(instructions());
    }
    let timing = RunTiming::of(seconds).with_instructions(&counts);
    Ok((recorded, simulation.report(), timing))
}

#[cfg(test)]
mod tests {
    use super::{Reached, Times, reached};

    fn interpolated(points: &[[f64; 2]], error: f64) -> Option<Reached> {
        reached(points, error, Times::Interpolated)
    }

    #[test]
    fn the_time_of_an_error_is_between_points() {
        let points = [[1e-4, 1.0], [1e-6, 10.0], [1e-8, 100.0]];
        let found = interpolated(&points, 1e-7).unwrap();
        assert!((found.seconds - 10.0 * 10_f64.sqrt()).abs() < 1e-12);
        assert_eq!((found.point, found.share), (2, 0.5));
        let first = Reached {
            seconds: 1.0,
            point: 0,
            share: 1.0,
        };
        assert_eq!(interpolated(&points, 1e-3), Some(first));
        assert_eq!(interpolated(&points, 1e-9), None);
        assert_eq!(interpolated(&[], 1.0), None);
    }

    #[test]
    fn only_a_time_between_two_runs_is_interpolated() {
        let points = [[1e-4, 1.0], [1e-6, 10.0], [1e-8, 100.0]];
        for (error, is_interpolated, measured) in [
            (1e-3, false, Some(1.0)),
            (1e-4, false, Some(1.0)),
            (0.99e-4, true, Some(10.0)),
            (1.01e-6, true, Some(10.0)),
            (1e-6, false, Some(10.0)),
            (1e-7, true, Some(100.0)),
            (1e-8, false, Some(100.0)),
        ] {
            let found = interpolated(&points, error).unwrap();
            assert_eq!(found.is_interpolated(), is_interpolated, "{error:e}");
            let run = reached(&points, error, Times::Measured).unwrap();
            assert!(!run.is_interpolated(), "{error:e}");
            assert_eq!(Some(run.seconds), measured, "{error:e}");
            assert!(found.seconds <= run.seconds, "{error:e}");
        }
        assert_eq!(reached(&points, 0.99e-8, Times::Measured), None);
    }

    #[test]
    fn a_coarse_point_that_is_lucky_does_not_count() {
        let points = [[1e-4, 1.0], [1e-9, 2.0], [1e-6, 10.0], [1e-8, 100.0]];
        assert!(interpolated(&points, 1e-8).unwrap().seconds == 100.0);
        assert!(interpolated(&points, 1e-5).unwrap().seconds < 2.0);
        let run = |error| reached(&points, error, Times::Measured).unwrap().seconds;
        assert_eq!((run(1e-8), run(1e-5)), (100.0, 2.0));
    }
}
