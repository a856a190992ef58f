//! The settings with which IDA is fastest in a study: a rival gets its best ones.

use crate::accuracy::levels;
use serde::{Deserialize, Serialize};
use studies::precision::{Times, reached};
use verify::ida_of_system::{IdaError, IdaSettings, NEWTON};

/// Largest orders of BDF, a curve each. Orders above 2 are unstable on a part of the imaginary axis, where undamped vibrations
/// are.
pub const ORDERS: [i32; 3] = [2, 3, 5];
/// Relative tolerances over the tolerance of a run, of which each study takes the best.
pub const RATIOS: [f64; 4] = [0.0, 0.1, 1.0, 10.0];
/// Tolerances; positions are held to a thousandth of a metre of that, velocities to 0.1 m/s, and both to the relative tolerance.
pub const TOLERANCES: [f64; 9] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// A run that takes longer is given up, and no tighter tolerance is tried with its settings \[s\].
pub const LONGEST: f64 = 10.0;

/// A run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Tolerance of the run.
    pub tolerance: f64,
    /// Error of position \[m\].
    pub error: f64,
    /// Processor time \[s\], of one run.
    pub seconds: f64,
}

/// The runs with the same settings, from the loosest tolerance on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriedSettings {
    /// The settings.
    pub settings: IdaSettings,
    /// Runs that reached their end.
    pub trials: Vec<Trial>,
    /// What the others said; a loose tolerance may lead where no step converges.
    pub failures: Vec<String>,
}

/// What was tried in a study with one largest order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SettingsSweep {
    /// Study.
    pub study: String,
    /// Curve that has the best settings.
    pub curve: String,
    /// All settings.
    pub tried: Vec<TriedSettings>,
    /// Index of the best.
    pub best: usize,
}

impl SettingsSweep {
    /// Tries all candidates with every tolerance, and the best of them with other tests of Newton's method.
    pub fn new(
        study: &str,
        curve: &str,
        candidates: &[IdaSettings],
        run: impl Fn(IdaSettings, f64) -> Result<Trial, IdaError>,
    ) -> SettingsSweep {
        let mut sweep = SettingsSweep {
            study: study.to_owned(),
            curve: curve.to_owned(),
            tried: Vec::new(),
            best: 0,
        };
        sweep.try_all(candidates, &run);
        let best = sweep.settings();
        let others = NEWTON.into_iter().filter(|&newton| newton != best.newton);
        let others: Vec<IdaSettings> = others
            .map(|newton| IdaSettings { newton, ..best })
            .collect();
        sweep.try_all(&others, &run);
        sweep
    }

    /// Adds runs with these settings, and chooses among all.
    fn try_all(
        &mut self,
        candidates: &[IdaSettings],
        run: &impl Fn(IdaSettings, f64) -> Result<Trial, IdaError>,
    ) {
        for &settings in candidates {
            let (mut trials, mut failures) = (Vec::new(), Vec::new());
            for tolerance in TOLERANCES {
                match run(settings, tolerance) {
                    Ok(trial) => trials.push(trial),
                    Err(error) => {
                        failures.push(format!("tolerance {tolerance:e}: {error}"));
                        if matches!(error, IdaError::TooLong(_)) {
                            break;
                        }
                    }
                }
            }
            self.tried.push(TriedSettings {
                settings,
                trials,
                failures,
            });
        }
        let curves = self.tried.iter().map(|t| {
            let points = t.trials.iter().map(|trial| [trial.error, trial.seconds]);
            points.collect()
        });
        self.best = fastest(&curves.collect::<Vec<_>>());
    }

    /// The best settings.
    pub fn settings(&self) -> IdaSettings {
        self.best().settings
    }

    /// The best settings and their runs.
    pub fn best(&self) -> &TriedSettings {
        &self.tried[self.best]
    }
}

/// Index of the curve with the least mean of ln(time / least time of all curves), over all errors that a curve comes below; one
/// that does not come below an error counts as twice the slowest that does.
fn fastest(curves: &[Vec<[f64; 2]>]) -> usize {
    let mut sums = vec![0.0; curves.len()];
    for error in levels() {
        let times = curves.iter().map(|points| {
            let found = reached(points, error, Times::Interpolated)?;
            Some(found.seconds)
        });
        let times: Vec<Option<f64>> = times.collect();
        let of = |choose: fn(f64, f64) -> f64| times.iter().flatten().copied().reduce(choose);
        let (Some(least), Some(most)) = (of(f64::min), of(f64::max)) else {
            continue;
        };
        for (sum, time) in sums.iter_mut().zip(&times) {
            *sum += (time.unwrap_or(2.0 * most) / least).ln();
        }
    }
    let sums = sums.iter().enumerate();
    let least = sums.min_by(|a, b| a.1.total_cmp(b.1));
    least.map_or(0, |(curve, _)| curve)
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, RATIOS, SettingsSweep, Trial, fastest};
    use verify::ida_of_system::{IdaError, IdaSettings, LinearSolver, NEWTON};

    #[test]
    fn the_curve_that_is_faster_at_most_errors_is_the_fastest() {
        let slow = vec![[1e-5, 2.0], [1e-12, 20.0]];
        let fast = vec![[1e-5, 1.0], [1e-12, 10.0]];
        assert_eq!(fastest(&[slow.clone(), fast.clone()]), 1);
        assert_eq!(fastest(&[fast.clone(), slow.clone()]), 0);
        // a little slower at loose errors, much faster at tight ones
        let steep = vec![[1e-5, 0.9], [1e-12, 100.0]];
        assert_eq!(fastest(&[steep, fast]), 1);
    }

    #[test]
    fn a_curve_that_ends_early_does_not_gain_by_it() {
        // both are equally fast until the first ends
        let short = vec![[1e-5, 1.0], [1e-8, 2.0]];
        let long = vec![[1e-5, 1.0], [1e-8, 2.0], [1e-12, 50.0]];
        let slow = vec![[1e-5, 5.0], [1e-12, 60.0]];
        assert_eq!(fastest(&[short.clone(), slow.clone(), long.clone()]), 2);
        assert_eq!(fastest(&[vec![], slow]), 1);
        assert_eq!(fastest(&[long, short]), 0);
    }

    #[test]
    fn a_sweep_names_its_best_settings_and_what_failed() {
        let candidates = RATIOS.map(|ratio| IdaSettings {
            max_order: 2,
            ratio,
            linear_solver: LinearSolver::Klu,
            newton: NEWTON[0],
        });
        // the second is the fastest, the third fails with loose tolerances, all others take the same
        let sweep = SettingsSweep::new("study", "curve", &candidates, |settings, tolerance| {
            if settings.ratio == RATIOS[2] && tolerance > 1e-5 {
                return Err(IdaError::Said("no step converges".to_owned()));
            }
            let factor = if settings.ratio == RATIOS[1] {
                0.5
            } else {
                1.0
            };
            let seconds = 0.4 * LONGEST * factor * tolerance.powf(-0.1);
            if seconds > LONGEST {
                return Err(IdaError::TooLong(LONGEST));
            }
            Ok(Trial {
                tolerance,
                error: 1e-3 * tolerance,
                seconds,
            })
        });
        assert_eq!(sweep.settings(), candidates[1]);
        // three loose tolerances, and one that takes too long
        assert_eq!(sweep.tried[2].failures.len(), 4);
        assert!(sweep.tried[2].failures[0].contains("1e-2"));
        // none is tighter than the first at which a run takes too long
        let last = |k: usize| sweep.tried[k].trials.last().unwrap();
        assert!(last(0).tolerance > last(1).tolerance);
        assert_eq!(sweep.tried[0].failures.len(), 1);
        let text = serde_json::to_string(&sweep).unwrap();
        assert_eq!(serde_json::from_str::<SettingsSweep>(&text).unwrap(), sweep);
    }
}
