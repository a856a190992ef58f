//! The backward Euler rule, of order one: the most robust scheme and the least accurate.
//!
//! ```text
//! v_1 = v + h a_1                q_1 = q + h v_1
//! ```

use super::defect::Defect;
use super::{Estimate, LocalError, Stage, StepError, Stepper, integrate_ends};
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// The scheme with its memory.
#[derive(Debug)]
pub struct BackwardEuler {
    stage: Stage,
    defect: Defect,
}

impl BackwardEuler {
    /// Memory for a system.
    pub fn new(shape: Shape) -> BackwardEuler {
        BackwardEuler {
            stage: Stage::new(shape),
            defect: Defect::new(shape),
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
        self.defect.begin(from);
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
        self.defect.accept();
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: 2.0,
            is_error: true,
        }
    }

    fn local_error(&self, from: &State, to: &State, error: &mut LocalError) {
        self.defect.local_error(from, to, error);
    }
}
