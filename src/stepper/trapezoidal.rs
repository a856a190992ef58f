//! The trapezoidal rule, Newmark's method with beta = 1/4 and gamma = 1/2.
//!
//! ```text
//! v_1 = v + h/2 (a + a_1)                q_1 = q + h/2 (v + v_1)
//! ```
//!
//! It damps nothing, neither the motion nor what rounding and constraints put into the highest modes: the rival that
//! Bathe's scheme was made to replace. Each step ends consistent, as those of [`super::Bathe`] do.

use super::{StepError, Stepper, accumulate, integrate};
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// The scheme with its memory.
#[derive(Debug)]
pub struct Trapezoidal {
    q_hat: Vec<f64>,
    v_hat: Vec<f64>,
    /// q_hat - q.
    way: Vec<f64>,
}

impl Trapezoidal {
    /// Memory for a system.
    pub fn new(shape: Shape) -> Trapezoidal {
        Trapezoidal {
            q_hat: vec![0.0; shape.unknowns],
            v_hat: vec![0.0; shape.unknowns],
            way: vec![0.0; shape.unknowns],
        }
    }
}

impl Stepper for Trapezoidal {
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
        let g = 0.5 * h;
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..system.shape().unknowns {
            self.v_hat[i] = from.v[i] + g * from.a[i];
            self.way[i] = g * (from.v[i] + self.v_hat[i]);
            self.q_hat[i] = from.q[i] + self.way[i];
        }
        let w = Weights { q: g * g, v: g };
        newton.solve_stage(system, w, &self.q_hat, &self.v_hat, to, work)?;
        accumulate(from, &self.way, g * g, to);
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
