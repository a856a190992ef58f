//! The trapezoidal rule, Newmark's method with beta = 1/4 and gamma = 1/2.
//!
//! ```text
//! v_1 = v + h/2 (a + a_1)                q_1 = q + h/2 (v + v_1)
//! ```
//!
//! It damps nothing, neither the motion nor what rounding and constraints put into the highest modes: the rival that
//! Bathe's scheme was made to replace. Each step ends consistent, as those of [`super::Bathe`] do.
//!
//! Its local error is -h^3/12 (q''', v''') (Hairer, Nørsett & Wanner 1993, Solving Ordinary Differential Equations I, III.2).
//! With the accelerations a_0 at the step before, h_0 long, v''' is the second divided difference of a over both steps. After
//! a contact has changed, and at the start, that would reach across a kink: h v'' = a_1 - a stands in for h^2 v''', too much
//! by far for a smooth motion.

use super::{Estimate, LocalError, Stage, StepError, Stepper, integrate_ends};
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// The scheme with its memory.
#[derive(Debug)]
pub struct Trapezoidal {
    stage: Stage,
    /// Where the step before the last began.
    before: Beginning,
    /// Where the last step began.
    last: Beginning,
}

/// What is remembered of the beginning of a step.
#[derive(Debug)]
struct Beginning {
    t: f64,
    a: Vec<f64>,
    z: Vec<f64>,
}

impl Beginning {
    fn new(shape: Shape) -> Beginning {
        Beginning {
            t: f64::NAN,
            a: vec![0.0; shape.unknowns],
            z: vec![0.0; shape.contacts],
        }
    }

    fn set(&mut self, from: &State) {
        self.t = from.t;
        let unknowns = self.a.len();
        self.a.copy_from_slice(&from.a[..unknowns]);
        self.z.copy_from_slice(&from.z);
    }
}

impl Trapezoidal {
    /// Memory for a system.
    pub fn new(shape: Shape) -> Trapezoidal {
        Trapezoidal {
            stage: Stage::new(shape),
            before: Beginning::new(shape),
            last: Beginning::new(shape),
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
        self.last.set(from);
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
        std::mem::swap(&mut self.before, &mut self.last);
    }

    fn estimate(&self) -> Option<Estimate> {
        Some(Estimate {
            order: 3.0,
            is_error: true,
        })
    }

    fn local_error(&self, from: &State, to: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let h_0 = from.t - self.before.t;
        let smooth = h_0 > 0.0 && self.before.z == from.z;
        for (i, (q, v)) in error.q.iter_mut().zip(&mut error.v).enumerate() {
            let change = to.a[i] - from.a[i];
            let second = match smooth {
                true => {
                    let bend = change / h - (from.a[i] - self.before.a[i]) / h_0;
                    2.0 * h * h * bend / (h + h_0)
                }
                false => change,
            };
            *q = -h * h / 12.0 * change;
            *v = -h / 12.0 * second;
        }
    }
}
