//! The generalised-alpha method on position-level constraints (Arnold & Brüls 2007, Multibody Syst. Dyn. 18:185), and the
//! method of Hilber, Hughes & Taylor (1977, Earthq. Eng. Struct. Dyn. 5:283) as its member with alpha_m = 0.
//!
//! Newmark's formulas run on a mean acceleration b; the equations of motion hold for the acceleration a:
//!
//! ```text
//! (1 - alpha_m) b_1 + alpha_m b = (1 - alpha_f) a_1 + alpha_f a
//! v_1 = v + h ((1 - gamma) b + gamma b_1)
//! q_1 = q + h v + h^2 ((1/2 - beta) b + beta b_1)
//! gamma = 1/2 + alpha_f - alpha_m,   beta = (1/2 + gamma)^2 / 4
//! generalised-alpha:  alpha_m = (2 rho - 1)/(rho + 1),  alpha_f = rho/(rho + 1)
//! HHT:                alpha_m = 0,                      alpha_f = (1 - rho)/(1 + rho)
//! ```
//!
//! rho is the spectral radius at infinite frequency. b approximates the acceleration at t + (alpha_m - alpha_f) h. The scheme
//! therefore carries (b - a)/h from step to step, which keeps order two when the step changes. It starts at zero.

use super::history::History;
use super::{Estimate, LocalError, Parameter, Scheme, Stage, StepError, Stepper, integrate_ends};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Weights, Work};

/// `method = "generalized_alpha"`
pub static SCHEME: Scheme = Scheme {
    name: "generalized_alpha",
    order: 2,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[Parameter {
        name: "spectral_radius",
        range: [0.0, 1.0],
        closed: true,
        default: None,
        purpose: "the spectral radius at infinite frequency, from 0, which damps most, to 1, which damps nothing",
    }],
    build: |method, shape| {
        let rho = method.get("spectral_radius").unwrap_or(1.0);
        Box::new(GeneralizedAlpha::new(rho, shape))
    },
};

/// `method = "hht"`
pub static HHT: Scheme = Scheme {
    name: "hht",
    order: 2,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[Parameter {
        name: "spectral_radius",
        range: [0.5, 1.0],
        closed: true,
        default: None,
        purpose: "the spectral radius at infinite frequency, from 0.5, which damps most, to 1, which damps nothing",
    }],
    build: |method, shape| {
        let rho = method.get("spectral_radius").unwrap_or(1.0);
        Box::new(GeneralizedAlpha::hht(rho, shape))
    },
};

/// The scheme with its memory.
#[derive(Debug)]
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
    /// (b - a)/h at the start of the step.
    lag: Vec<f64>,
    /// The same at its end.
    next_lag: Vec<f64>,
    stage: Stage,
    history: History,
}

carried!(GeneralizedAlpha { lag, history } but { alpha_m, alpha_f, beta, gamma, next_lag, stage });

impl GeneralizedAlpha {
    /// Generalised-alpha with spectral radius `rho` in \[0, 1\].
    pub fn new(rho: f64, shape: Shape) -> GeneralizedAlpha {
        let sum = rho + 1.0;
        GeneralizedAlpha::with((2.0 * rho - 1.0) / sum, rho / sum, shape)
    }

    /// HHT with spectral radius `rho` in \[1/2, 1\].
    pub fn hht(rho: f64, shape: Shape) -> GeneralizedAlpha {
        GeneralizedAlpha::with(0.0, (1.0 - rho) / (1.0 + rho), shape)
    }

    fn with(alpha_m: f64, alpha_f: f64, shape: Shape) -> GeneralizedAlpha {
        let gamma = 0.5 + alpha_f - alpha_m;
        let zeros = vec![0.0; shape.unknowns];
        GeneralizedAlpha {
            alpha_m,
            alpha_f,
            beta: 0.25 * (0.5 + gamma).powi(2),
            gamma,
            lag: zeros.clone(),
            next_lag: zeros,
            stage: Stage::new(shape),
            history: History::new(shape),
        }
    }
}

impl Stepper for GeneralizedAlpha {
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
        let (gamma, beta) = (self.gamma, self.beta);
        let scale = 1.0 / (1.0 - self.alpha_m);
        // b_1 = scale ((1 - alpha_f) a_1 + alpha_f a - alpha_m b)
        let by_a = scale * (1.0 - self.alpha_f);
        let known = |from: &State, lag: &[f64], i: usize| {
            let mean = from.a[i] + h * lag[i];
            (
                mean,
                scale * (self.alpha_f * from.a[i] - self.alpha_m * mean),
            )
        };
        self.history.begin(from);
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..n {
            let (mean, next) = known(from, &self.lag, i);
            let v_hat = from.v[i] + h * ((1.0 - gamma) * mean + gamma * next);
            let increment = h * (from.v[i] + h * ((0.5 - beta) * mean + beta * next));
            self.stage.set(from, i, v_hat, increment);
        }
        let w = Weights {
            q: h * h * beta * by_a,
            v: h * gamma * by_a,
        };
        let clamps = self.stage.solve(system, w, from, to, newton, work)?;
        for i in 0..n {
            let (_, next) = known(from, &self.lag, i);
            self.next_lag[i] = (by_a * to.a[i] + next - to.a[i]) / h;
        }
        integrate_ends(from, to);
        Ok(clamps)
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.lag, &mut self.next_lag);
        self.history.accept();
    }

    fn estimate(&self) -> Estimate {
        Estimate::ERROR_OF_ORDER_2
    }

    fn needs_midpoint(&self, from: &State) -> bool {
        !self.history.leads_to(from)
    }

    fn local_error(&self, from: &State, to: &State, middle: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let differences = self.history.differences(from, to, middle);
        let lags = self.lag.iter().zip(&self.next_lag);
        for (((q, v), (change, second)), (lag, next)) in error.iter_mut().zip(differences).zip(lags)
        {
            // (1 - gamma) b + gamma b_1 minus the mean of a and a_1, and b_1 - b
            let mean =
                (self.gamma - 0.5) * change + h * ((1.0 - self.gamma) * lag + self.gamma * next);
            let increment = change + h * (next - lag);
            *q = h * h * ((0.5 * self.gamma - self.beta) * increment - change / 12.0);
            *v = -h * mean - h / 12.0 * second;
        }
    }
}
