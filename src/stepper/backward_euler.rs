//! The backward Euler rule, of order one: the most robust scheme and the least accurate.
//!
//! ```text
//! v_1 = v + h a_1                q_1 = q + h v_1
//! ```

use super::{Stage, StepError, Stepper, integrate_ends};
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// The scheme with its memory.
#[derive(Debug)]
pub struct BackwardEuler(Stage);

impl BackwardEuler {
    /// Memory for a system.
    pub fn new(shape: Shape) -> BackwardEuler {
        BackwardEuler(Stage::new(shape))
    }
}

impl Stepper for BackwardEuler {
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError> {
        let h = t - from.t;
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..system.shape().unknowns {
            self.0.set(from, i, from.v[i], h * from.v[i]);
        }
        let w = Weights { q: h * h, v: h };
        let clamps = self.0.solve(system, w, from, to, newton, work)?;
        integrate_ends(from, to);
        Ok(clamps)
    }
}
