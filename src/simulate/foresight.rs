//! How many steps an accuracy takes, found out before the run begins.
//!
//! Where steps like the first one would be too many, a trial run takes more of them. With a mean step h over the second half of
//! them, a run of duration T is foreseen to take T/h steps: the first half may lie in a transient of the start. The trial run ends
//! as soon as it foresees no more than a run may take; where it still foresees more after its last step, the run is refused. The accuracy
//! that can be afforded follows from the order k of the estimate, since the number of steps grows as the accuracy to the power -1/k.

use super::{Control, Observer, Progress, RunError, Simulation};
use crate::scene::{Accuracy, Pace};
use std::io::Result;

/// Most steps that a run may be foreseen to take: hours for a mechanism of a few bodies.
pub(super) const MOST_STEPS: f64 = 1e8;
/// Steps after which the trial run ends at the latest: seconds.
pub(super) const TRIAL_RUN_STEPS: u64 = 1 << 17;

/// Foresees the number of steps whenever the trial run has taken twice as many as the time before.
struct TrialWatch {
    steps: u64,
    /// When the trial run had taken half its steps \[s\].
    half_way: f64,
    foreseen: f64,
}

impl Observer for TrialWatch {
    fn row(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }

    fn step(&mut self, progress: &Progress) -> Result<Control> {
        self.steps += 1;
        if !self.steps.is_power_of_two() {
            return Ok(Control::Continue);
        }
        let half = (self.steps as f64 / 2.0).ceil();
        self.foreseen = half * progress.duration / (progress.t - self.half_way);
        self.half_way = progress.t;
        Ok(
            match self.foreseen > MOST_STEPS && self.steps < TRIAL_RUN_STEPS {
                true => Control::Continue,
                false => Control::Stop,
            },
        )
    }
}

/// A number of two digits, at least x.
fn rounded_up(x: f64) -> f64 {
    // 5 % more than x is at least x after rounding to two digits
    format!("{:.1e}", 1.05 * x).parse().unwrap_or(x)
}

impl Simulation {
    /// Refuses an accuracy that takes too many steps; the first of them is in `trial`.
    ///
    /// # Errors
    /// [`RunError::Unaffordable`].
    pub(super) fn foresee(&self) -> std::result::Result<(), RunError> {
        let Pace::Accuracy(accuracy) = self.scene.integrator.pace else {
            return Ok(());
        };
        let first = self.trial.t - self.state.t;
        if self.is_trial_run || self.scene.simulation.duration <= MOST_STEPS * first {
            return Ok(());
        }
        let Some((steps, name)) = self.too_many_steps(accuracy) else {
            return Ok(());
        };
        let order = self.stepper.estimate().order_of_sum();
        let factor = (steps / MOST_STEPS).powf(order);
        let affordable = Accuracy {
            position: rounded_up(factor * accuracy.position),
            energy: accuracy.energy.map(|energy| rounded_up(factor * energy)),
            horizon: accuracy.horizon,
        };
        // stability may keep the steps of an explicit method short, whatever the accuracy
        let is_affordable = self.too_many_steps(affordable).is_none();
        Err(RunError::Unaffordable {
            accuracy,
            steps,
            name,
            affordable: is_affordable.then_some(affordable),
        })
    }

    /// How many steps a trial run with this accuracy foresees, if a run may not take them, and the coordinate with the largest
    /// error.
    fn too_many_steps(&self, accuracy: Accuracy) -> Option<(f64, String)> {
        let mut scene = self.scene.clone();
        scene.integrator.pace = Pace::Accuracy(accuracy);
        let mut run = self.trial_run(&scene)?;
        let mut watch = TrialWatch {
            steps: 0,
            half_way: 0.0,
            foreseen: 0.0,
        };
        // an error on the way is that of the run, which meets it again
        let _ = run.advance(scene.simulation.duration, &mut watch);
        let too_many = watch.steps >= TRIAL_RUN_STEPS && watch.foreseen > MOST_STEPS;
        too_many.then(|| {
            let name = run.meter.worst(&run.model, &run.local_error);
            (watch.foreseen, name.to_owned())
        })
    }
}
