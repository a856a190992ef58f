//! The distance by which an error of velocity moves the mechanism within a horizon.
//!
//! In free flight an error e of velocity \[m/s\] grows to a distance H e within the horizon H \[s\]. In a vibration of angular
//! frequency w \[rad/s\] the distance is at most e/w. With K the elastic stiffness and W^2 = M^-1 K,
//!
//! ```text
//! y = (W^2 + 1/H^2)^(-1/2) e ~ H x_0 + sum_j 2 tau_j x_j,   (M + tau_j^2 K) x_j + Phi_q^T mu = M e,   Phi_q x_j = 0
//! ```
//!
//! with tau_0 = H and each further tau a tenth of the previous one. For a mode slower than the last tau this is between 1.0 and
//! 1.5 times min(H, 1/w) e. Contacts count as open, because they open again within the horizon.

use super::factors::Factors;
use super::{Costs, Counters};
use crate::checkpoint::{Carried, Checkpoint};
use crate::system::{State, System, Weights, Work};

/// Ratio of neighbouring times.
const RATIO: f64 = 0.1;
/// Largest number of times: from the horizon down to the rounding of the end of the run.
const MOST: usize = 12;
/// Judged steps after which one of the factors is renewed.
const RENEWAL: usize = 16;

/// The matrices of all tau, factorised now and then: for an estimate the matrix of an earlier pose is accurate enough.
#[derive(Debug)]
pub struct Response {
    horizon: f64,
    costs: Costs,
    /// Multiply-adds so far, by their order of magnitude.
    operations: u64,
    matrices: Vec<TimeMatrix>,
    /// How many matrices have been factorised.
    ready: usize,
    /// Steps since a factor was renewed, and which one was.
    age: usize,
    renewed: usize,
    at: State,
    r: Vec<f64>,
    phi: Vec<f64>,
    b: Vec<f64>,
    /// M e.
    momentum: Vec<f64>,
    x: Vec<f64>,
}

/// The matrix of one time.
#[derive(Debug)]
struct TimeMatrix {
    factors: Factors,
    /// True if it could not be factorised; it then counts as one without stiffness.
    singular: bool,
}

impl Response {
    /// Memory for a system with elastic parts, within a horizon \[s\].
    pub fn new(system: &dyn System, horizon: f64) -> Response {
        let shape = system.shape();
        let size = shape.unknowns + shape.multipliers;
        let matrix = || TimeMatrix {
            factors: Factors::new(system.symbolic()),
            singular: false,
        };
        Response {
            horizon,
            costs: Costs::of(system),
            operations: 0,
            matrices: std::iter::repeat_with(matrix).take(MOST).collect(),
            ready: 0,
            age: 0,
            renewed: 0,
            at: State::zeros(shape),
            r: vec![0.0; shape.coordinates],
            phi: vec![0.0; shape.multipliers],
            b: vec![0.0; size],
            momentum: vec![0.0; shape.unknowns],
            x: vec![0.0; shape.unknowns],
        }
    }

    /// Carries the matrices, which are those of earlier poses.
    pub fn carry(&mut self, system: &dyn System, checkpoint: &mut Checkpoint) {
        let Response {
            horizon: _,
            costs: _,
            operations,
            matrices,
            ready,
            age,
            renewed,
            at: _,
            r: _,
            phi: _,
            b: _,
            momentum: _,
            x: _,
        } = self;
        for count in [ready, age, renewed] {
            count.carry(checkpoint);
        }
        operations.carry(checkpoint);
        for TimeMatrix { factors, singular } in matrices {
            factors.carry(system.symbolic(), checkpoint);
            singular.carry(checkpoint);
        }
    }

    /// Multiply-adds so far, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        self.operations
    }

    fn time(&self, level: usize) -> f64 {
        self.horizon * RATIO.powi(level as i32)
    }

    /// Factorises one matrix at a state.
    fn renew(&mut self, system: &dyn System, state: &State, level: usize, work: &mut Work) {
        let tau = self.time(level);
        let w = Weights {
            q: tau * tau,
            v: 0.0,
        };
        self.at.copy_from(state);
        self.at.z.fill(0.0);
        self.at.lambda.fill(0.0);
        let (at, r, phi) = (&self.at, &mut self.r, &mut self.phi);
        let mut counters = Counters::default();
        let fill = |k: &mut [f64]| system.linearise(at, w, r, phi, k, work);
        self.operations += self.costs.tangent;
        let TimeMatrix { factors, singular } = &mut self.matrices[level];
        let renewed = factors.renew(system.symbolic(), &mut counters, fill);
        *singular = renewed.is_err();
    }

    /// Provides a matrix for every tau down to the step h, and renews one of them after every few steps.
    pub fn keep_up(&mut self, system: &dyn System, state: &State, h: f64, work: &mut Work) {
        while self.ready < MOST && (self.ready == 0 || self.time(self.ready) > h) {
            self.renew(system, state, self.ready, work);
            self.ready += 1;
        }
        self.age += 1;
        if self.age >= RENEWAL {
            self.age = 0;
            self.renewed = (self.renewed + 1) % self.ready;
            self.renew(system, state, self.renewed, work);
        }
    }

    /// y: the distance by which an error of velocity in a step of length h moves every unknown within the horizon \[m\].
    pub fn displacement(&mut self, system: &dyn System, h: f64, error: &[f64]) -> &[f64] {
        let n = error.len();
        self.x.fill(0.0);
        system.momentum(error, &mut self.momentum);
        for level in 0..self.ready {
            let tau = self.time(level);
            if level > 0 && tau < h {
                break;
            }
            match self.matrices[level].singular {
                true => self.b[..n].copy_from_slice(error),
                false => {
                    self.operations += self.costs.solve;
                    self.b[..n].copy_from_slice(&self.momentum);
                    self.b[n..].fill(0.0);
                    let factors = &self.matrices[level].factors;
                    factors.solve(system.symbolic(), &mut self.b);
                }
            }
            let weight = if level == 0 { tau } else { 2.0 * tau };
            for (x, b) in self.x.iter_mut().zip(&self.b) {
                *x += weight * b;
            }
        }
        &self.x
    }
}
