//! The local error of a step by what its ends say: they hold accelerations of the equations of motion, and the kinematics
//! tie q, v and a together whatever the scheme.
//!
//! ```text
//! e_v = h/2 (a + a_1) - h/12 (h^2 a'') - (v_1 - v)
//! e_q = h/2 (v + v_1) - h^2/12 (a_1 - a) - (q_1 - q)
//! ```
//!
//! is what an exact integration adds, less what the scheme has added, to order 3 (Hairer, Nørsett & Wanner 1993, Solving
//! Ordinary Differential Equations I, III.2). With the accelerations a_0 at the step before, h_0 long, a'' is the second
//! divided difference over both steps. After a contact has changed, and at the start, that would reach across a kink:
//! a_1 - a stands in for h^2 a'', too much by far for a smooth motion.

use super::LocalError;
use crate::system::{Shape, State};

/// The memory of the estimate.
#[derive(Debug)]
pub(super) struct Defect {
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
}

impl Defect {
    pub fn new(shape: Shape) -> Defect {
        Defect {
            before: Beginning::new(shape),
            last: Beginning::new(shape),
        }
    }

    /// A step begins.
    pub fn begin(&mut self, from: &State) {
        let unknowns = self.last.a.len();
        self.last.t = from.t;
        self.last.a.copy_from_slice(&from.a[..unknowns]);
        self.last.z.copy_from_slice(&from.z);
    }

    /// The step is kept.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.before, &mut self.last);
    }

    /// The error of the step that has begun last.
    pub fn local_error(&self, from: &State, to: &State, error: &mut LocalError) {
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
            let way = (to.q[i] - from.q[i]) + (to.q_low[i] - from.q_low[i]);
            *q = 0.5 * h * (from.v[i] + to.v[i]) - h * h / 12.0 * change - way;
            *v = 0.5 * h * (from.a[i] + to.a[i]) - h / 12.0 * second - (to.v[i] - from.v[i]);
        }
    }
}
