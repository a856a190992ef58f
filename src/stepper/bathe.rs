//! Bathe's two-sub-step scheme (Bathe 2007, Comput. Struct. 85:437), with spectral radius rho at infinite frequency (Noh &
//! Bathe 2019, Comput. Struct. 212:299); rho = 0 is the scheme of the paper.
//!
//! First sub-step of length gamma h, trapezoidal rule; second, a three-point formula:
//!
//! ```text
//! v_g = v + gamma h/2 (a + a_g)                q_g = q + gamma h/2 (v + v_g)
//! v_1 = v + h (c0 a + c1 a_g + c2 a_1)         q_1 = q + h (c0 v + c1 v_g + c2 v_1)
//! c1 = (1 + rho)/(4 - 2 gamma (1 - rho)),  c0 = (gamma - 1) c1 + 1/2,  c2 = 1/2 - gamma c1
//! ```
//!
//! For gamma = 1/2 and rho = 0 all c are 1/3. Both sub-steps are affine in the acceleration, q = q_hat + g^2 a and
//! v = v_hat + g a, with g = gamma h/2 in the first and c2 h in the second. The unknown is a: differencing q would bring
//! rounding of eps |q|/h into v and eps |q|/h^2 into a.
//!
//! On the position level of a constrained system the stage's multipliers and constrained accelerations are of order one
//! and contain the rounding of Phi divided by g^2. Every stage therefore ends with a projection of v on Phi_q v + Phi_t = 0
//! and an acceleration-level solve. The next stage and the recorded rows use this consistent state, which is of order two.
//!
//! The local error is the difference between the scheme and the quadrature with weights w at the same three points that is
//! exact for quadratic integrands, as in Hosea & Shampine (1996, Appl. Numer. Math. 20:21) for gamma = 2 - sqrt 2, where the
//! scheme is TR-BDF2:
//! e_v = h sum (w - c) a, e_q = h sum (w - c) v, both of h^3.

use super::{
    Estimate, LocalError, Method, Parameter, Scheme, Stage, StepError, Stepper, integrate,
};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// `method = "bathe"`
pub static SCHEME: Scheme = Scheme {
    name: "bathe",
    order: 2,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[
        Parameter {
            name: "gamma",
            range: [0.0, 1.0],
            closed: false,
            default: Some(
                "0.5; with a `spectral_radius` rho below 1 (2 - sqrt(2 + 2 rho))/(1 - rho), for which both stages have the same matrix",
            ),
            purpose: "of `\"bathe\"`: the first sub-step over the step, between 0 and 1, both excluded",
        },
        Parameter {
            name: "spectral_radius",
            range: [0.0, 1.0],
            closed: true,
            default: Some("required, but 0 for `\"bathe\"`"),
            purpose: "of `\"bathe\"`, `\"generalized_alpha\"` (0 to 1) and `\"hht\"` (0.5 to 1): the spectral radius at infinite frequency: 1 is without damping, the smallest value damps most",
        },
    ],
    build: |method, shape| {
        let rho = method.get("spectral_radius").unwrap_or(0.0);
        Box::new(Bathe::new(splitting(method), rho, shape))
    },
};

/// gamma of this method: 1/2 unless `gamma` or a spectral radius is given. With a spectral radius alone both sub-steps have the
/// same stage matrix (Noh & Bathe 2019): gamma = (2 - sqrt(2 + 2 rho))/(1 - rho), 1/2 at rho = 1.
pub fn splitting(method: &Method) -> f64 {
    let optimal = |rho: f64| {
        // the same without a difference of nearly equal numbers
        2.0 / (2.0 + (2.0 + 2.0 * rho).sqrt())
    };
    let by_radius = || method.get("spectral_radius").map(optimal);
    method.get("gamma").or_else(by_radius).unwrap_or(0.5)
}

/// The scheme with its memory.
#[derive(Debug)]
pub struct Bathe {
    gamma: f64,
    weights: [f64; 3],
    /// Weights of the ledger at 0, gamma, 1: exact for quadratic integrands.
    quadrature: [f64; 3],
    middle: [State; 1],
    stage: Stage,
}

carried!(Bathe {} but { gamma, weights, quadrature, middle, stage });

impl Bathe {
    /// The scheme with splitting `gamma` in (0, 1) and spectral radius `rho` in \[0, 1\].
    pub fn new(gamma: f64, rho: f64, shape: Shape) -> Bathe {
        let c1 = (1.0 + rho) / (4.0 - 2.0 * gamma * (1.0 - rho));
        let inner = 1.0 / (6.0 * gamma * (1.0 - gamma));
        let last = 0.5 - gamma * inner;
        let weights = [(gamma - 1.0) * c1 + 0.5, c1, 0.5 - gamma * c1];
        Bathe {
            gamma,
            weights,
            quadrature: [1.0 - inner - last, inner, last],
            middle: [State::zeros(shape)],
            stage: Stage::new(shape),
        }
    }
}

impl Stepper for Bathe {
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
        let n = system.shape().unknowns;
        let h = t - from.t;
        let [middle] = &mut self.middle;

        let g = 0.5 * self.gamma * h;
        middle.copy_from(from);
        middle.t = from.t + self.gamma * h;
        system.prescribe(from, middle, work)?;
        for i in 0..n {
            let v_hat = from.v[i] + g * from.a[i];
            self.stage.set(from, i, v_hat, g * (from.v[i] + v_hat));
        }
        let w = Weights { q: g * g, v: g };
        let mut clamps = self.stage.solve(system, w, from, middle, newton, work)?;

        let [c0, c1, c2] = self.weights;
        let g = c2 * h;
        to.copy_from(middle);
        to.t = t;
        system.prescribe(middle, to, work)?;
        for i in 0..n {
            let v_hat = from.v[i] + h * (c0 * from.a[i] + c1 * middle.a[i]);
            let increment = h * (c0 * from.v[i] + c1 * middle.v[i] + c2 * v_hat);
            self.stage.set(from, i, v_hat, increment);
        }
        let w = Weights { q: g * g, v: g };
        clamps += self.stage.solve(system, w, from, to, newton, work)?;

        let [w0, w1, w2] = self.quadrature;
        to.integrals.copy_from_slice(&from.integrals);
        integrate(
            h,
            &[(w0, &from.powers), (w1, &middle.powers), (w2, &to.powers)],
            &mut to.integrals,
        );
        Ok(clamps)
    }

    fn interior(&self) -> &[State] {
        &self.middle
    }

    fn estimate(&self) -> Estimate {
        Estimate::ERROR_OF_ORDER_2
    }

    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let [middle] = &self.middle;
        let [e0, e1, e2] = std::array::from_fn(|i| h * (self.quadrature[i] - self.weights[i]));
        for (i, (q, v)) in error.q.iter_mut().zip(&mut error.v).enumerate() {
            *q = e0 * from.v[i] + e1 * middle.v[i] + e2 * to.v[i];
            *v = e0 * from.a[i] + e1 * middle.a[i] + e2 * to.a[i];
        }
    }
}
