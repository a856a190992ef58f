//! The accelerations of previous steps, from which schemes of order 1 and 2 estimate their local errors.
//!
//! Such a scheme adds h sum w a to the velocity, with its own weights w. To order 3, exact integration adds
//!
//! ```text
//! h/2 (a + a_1) - h/12 (h^2 a'')     to v
//! h/2 (v + v_1) - h^2/12 (a_1 - a)   to q
//! ```
//!
//! (Hairer, Nørsett & Wanner 1993, Solving Ordinary Differential Equations I, III.2). The local error is the difference of the
//! two formulas. It is not computed from the change of v in the step, which also contains the residual of Newton's method
//! and the projection on the constraints.
//!
//! a'' is the second divided difference over this step and the previous one, of length h_0, at whose beginning the
//! acceleration was a_0. At the start, and after a change of memory, there is no smooth previous step. There the
//! acceleration in the middle of the step ([`super::midpoint`]) replaces a_0, and the first formula is Simpson's rule. It holds at
//! an onset, too, where accelerations grow as t^1.5 and a'' is infinite: the error of the trapezoidal rule, h a_1/10, is
//! estimated as (2^1.5 - 2)/(3 2^1.5) h a_1 = 0.098 h a_1.

use crate::checkpoint::carried;
use crate::system::{Shape, State};

/// The memory of the estimate.
#[derive(Debug)]
pub(super) struct History {
    /// Beginning of the step before the previous one.
    earlier: Beginning,
    /// Beginning of the previous step.
    before: Beginning,
    /// Beginning of the present step.
    last: Beginning,
}

carried!(History { earlier, before, last } but {});

/// Values at the beginning of a step.
#[derive(Debug)]
struct Beginning {
    t: f64,
    a: Vec<f64>,
    /// Changes of memory before it.
    changes: u64,
}

carried!(Beginning { t, a, changes } but {});

impl Beginning {
    fn new(shape: Shape) -> Beginning {
        Beginning {
            t: f64::NAN,
            a: vec![0.0; shape.unknowns],
            changes: 0,
        }
    }
}

impl History {
    pub fn new(shape: Shape) -> History {
        History {
            earlier: Beginning::new(shape),
            before: Beginning::new(shape),
            last: Beginning::new(shape),
        }
    }

    /// A step begins.
    pub fn begin(&mut self, from: &State) {
        let unknowns = self.last.a.len();
        self.last.t = from.t;
        self.last.a.copy_from_slice(&from.a[..unknowns]);
        self.last.changes = from.changes;
    }

    /// The step is kept.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.earlier, &mut self.before);
        std::mem::swap(&mut self.before, &mut self.last);
    }

    /// True if the previous step leads to this state without a change of memory.
    pub fn leads_to(&self, from: &State) -> bool {
        from.t > self.before.t && self.before.changes == from.changes
    }

    /// Accelerations at the earliest time from which at most two smooth steps lead to this state, and that time; the state itself
    /// and a time long ago if there is none.
    pub fn earliest<'a>(&'a self, from: &'a State) -> (&'a [f64], f64) {
        let Beginning { t, changes, .. } = &self.earlier;
        if !self.leads_to(from) {
            (&from.a, f64::NEG_INFINITY)
        } else if self.before.t > *t && self.before.changes == *changes {
            (&self.earlier.a, *t)
        } else {
            (&self.before.a, self.before.t)
        }
    }

    /// (a_1 - a, h^2 a'') of every unknown over the present step \[m/s2\]; `middle` is that of the step if the previous step
    /// does not lead to this one.
    pub fn differences<'a>(
        &'a self,
        from: &'a State,
        to: &'a State,
        middle: &'a State,
    ) -> impl Iterator<Item = (f64, f64)> + 'a {
        let h = to.t - from.t;
        // the third point: its acceleration, and its distance in time from the start and from the end of the step
        let (neighbour, t) = match self.leads_to(from) {
            true => (&self.before.a, self.before.t),
            false => (&middle.a, middle.t),
        };
        let (to_start, to_end) = (from.t - t, to.t - t);
        let accelerations = neighbour.iter().zip(&from.a).zip(&to.a);
        accelerations.map(move |((other, a), a_1)| {
            let change = a_1 - a;
            let bend = change / h - (a - other) / to_start;
            (change, 2.0 * h * h * bend / to_end)
        })
    }
}
