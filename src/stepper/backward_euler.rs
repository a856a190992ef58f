//! The backward Euler rule, of order one: the most robust scheme and the least accurate.
//!
//! ```text
//! v_1 = v + h a_1                q_1 = q + h v_1
//! ```

use super::{StepError, Stepper, accumulate, integrate};
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// The scheme with its memory.
#[derive(Debug)]
pub struct BackwardEuler {
    q_hat: Vec<f64>,
    v_hat: Vec<f64>,
    /// q_hat - q.
    way: Vec<f64>,
}

impl BackwardEuler {
    /// Memory for a system.
    pub fn new(shape: Shape) -> BackwardEuler {
        BackwardEuler {
            q_hat: vec![0.0; shape.unknowns],
            v_hat: vec![0.0; shape.unknowns],
            way: vec![0.0; shape.unknowns],
        }
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
            self.v_hat[i] = from.v[i];
            self.way[i] = h * from.v[i];
            self.q_hat[i] = from.q[i] + self.way[i];
        }
        let w = Weights { q: h * h, v: h };
        newton.solve_stage(system, w, &self.q_hat, &self.v_hat, to, work)?;
        accumulate(from, &self.way, h * h, to);
        let clamps = newton.finish_stage(system, to, work)?;
        to.integrals = from.integrals;
        integrate(
            h,
            &[(0.5, &from.powers), (0.5, &to.powers)],
            &mut to.integrals,
        );
        Ok(clamps)
    }
}
