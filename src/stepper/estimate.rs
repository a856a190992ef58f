//! What the estimate of a local error says about the error of the run.
//!
//! A method multiplies the amplitude of a vibration of angular frequency w \[rad/s\] by R(i theta) in a step of length h, with
//! theta = w h. The error of a step is c = |R(i theta) - exp(i theta)| of the amplitude, and the estimate of an embedded solution
//! is c^ of it, the difference of the two solutions. To leading order
//!
//! ```text
//! c ~ C theta^(k+1),   c^ ~ (C/kappa) theta^k
//! ```
//!
//! with the order k of the estimate ([`Vibration`]). The errors of N steps are in phase and add up to N c of the amplitude, but
//! never to more than twice the amplitude. An estimate e of the error of velocity therefore stands for an error of position of
//!
//! ```text
//! (e/w) min(N c, 2)/c^,   which is kappa H e below theta_1 = (2/(N C))^(1/(k+1)),   H = N h
//! ```
//!
//! and falls beyond. An error that other motions force on the mode keeps its direction while the mode turns: such errors add up to
//! between 0 and 2 e/(w theta), in place of N e/w; the mean, e/(w theta), counts.

use crate::newton::ResponseTerm;

/// Properties of an estimate of the local error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The power of the step with which the estimate falls.
    pub order: f64,
    /// Whose error it is.
    pub of: EstimatedSolution,
    /// True for a scheme with implicit stages, which is stable for stiff modes that its steps do not resolve.
    pub implicit: bool,
}

/// The solution whose local error is estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EstimatedSolution {
    /// The one with which the scheme continues.
    Solution,
    /// One or two embedded ones of lower orders.
    Embedded {
        /// The error of the solution for a given estimate, as a multiple of that of [`super::dormand_prince::SCHEME`]: the ratio of
        /// the principal error of the solution to the estimate, by norms of error coefficients of all trees (Prince & Dormand 1981,
        /// J. Comput. Appl. Math. 7:67), divided by the same ratio of Dormand and Prince's pair, 0.337.
        weight: f64,
        /// Its errors in a vibration.
        vibration: Vibration,
    },
}

/// The error of a step in a vibration that turns by theta \[rad\] a step, to leading order in theta. The errors of N steps add up,
/// until they reach twice the amplitude: below theta_1 = (2/(N C))^(1/(k+1)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    /// C: the error of a step over theta^(k+1) times the amplitude.
    pub error: f64,
    /// kappa: that error over theta times the estimate.
    pub ratio: f64,
}

/// Ratio of neighbouring times of the response to errors of a solution.
const RATIO: f64 = 0.1;
/// The response to the estimate of an embedded solution begins to fall at this multiple of theta_1. For 1000 steps a horizon and
/// more it then stays above 0.4 of (e/w) min(N c, 2)/c^ for all theta up to 3.5 for which the method is stable; the error of q, which
/// a vibration has as well, is counted beside it.
const OF_RESOLVED: f64 = 2.0;

impl Estimate {
    /// The estimate of a scheme of order 2 which continues with the solution that it estimates.
    pub(super) const ERROR_OF_ORDER_2: Estimate = Estimate {
        order: 3.0,
        of: EstimatedSolution::Solution,
        implicit: true,
    };

    /// The step by which the steps of a horizon are counted, for one of length h among others of this mean length.
    ///
    /// A step has the error c h^k, where c varies along the motion. A unit of time has 1/h steps with the errors c h^(k-1). A given
    /// sum of errors takes the fewest steps if the derivatives of these two by h have the same ratio everywhere, that is, if all steps
    /// have the same error c h^k. So a step is judged by its error times the number of steps, and not by its error over its length.
    ///
    /// The estimate of an embedded solution is counted with its own step: after an onset, where the force grows as t^1.5, steps are
    /// short, and the solution is hardly more accurate than its estimate.
    pub fn typical_step(&self, h: f64, mean: f64) -> f64 {
        match self.of {
            EstimatedSolution::Solution => mean,
            EstimatedSolution::Embedded { .. } => h,
        }
    }

    /// The multiple of its estimate that the error of the solution reaches in so many steps.
    pub fn sum(&self, steps: f64) -> f64 {
        match self.of {
            EstimatedSolution::Solution => steps,
            EstimatedSolution::Embedded { weight, .. } => weight * steps.sqrt(),
        }
    }

    /// The displacement of an elastic mechanism within a horizon H \[s\] by steps of length h \[s\], each with the error of
    /// velocity e, of which a horizon has N.
    ///
    /// The errors of the solution add up to N y, where y is the distance by which one of them moves the mechanism, min(H, 1/w) e in
    /// a mode of angular frequency w:
    ///
    /// ```text
    /// y = (W^2 + 1/H^2)^(-1/2) e ~ H x_0 + sum_j 2 tau_j x_j,   x_j = (1 + tau_j^2 W^2)^(-1) e,   tau_j = H/10^j >= h
    /// ```
    ///
    /// For a mode slower than the last tau this is between 1.0 and 1.5 times min(H, 1/w) e.
    ///
    /// An estimate of an embedded solution stands for two kinds of errors of a vibration: forced ones, which are bounded by those of
    /// free flight, F = H times [`Estimate::sum`], and those that are in phase with it ([`Vibration`]):
    ///
    /// ```text
    /// F (1 + F h W^2)^(-1) e + kappa H (1 + (h/(2 theta_1))^2 W^2)^(-2) e
    /// ```
    pub fn response(&self, horizon: f64, h: f64, steps: f64) -> impl Iterator<Item = ResponseTerm> {
        let Estimate { order, of, .. } = *self;
        let free = horizon * self.sum(steps);
        (0..).map_while(move |k| match of {
            EstimatedSolution::Solution => {
                let tau = horizon * RATIO.powi(k);
                let multiple = if k == 0 { 1.0 } else { 2.0 };
                (k == 0 || tau >= h).then_some(ResponseTerm {
                    tau,
                    weight: multiple * tau * steps,
                    power: 1,
                })
            }
            EstimatedSolution::Embedded { vibration, .. } => {
                let resolved = (2.0 / (steps * vibration.error)).powf(1.0 / (order + 1.0));
                let forced = ResponseTerm {
                    tau: (free * h).sqrt(),
                    weight: free,
                    power: 1,
                };
                let in_phase = ResponseTerm {
                    tau: h / (OF_RESOLVED * resolved),
                    weight: vibration.ratio * horizon,
                    power: 2,
                };
                [forced, in_phase].get(k as usize).copied()
            }
        })
    }

    /// The error of a step over its share of an accuracy falls with this power of the step.
    pub fn order_of_ratio(&self) -> f64 {
        match self.of {
            EstimatedSolution::Solution => self.order,
            EstimatedSolution::Embedded { .. } => self.order - 0.5,
        }
    }

    /// The same if all steps change alike.
    pub fn order_of_sum(&self) -> f64 {
        match self.of {
            EstimatedSolution::Solution => self.order - 1.0,
            EstimatedSolution::Embedded { .. } => self.order - 0.5,
        }
    }
}
