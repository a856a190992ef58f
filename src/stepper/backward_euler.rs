//! The backward Euler rule, of order one: the most robust scheme and the least accurate.
//!
//! ```text
//! v_1 = v + h a_1                q_1 = q + h v_1
//! ```

use super::history::History;
use super::{
    Estimate, EstimatedSolution, LocalError, Scheme, Stage, StepError, Stepper, integrate_ends,
};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// `method = "backward_euler"`
pub static SCHEME: Scheme = Scheme {
    name: "backward_euler",
    order: 1,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(BackwardEuler::new(shape)),
};

/// The scheme with its memory.
#[derive(Debug)]
pub struct BackwardEuler {
    stage: Stage,
    history: History,
}

carried!(BackwardEuler { history } but { stage });

impl BackwardEuler {
    /// Memory for a system.
    pub fn new(shape: Shape) -> BackwardEuler {
        BackwardEuler {
            stage: Stage::new(shape),
            history: History::new(shape),
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
        newton.begin_step(from);
        let h = t - from.t;
        self.history.begin(from);
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..system.shape().unknowns {
            self.stage.set(from, i, from.v[i], h * from.v[i]);
        }
        let w = Weights { q: h * h, v: h };
        let clamps = self.stage.solve(system, w, from, to, newton, work)?;
        integrate_ends(from, to);
        Ok(clamps)
    }

    fn accept(&mut self) {
        self.history.accept();
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: 2.0,
            of: EstimatedSolution::Solution,
            implicit: true,
        }
    }

    fn needs_midpoint(&self, from: &State) -> bool {
        !self.history.leads_to(from)
    }

    fn local_error(&self, from: &State, to: &State, middle: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let differences = self.history.differences(from, to, middle);
        let velocities = from.v.iter().zip(&to.v);
        for (((q, v), (change, second)), (v_0, v_1)) in
            error.iter_mut().zip(differences).zip(velocities)
        {
            *q = -0.5 * h * (v_1 - v_0) - h * h / 12.0 * change;
            *v = -0.5 * h * change - h / 12.0 * second;
        }
    }
}
