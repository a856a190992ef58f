//! Velocity Verlet (Swope, Andersen, Berens & Wilson 1982, J. Chem. Phys. 76:637): explicit, one evaluation a step, for
//! mechanisms without constraint rows.
//!
//! ```text
//! q_1 = q + h v + h^2/2 a                a_1 = a(q_1, v + h a)                v_1 = v + h/2 (a + a_1)
//! ```
//!
//! Forces that depend on velocities are evaluated with the predicted velocity; its error of h^2 keeps order two. Without such
//! forces the scheme is symplectic. It is stable while h omega < 2 in every mode.

use super::history::History;
use super::{Estimate, LocalError, Scheme, StepError, Stepper, accumulate, integrate_ends};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Work};

/// `method = "velocity_verlet"`
pub static SCHEME: Scheme = Scheme {
    name: "velocity_verlet",
    is_explicit: true,
    keeps_constraints: false,
    parameters: &[],
    build: |_, shape| Box::new(VelocityVerlet::new(shape)),
};

/// The scheme.
#[derive(Debug)]
pub struct VelocityVerlet {
    /// q_1 - q.
    increment: Vec<f64>,
    history: History,
}

carried!(VelocityVerlet { history } but { increment });

impl VelocityVerlet {
    /// Memory for a system.
    pub fn new(shape: Shape) -> VelocityVerlet {
        VelocityVerlet {
            increment: vec![0.0; shape.unknowns],
            history: History::new(shape),
        }
    }
}

impl Stepper for VelocityVerlet {
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError> {
        let n = system.shape().unknowns;
        let h = t - from.t;
        self.history.begin(from);
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..n {
            self.increment[i] = h * (from.v[i] + 0.5 * h * from.a[i]);
            to.v[i] = from.v[i] + h * from.a[i];
        }
        accumulate(from, &self.increment, 0.0, to);
        newton.accelerate(system, to, work)?;
        for i in 0..n {
            to.v[i] = from.v[i] + 0.5 * h * (from.a[i] + to.a[i]);
        }
        let clamps = system.powers(to, work);
        integrate_ends(from, to);
        Ok(clamps)
    }

    fn accept(&mut self) {
        self.history.accept();
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            implicit: false,
            ..Estimate::ERROR_OF_ORDER_2
        }
    }

    fn looks_ahead(&self, from: &State) -> bool {
        !self.history.leads_to(from)
    }

    fn local_error(&self, from: &State, to: &State, ahead: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let differences = self.history.differences(from, to, ahead);
        for ((q, v), (change, second)) in error.iter_mut().zip(differences) {
            *q = h * h / 6.0 * change;
            *v = -h / 12.0 * second;
        }
    }
}
