//! Velocity Verlet (Swope, Andersen, Berens & Wilson 1982, J. Chem. Phys. 76:637): explicit, one evaluation a step, for
//! mechanisms without constraint rows.
//!
//! ```text
//! q_1 = q + h v + h^2/2 a                a_1 = a(q_1, w_1)                v_1 = v + h/2 (a + a_1)
//! ```
//!
//! Forces that depend on velocities are evaluated with the predicted velocity
//!
//! ```text
//! w_1 = v + h a + h^2/2 a'               a' = (a - a_-2)/(t - t_-2)
//! ```
//!
//! with the acceleration two steps back. Its error of h^3 changes v_1 by h^4 only. Without a', a_1 would miss h^2/2 (da/dv) a', and
//! so would the a of the next step: together h^3/2 (da/dv) a' in v, more than the rest of the local error, h^3/12 a''. The
//! difference over two steps, unlike one over the last step, is zero for an acceleration that alternates from step to step, so that
//! it leaves the largest stable step as it is without a'. Where no smooth step leads to a state there is no a'. There w_1 is v + h a
//! at first and v_1 in a second evaluation.
//!
//! Without forces that depend on velocities the scheme is symplectic. It is stable while h omega < 2 ((1 + 4 zeta^2)^(1/2) - 2 zeta)
//! in every mode, of damping ratio zeta.
//!
//! Its local error is h^3/6 q''' of the position and -h^3/12 v''' of the velocity.

use super::history::History;
use super::{Estimate, LocalError, Scheme, StepError, Stepper, accumulate, integrate_ends};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Work};

/// `method = "velocity_verlet"`
pub static SCHEME: Scheme = Scheme {
    name: "velocity_verlet",
    order: 2,
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
        let (earliest, t_earliest) = self.history.earliest(from);
        let reach = 0.5 * h * h / (from.t - t_earliest);
        for i in 0..n {
            let (v, a) = (from.v[i], from.a[i]);
            self.increment[i] = h * (v + 0.5 * h * a);
            to.v[i] = v + h * a + reach * (a - earliest[i]);
        }
        let increments = self.increment.iter().copied();
        accumulate(from, increments, &mut to.q, &mut to.q_low);
        let evaluations = if self.history.leads_to(from) { 1 } else { 2 };
        for _ in 0..evaluations {
            newton.accelerate(system, to, work)?;
            for i in 0..n {
                to.v[i] = from.v[i] + 0.5 * h * (from.a[i] + to.a[i]);
            }
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

    fn needs_midpoint(&self, from: &State) -> bool {
        !self.history.leads_to(from)
    }

    fn local_error(&self, from: &State, to: &State, middle: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let differences = self.history.differences(from, to, middle);
        for ((q, v), (change, second)) in error.iter_mut().zip(differences) {
            // the integral of (t_1 - t) (a(t) - a) over the parabola through the three accelerations
            *q = h * h * (change / 6.0 - second / 24.0);
            *v = -h / 12.0 * second;
        }
    }
}
