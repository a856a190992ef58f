//! Why a run ends early, in words.

use super::meter::Gain;
use super::stall::Stalled;
use super::{CriticalPoint, Simulation};
use crate::compile::drive_limit::{DriveCourse, DriveLimit};
use crate::model::Model;
use crate::newton::Failure;
use crate::scene::{Accuracy, Pace};
use crate::stepper::StepError;
use crate::system::{PrescribeError, System};

/// The name of the error that is not one of a coordinate.
pub(super) const ENERGY_BALANCE: &str = "the energy balance";

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The method found no solution of the equations.
    #[error("{name}: {cause} at t = {t} s (last step tried: {} s)", short(step))]
    Physics {
        /// Coordinate or constraint.
        name: String,
        /// What happened.
        cause: String,
        /// When \[s\].
        t: f64,
        /// The last step tried \[s\].
        step: f64,
    },
    /// Even the shortest step is too long for the accuracy of the scene.
    #[error(
        "the accuracy of {accuracy} cannot be reached at t = {t} s: the estimated error of {name} is too large even with a step of \
         {} s{}; a larger `{}`, a shorter `horizon` or a method of higher order may help",
        short(step),
        if *in_singular_pose {
            ", in a singular pose, near which rounding moves the mechanism"
        } else {
            ""
        },
        if name == ENERGY_BALANCE { "energy" } else { "position" },
    )]
    Accuracy {
        /// Coordinate with the largest error, or the energy balance.
        name: String,
        /// When \[s\].
        t: f64,
        /// The last step tried \[s\].
        step: f64,
        /// The accuracy asked for.
        accuracy: Accuracy,
        /// True where the step had to pass a singular pose.
        in_singular_pose: bool,
    },
    /// The accuracy takes more steps than a run may take.
    #[error(
        "the accuracy of {accuracy} takes about {} steps for the error of {name}, more than the 1e8 that a run may take; {}",
        short(steps),
        affordable.map_or_else(
            || "so does a looser one with this method".to_owned(),
            |accuracy| format!("{accuracy} can be afforded")
        )
    )]
    Unaffordable {
        /// What was asked for.
        accuracy: Accuracy,
        /// The number of steps foreseen.
        steps: f64,
        /// Coordinate with the largest error.
        name: String,
        /// What takes fewer than 1e8 steps; `None` where stability keeps the steps of the method short.
        affordable: Option<Accuracy>,
    },
    /// The integrator has put far more energy into the motion than the scene supplies.
    #[error(
        "{name}: the method is unstable with these steps: up to t = {t} s the integrator has added {} J, \
         the scene {} J",
        short(gained),
        short(supplied)
    )]
    Unstable {
        /// Coordinate with the largest velocity.
        name: String,
        /// When \[s\].
        t: f64,
        /// Energy gained \[J\].
        gained: f64,
        /// Energy supplied: that at the start plus the work of drives, loads and weight since \[J\].
        supplied: f64,
    },
    /// The steps are so short that the run would not end.
    #[error(
        "the steps are too short for the run to end, at t = {t} s after {steps} steps: {cause}"
    )]
    Stalled {
        /// When \[s\].
        t: f64,
        /// Which joint chatters, or which coordinate makes the steps short.
        cause: String,
        /// Steps so far.
        steps: u64,
    },
    /// No equilibrium was found.
    #[error("no equilibrium at t = {t}: {name}: {cause}")]
    Equilibrium {
        /// Coordinate or constraint.
        name: String,
        /// What happened.
        cause: String,
        /// The load factor.
        t: f64,
    },
    /// The load of a static analysis cannot grow, or its equilibrium branches.
    #[error("{0}; `simulation.at_limit = \"follow\"` goes on along the path")]
    Limit(CriticalPoint),
    /// A drive has come to its limit.
    #[error("{0}")]
    DriveLimit(Box<DriveLimit>),
    /// The prescribed motion cannot be followed.
    #[error(transparent)]
    Drive(#[from] PrescribeError),
    /// The observer asked to stop.
    #[error("interrupted at t = {} s", numbers::number(*t, 6))]
    Interrupted {
        /// When \[s\].
        t: f64,
    },
    /// Results could not be stored.
    #[error("{0}")]
    Output(#[from] std::io::Error),
}

/// A mechanism with flexible links or clearance comes to the limit of the ideal one, and fails there, up to this part of the time.
const NEAR_LIMIT: f64 = 0.01;

/// A number as messages print it.
pub(super) fn short(value: &f64) -> String {
    numbers::number(*value, 2)
}

impl Simulation {
    /// The error of a row with a value that is not finite; it names the fastest coordinate.
    pub(super) fn overflown(&self, channel: &str) -> RunError {
        RunError::Physics {
            name: self.meter.fastest(&self.model, &self.state).to_owned(),
            cause: format!("{channel} is not finite: the motion grows without bound"),
            t: self.state.t,
            step: self.state.t - self.trial.t,
        }
    }

    pub(super) fn stuck(&self, name: String) -> RunError {
        let Pace::Accuracy(accuracy) = self.scene.integrator.pace else {
            unreachable!("only a run with an accuracy judges its steps")
        };
        RunError::Accuracy {
            name,
            t: self.state.t,
            step: self.trial.t - self.state.t,
            accuracy,
            in_singular_pose: self.passes_singular_pose,
        }
    }

    pub(super) fn unstable(&self, gain: Gain) -> RunError {
        RunError::Unstable {
            name: self.meter.fastest(&self.model, &self.state).to_owned(),
            t: self.state.t,
            gained: gain.gained,
            supplied: gain.supplied,
        }
    }

    pub(super) fn stalled(&self, stalled: Stalled) -> RunError {
        let halved = self.halved.iter().enumerate().max_by_key(|(_, n)| **n);
        let halved = halved.filter(|(_, n)| **n > 0);
        let step = self.state.t - self.trial.t;
        let cause = match (stalled.busiest, halved) {
            (Some((index, changes)), _) => match self.model.contacts.get(index) {
                Some(_) => {
                    let joint = self.model.contact_joint(index);
                    let joint = joint.map_or("", |j| &self.model.joints()[j].name);
                    format!("contact in {joint} was made or lost {changes} times")
                }
                None => {
                    let name = self.model.force_name(index - self.model.contacts.len());
                    format!("the force {name} changed its law {changes} times")
                }
            },
            (None, Some((index, times))) => format!(
                "for {} the step failed and was halved {times} times, down to {} s",
                self.model.unknown_name(index),
                short(&step)
            ),
            (None, None) => format!(
                "the error of {} limits the step to {} s",
                self.meter.worst(&self.model, &self.local_error),
                short(&step)
            ),
        };
        RunError::Stalled {
            t: self.state.t,
            cause,
            steps: stalled.steps,
        }
    }

    /// The error that tells why a run ends, if it ends where a drive has come to its limit.
    pub(super) fn at_limit(&self, error: RunError) -> RunError {
        let is_of_the_motion = matches!(
            error,
            RunError::Physics { .. }
                | RunError::Accuracy { .. }
                | RunError::Unstable { .. }
                | RunError::Stalled { .. }
                | RunError::Equilibrium { .. }
        );
        if self.is_trial_run || !is_of_the_motion {
            return error;
        }
        let t = self.state.t + self.pacer.scale();
        match self.drive_course() {
            DriveCourse::Limited(limit) if t >= (1.0 - NEAR_LIMIT) * limit.t => {
                RunError::DriveLimit(limit.clone())
            }
            _ => error,
        }
    }

    pub(super) fn failed(&self, error: StepError, step: f64) -> RunError {
        match error {
            StepError::Prescribe(error) => RunError::Drive(error),
            StepError::Turn { index, cause } => RunError::Physics {
                name: self.model.unknown_name(index),
                cause: cause.to_owned(),
                t: self.state.t,
                step,
            },
            StepError::Stage(failure) => {
                let (name, cause) = describe(&self.model, &failure);
                RunError::Physics {
                    name,
                    cause,
                    t: self.state.t,
                    step,
                }
            }
        }
    }
}

/// The unknown and the cause of a failure, for the message.
pub(super) fn describe(model: &Model, failure: &Failure) -> (String, String) {
    match *failure {
        Failure::NoConvergence { index, update } => (
            model.unknown_name(index),
            format!(
                "Newton's method does not converge (last update {} m/s)",
                short(&update)
            ),
        ),
        Failure::NotFinite { index } => (
            model.unknown_name(index),
            "the state is not finite".to_owned(),
        ),
        Failure::Singular { index } => (
            model.unknown_name(index),
            "the equations are singular".to_owned(),
        ),
        Failure::Falls { index } => (
            model.unknown_name(index),
            "the loads move it on and on".to_owned(),
        ),
    }
}
