//! The accelerations of the step before, from which schemes of order 2 estimate their local errors.
//!
//! Such a scheme adds h sum w a to the velocity with weights of its own; an exact integration adds
//!
//! ```text
//! h/2 (a + a_1) - h/12 (h^2 a'')     to v
//! h/2 (v + v_1) - h^2/12 (a_1 - a)   to q
//! ```
//!
//! to order 3 (Hairer, Nørsett & Wanner 1993, Solving Ordinary Differential Equations I, III.2). The local error is the
//! difference of the two formulas. It is not measured as a difference of what the step did to v: that would take what
//! Newton's method and the projection on the constraints leave for an error of the scheme.
//!
//! With the accelerations a_0 at the step before, h_0 long, a'' is the second divided difference over both steps. After a
//! contact has changed, and at the start, that would reach across a kink. There the acceleration a_2 that an explicit
//! extrapolation of the step finds at t + 2 h stands in for a_0.

use crate::system::{Shape, State};

/// The memory of the estimate.
#[derive(Debug)]
pub(super) struct History {
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

impl History {
    pub fn new(shape: Shape) -> History {
        History {
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

    /// True where the step before leads smoothly to a step from this state.
    pub fn leads_to(&self, from: &State) -> bool {
        from.t > self.before.t && self.before.z == from.z
    }

    /// (a_1 - a, h^2 a'') of every unknown over the step that has begun last \[m/s2\]; `ahead` holds a_2 where the step
    /// before does not lead to this one.
    pub fn differences<'a>(
        &'a self,
        from: &'a State,
        to: &'a State,
        ahead: &'a State,
    ) -> impl Iterator<Item = (f64, f64)> + 'a {
        let h = to.t - from.t;
        // a neighbour of both ends: its acceleration, how far it is from the start, and from the end of the step
        let (neighbour, t) = match self.leads_to(from) {
            true => (&self.before.a, self.before.t),
            false => (&ahead.a, ahead.t),
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
