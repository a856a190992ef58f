//! The trapezoidal rule, Newmark's method with beta = 1/4 and gamma = 1/2.
//!
//! ```text
//! v_1 = v + h/2 (a + a_1)                q_1 = q + h/2 (v + v_1)
//! ```
//!
//! It has no numerical damping, neither of the motion nor of what rounding and constraints excite in the highest modes. Bathe's
//! scheme was made to replace it. Each step ends in a consistent state, as with [`super::Bathe`].
//!
//! Its local error is -h^3/12 (q''', v''').

use super::history::History;
use super::{Estimate, LocalError, Scheme, Stage, StepError, Stepper, integrate_ends};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// `method = "trapezoidal"`
pub static SCHEME: Scheme = Scheme {
    name: "trapezoidal",
    order: 2,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(Trapezoidal::new(shape)),
};

/// The scheme with its memory.
#[derive(Debug)]
pub struct Trapezoidal {
    stage: Stage,
    history: History,
}

carried!(Trapezoidal { history } but { stage });

impl Trapezoidal {
    /// Memory for a system.
    pub fn new(shape: Shape) -> Trapezoidal {
        Trapezoidal {
            stage: Stage::new(shape),
            history: History::new(shape),
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
        newton.begin_step(from);
        let h = t - from.t;
        let g = 0.5 * h;
        self.history.begin(from);
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..system.shape().unknowns {
            let v_hat = from.v[i] + g * from.a[i];
            self.stage.set(from, i, v_hat, g * (from.v[i] + v_hat));
        }
        let w = Weights { q: g * g, v: g };
        let clamps = self.stage.solve(system, w, from, to, newton, work)?;
        integrate_ends(from, to);
        Ok(clamps)
    }

    fn accept(&mut self) {
        self.history.accept();
    }

    fn estimate(&self) -> Estimate {
        Estimate::ERROR_OF_ORDER_2
    }

    fn needs_midpoint(&self, from: &State) -> bool {
        !self.history.leads_to(from)
    }

    fn local_error(&self, from: &State, to: &State, middle: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let differences = self.history.differences(from, to, middle);
        for ((q, v), (change, second)) in error.iter_mut().zip(differences) {
            *q = -h * h / 12.0 * change;
            *v = -h / 12.0 * second;
        }
    }
}
