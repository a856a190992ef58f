//! The distance by which an error of velocity moves the mechanism within a horizon.
//!
//! In free flight an error e of velocity \[m/s\] grows to a distance H e within the horizon H \[s\]. In a vibration the distance is
//! bounded. [`crate::stepper::Estimate::response`] says by what: a sum of weighted x, with the elastic stiffness K, W^2 = M^-1 K and
//!
//! ```text
//! x = (1 + tau^2 W^2)^(-p) e:   (M + tau^2 K) x + Phi_q^T mu = M e,   Phi_q x = 0,   solved p times
//! ```
//!
//! Contacts count as open, because they open again within the horizon.

use super::factors::Factors;
use super::{Costs, Counters};
use crate::checkpoint::{Carried, Checkpoint};
use crate::system::{State, System, Weights, Work};

/// Number of matrices, and of the terms of a sum at most: a step is rarely shorter than twelve decades below the horizon, and modes
/// that are faster than that hardly move.
const MOST: usize = 12;
/// Steps after which a matrix is renewed.
const RENEWAL: u64 = 64;
/// Times are rounded to so many a decade of the horizon, so that a matrix serves steps of many lengths.
const A_DECADE: f64 = 3.0;

/// A part of the displacement by an error of velocity e: weight (1 + tau^2 W^2)^(-power) e with W^2 = M^-1 K.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResponseTerm {
    /// A mode slower than this responds like a free body \[s\].
    pub tau: f64,
    /// Displacement of a free body over the error of velocity \[s\].
    pub weight: f64,
    /// How steeply the response of faster modes falls.
    pub power: u32,
}

/// The matrices of all tau, factorised now and then: for an estimate the matrix of an earlier pose is accurate enough.
#[derive(Debug)]
pub struct Response {
    horizon: f64,
    costs: Costs,
    /// Multiply-adds so far, by their order of magnitude.
    operations: u64,
    matrices: Vec<TimeMatrix>,
    /// Steps so far.
    steps: u64,
    at: State,
    r: Vec<f64>,
    phi: Vec<f64>,
    b: Vec<f64>,
    /// M e.
    momentum: Vec<f64>,
    /// A solution, and their sum.
    x: Vec<f64>,
    sum: Vec<f64>,
}

/// The matrix of one time.
#[derive(Debug)]
struct TimeMatrix {
    /// Zero before it is first factorised.
    tau: f64,
    factors: Factors,
    /// True if it could not be factorised; it then counts as one without stiffness.
    singular: bool,
    /// Steps before it was factorised, and before it was last used.
    made: u64,
    used: u64,
}

impl TimeMatrix {
    fn carry(&mut self, system: &dyn System, checkpoint: &mut Checkpoint) {
        let TimeMatrix {
            tau,
            factors,
            singular,
            made,
            used,
        } = self;
        tau.carry(checkpoint);
        factors.carry(system.symbolic(), checkpoint);
        singular.carry(checkpoint);
        made.carry(checkpoint);
        used.carry(checkpoint);
    }
}

impl Response {
    /// Memory for a system with elastic parts, within a horizon \[s\].
    pub fn new(system: &dyn System, horizon: f64) -> Response {
        let shape = system.shape();
        let size = shape.unknowns + shape.multipliers;
        let matrix = || TimeMatrix {
            tau: 0.0,
            factors: Factors::new(system.symbolic()),
            singular: false,
            made: 0,
            used: 0,
        };
        Response {
            horizon,
            costs: Costs::of(system),
            operations: 0,
            matrices: std::iter::repeat_with(matrix).take(MOST).collect(),
            steps: 0,
            at: State::zeros(shape),
            r: vec![0.0; shape.coordinates],
            phi: vec![0.0; shape.multipliers],
            b: vec![0.0; size],
            momentum: vec![0.0; shape.unknowns],
            x: vec![0.0; shape.unknowns],
            sum: vec![0.0; shape.unknowns],
        }
    }

    /// Carries the matrices, which are those of earlier poses.
    pub fn carry(&mut self, system: &dyn System, checkpoint: &mut Checkpoint) {
        let Response {
            horizon: _,
            costs: _,
            operations,
            matrices,
            steps,
            at: _,
            r: _,
            phi: _,
            b: _,
            momentum: _,
            x: _,
            sum: _,
        } = self;
        operations.carry(checkpoint);
        steps.carry(checkpoint);
        for matrix in matrices {
            matrix.carry(system, checkpoint);
        }
    }

    /// Multiply-adds so far, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        self.operations
    }

    /// Factorises one matrix for a time at a state.
    fn renew(
        &mut self,
        system: &dyn System,
        state: &State,
        index: usize,
        tau: f64,
        work: &mut Work,
    ) {
        let w = Weights {
            q: tau * tau,
            v: 0.0,
        };
        self.at.copy_from(state);
        self.at.memory[..system.shape().contacts].fill(0.0);
        self.at.lambda.fill(0.0);
        let (at, r, phi) = (&self.at, &mut self.r, &mut self.phi);
        let mut counters = Counters::default();
        let fill = |k: &mut [f64]| system.linearise(at, w, r, phi, k, work);
        self.operations += self.costs.tangent;
        let matrix = &mut self.matrices[index];
        let renewed = matrix.factors.renew(
            system.symbolic(),
            system.symbolic().largest_multiplier(),
            &mut counters,
            fill,
        );
        matrix.singular = renewed.is_err();
        matrix.tau = tau;
        matrix.made = self.steps;
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Counts a step: matrices age.
    pub fn count_step(&mut self) {
        self.steps += 1;
    }

    /// The index of a matrix of this time. If there is none, the one that has not been used for longest becomes it; an old one is
    /// renewed at the state.
    fn matrix(&mut self, system: &dyn System, state: &State, tau: f64, work: &mut Work) -> usize {
        let decades = (A_DECADE * (tau / self.horizon).log10()).round() / A_DECADE;
        let tau = self.horizon * 10_f64.powf(decades);
        let found = self.matrices.iter().position(|matrix| matrix.tau == tau);
        let index = found.unwrap_or_else(|| {
            let matrices = self.matrices.iter().enumerate();
            let idle = matrices.min_by_key(|(_, m)| (m.tau > 0.0, m.used));
            idle.map_or(0, |(index, _)| index)
        });
        if found.is_none() || self.steps - self.matrices[index].made >= RENEWAL {
            self.renew(system, state, index, tau, work);
        }
        self.matrices[index].used = self.steps;
        index
    }

    /// The distance by which an error of velocity moves every unknown within the horizon \[m\]: a sum of terms, with new matrices
    /// from the state.
    pub fn displacement(
        &mut self,
        system: &dyn System,
        state: &State,
        terms: impl Iterator<Item = ResponseTerm>,
        error: &[f64],
        work: &mut Work,
    ) -> &[f64] {
        let n = error.len();
        self.sum.fill(0.0);
        system.momentum(error, &mut self.momentum);
        for term in terms.take(MOST) {
            let index = self.matrix(system, state, term.tau, work);
            self.x.copy_from_slice(error);
            let TimeMatrix {
                factors, singular, ..
            } = &self.matrices[index];
            let solves = if *singular { 0 } else { term.power };
            for solve in 0..solves {
                match solve {
                    0 => self.b[..n].copy_from_slice(&self.momentum),
                    _ => system.momentum(&self.x, &mut self.b),
                }
                self.b[n..].fill(0.0);
                factors.solve(system.symbolic(), &mut self.b);
                self.operations += self.costs.solve;
                self.x.copy_from_slice(&self.b[..n]);
            }
            for (sum, x) in self.sum.iter_mut().zip(&self.x) {
                *sum += term.weight * x;
            }
        }
        &self.sum
    }
}
