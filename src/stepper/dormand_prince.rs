//! The explicit Runge-Kutta pair of orders 5 and 4 of Dormand & Prince (1980, J. Comput. Appl. Math. 6:19).
//!
//! Applied to y = (q, v) with seven stages Y_i = y + h sum_j a_ij F_j, F = (V, A). The last stage is the end of the step and
//! the first stage of the next. A_i is the solution of the acceleration level at (Q_i, V_i). With constraint rows this reduces
//! the index, and every step ends with a projection of q on Phi = 0 and of v on Phi_q v + Phi_t = 0 (Eich 1993, SIAM J. Numer.
//! Anal. 30:1467), which keeps the order.
//!
//! The local error is the difference of the two solutions, of order h^5. The step continues with the solution of order 5.

use super::{
    Estimate, EstimatedSolution, LocalError, Scheme, StepError, Stepper, accumulate, add,
    integrate, sum,
};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Work};

/// c_i and a_ij of stages 2 to 6.
const STAGES: [(f64, [f64; 5]); 5] = [
    (1.0 / 5.0, [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0]),
    (3.0 / 10.0, [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0]),
    (4.0 / 5.0, [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0]),
    (
        8.0 / 9.0,
        [
            19372.0 / 6561.0,
            -25360.0 / 2187.0,
            64448.0 / 6561.0,
            -212.0 / 729.0,
            0.0,
        ],
    ),
    (
        1.0,
        [
            9017.0 / 3168.0,
            -355.0 / 33.0,
            46732.0 / 5247.0,
            49.0 / 176.0,
            -5103.0 / 18656.0,
        ],
    ),
];

/// Weights of stages 1 to 6 at the end of the step.
const WEIGHTS: [f64; 6] = [
    35.0 / 384.0,
    0.0,
    500.0 / 1113.0,
    125.0 / 192.0,
    -2187.0 / 6784.0,
    11.0 / 84.0,
];

/// Weights of order 5 minus those of order 4, stages 1 to 7.
const DIFFERENCE: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// `method = "dormand_prince"`
pub static SCHEME: Scheme = Scheme {
    name: "dormand_prince",
    is_explicit: true,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(DormandPrince::new(shape)),
};

/// The scheme with its memory.
#[derive(Debug)]
pub struct DormandPrince {
    /// Stages 2 to 6.
    stages: [State; 5],
    /// Changes of q or v.
    increment: Vec<f64>,
}

carried!(DormandPrince {} but { stages, increment });

impl DormandPrince {
    /// Memory for a system.
    pub fn new(shape: Shape) -> DormandPrince {
        DormandPrince {
            stages: std::array::from_fn(|_| State::zeros(shape)),
            increment: vec![0.0; shape.unknowns],
        }
    }
}

impl Stepper for DormandPrince {
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError> {
        let shape = system.shape();
        let h = t - from.t;
        let mut clamps = 0;
        for (i, (c, row)) in STAGES.iter().enumerate() {
            let (done, rest) = self.stages.split_at_mut(i);
            let stage = &mut rest[0];
            stage.copy_memory(from);
            stage.t = if *c == 1.0 { t } else { from.t + c * h };
            system.prescribe(from, stage, work)?;
            let before = || [from].into_iter().chain(&*done);
            sum(h, *row, before(), |s| &s.v, &mut self.increment);
            let low = from.q_low.iter().zip(&self.increment);
            for (q, (start, (low, change))) in stage.q.iter_mut().zip(from.q.iter().zip(low)) {
                *q = start + (low + change);
            }
            sum(h, *row, before(), |s| &s.a, &mut self.increment);
            add(&from.v, &self.increment, &mut stage.v);
            newton.accelerate(system, stage, work)?;
            if WEIGHTS[i + 1] != 0.0 {
                clamps += system.powers(stage, work);
            }
        }
        let stages = &self.stages;
        to.copy_memory(from);
        to.t = t;
        // the known coordinates of the last stage are those of the end
        to.copy_known(&stages[4]);
        let all = || [from].into_iter().chain(stages);
        sum(h, WEIGHTS, all(), |s| &s.a, &mut self.increment);
        add(&from.v, &self.increment, &mut to.v);
        sum(h, WEIGHTS, all(), |s| &s.v, &mut self.increment);
        accumulate(from, &self.increment, 0.0, to);
        if shape.multipliers > 0 {
            newton.return_to_constraints(system, to, work)?;
        } else {
            newton.accelerate(system, to, work)?;
        }
        clamps += system.powers(to, work);
        to.integrals = from.integrals;
        integrate(h, &[(WEIGHTS[0], &from.powers)], &mut to.integrals);
        for (weight, stage) in WEIGHTS[1..].iter().zip(stages) {
            integrate(h, &[(*weight, &stage.powers)], &mut to.integrals);
        }
        Ok(clamps)
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: 5.0,
            of: EstimatedSolution::Embedded { weight: 1.0 },
            implicit: false,
        }
    }

    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let all = || [from].into_iter().chain(&self.stages).chain([to]);
        sum(h, DIFFERENCE, all(), |s| &s.v, &mut error.q);
        sum(h, DIFFERENCE, all(), |s| &s.a, &mut error.v);
    }
}
