//! Time integration: a step as a short list of stages, each solved for the acceleration.

mod bathe;

pub use bathe::Bathe;

use crate::newton::{Failure, Newton};
use crate::scene::Method;
use crate::system::{INTEGRALS, PrescribeError, State, System, Work};

/// Why a step was not taken.
#[derive(Debug, Clone, PartialEq)]
pub enum StepError {
    /// A stage has no solution.
    Stage(Failure),
    /// The prescribed motion has none.
    Prescribe(PrescribeError),
}

impl From<Failure> for StepError {
    fn from(failure: Failure) -> StepError {
        StepError::Stage(failure)
    }
}

impl From<PrescribeError> for StepError {
    fn from(error: PrescribeError) -> StepError {
        StepError::Prescribe(error)
    }
}

/// An integration scheme.
pub trait Stepper: std::fmt::Debug + Send {
    /// Steps from `from` to time `t`, into `to`; contact memory is copied, never changed. Returns the number of
    /// clamped contact forces at its stages.
    ///
    /// # Errors
    /// When a stage has no solution; `to` is then undefined and `from` unchanged.
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError>;

    /// States at the stages inside the last step.
    fn interior(&self) -> &[State];
}

/// The scheme that a scene names.
pub fn stepper(method: Method, system: &dyn System) -> Box<dyn Stepper> {
    match method {
        Method::Bathe { gamma } => Box::new(Bathe::new(gamma, system.shape())),
    }
}

/// Adds the weighted integrands of some states to the integrals of the ledger.
fn integrate(h: f64, weighted: &[(f64, &[f64; INTEGRALS])], integrals: &mut [f64; INTEGRALS]) {
    for (weight, powers) in weighted {
        for (integral, power) in integrals.iter_mut().zip(*powers) {
            *integral += h * weight * power;
        }
    }
}
