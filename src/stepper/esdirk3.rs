//! An explicit first stage and three diagonally implicit ones: the method of order 3 of Kennedy & Carpenter (2003, Appl. Numer.
//! Math. 44:139, ESDIRK3(2)4L\[2\]SA). It is L-stable, and its last stage is the end of the step.
//!
//! ```text
//! v_i = v + h sum_j a_ij a_j        q_i = q + h sum_j a_ij v_j        c = 0, 2 gamma, 3/5, 1
//! ```
//!
//! gamma is the root 0.4358... of 6 gamma^3 - 18 gamma^2 + 9 gamma - 1, which makes the method L-stable; the other coefficients
//! follow from it, since every stage is of order 2. All implicit stages have the same matrix, of weights (gamma h)^2 and gamma h.
//! As with [`super::Bathe`] every stage ends in a consistent state.
//!
//! The local error is estimated by the embedded formula of order 2. The method continues with the solution of order 3.

use super::{Estimate, LocalError, Scheme, Stage, StepError, Stepper, integrate};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// `method = "esdirk3"`
pub static SCHEME: Scheme = Scheme {
    name: "esdirk3",
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(Esdirk3::new(shape)),
};

const GAMMA: f64 = 1_767_732_205_903.0 / 4_055_673_282_236.0;
const C: [f64; 4] = [0.0, 2.0 * GAMMA, 0.6, 1.0];
/// a_ij of the implicit stages.
const A: [[f64; 4]; 3] = [
    [GAMMA, GAMMA, 0.0, 0.0],
    [
        2_746_238_789_719.0 / 10_658_868_560_708.0,
        -640_167_445_237.0 / 6_845_629_431_997.0,
        GAMMA,
        0.0,
    ],
    [
        1_471_266_399_579.0 / 7_840_856_788_654.0,
        -4_482_444_167_858.0 / 7_529_755_066_697.0,
        11_266_239_266_428.0 / 11_593_286_722_821.0,
        GAMMA,
    ],
];
/// Weights of the embedded formula of order 2.
const EMBEDDED: [f64; 4] = [
    2_756_255_671_327.0 / 12_835_298_489_170.0,
    -10_771_552_573_575.0 / 22_201_958_757_719.0,
    9_247_589_265_047.0 / 10_645_013_368_117.0,
    2_193_209_047_091.0 / 5_459_859_503_100.0,
];

/// The scheme with its memory.
#[derive(Debug)]
pub struct Esdirk3 {
    /// Stages 2 and 3.
    middle: [State; 2],
    stage: Stage,
}

carried!(Esdirk3 {} but { middle, stage });

impl Esdirk3 {
    /// Memory for a system.
    pub fn new(shape: Shape) -> Esdirk3 {
        Esdirk3 {
            middle: [State::zeros(shape), State::zeros(shape)],
            stage: Stage::new(shape),
        }
    }
}

impl Stepper for Esdirk3 {
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
        let g = GAMMA * h;
        let w = Weights { q: g * g, v: g };
        let [second, third] = &mut self.middle;
        let mut clamps = 0;
        for (k, row) in A.iter().enumerate() {
            // the stages before this one; an implicit stage starts from the last of them
            let (before, now): (&[&State], &mut State) = match k {
                0 => (&[from], &mut *second),
                1 => (&[from, second], &mut *third),
                _ => (&[from, second, third], &mut *to),
            };
            now.copy_from(before[k]);
            now.t = if k == 2 { t } else { from.t + C[k + 1] * h };
            // the stages are not in the order of time
            system.prescribe(from, now, work)?;
            for i in 0..system.shape().unknowns {
                let (mut change, mut increment) = (0.0, 0.0);
                for (a, state) in row.iter().zip(before) {
                    change += a * state.a[i];
                    increment += a * state.v[i];
                }
                let v_hat = from.v[i] + h * change;
                self.stage.set(from, i, v_hat, h * increment + g * v_hat);
            }
            clamps += self.stage.solve(system, w, from, now, newton, work)?;
        }
        let [b1, b2, b3, b4] = A[2];
        to.integrals = from.integrals;
        integrate(
            h,
            &[
                (b1, &from.powers),
                (b2, &second.powers),
                (b3, &third.powers),
                (b4, &to.powers),
            ],
            &mut to.integrals,
        );
        Ok(clamps)
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: 3.0,
            is_error: false,
            implicit: true,
        }
    }

    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let [second, third] = &self.middle;
        let stages = [from, second, third, to];
        for (i, (q, v)) in error.iter_mut().enumerate() {
            (*q, *v) = (0.0, 0.0);
            for (k, state) in stages.iter().enumerate() {
                let weight = h * (A[2][k] - EMBEDDED[k]);
                *q += weight * state.v[i];
                *v += weight * state.a[i];
            }
        }
    }
}
