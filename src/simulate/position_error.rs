//! The error of position that a step stands for.
//!
//! A step of length h has the local errors e_q and e_v (see the stepper's estimate and [`crate::newton::Newton::filter`]).
//! With l_i the distance by which a unit of coordinate i moves a point of its body, and H the horizon,
//!
//! ```text
//! E = max_i l_i (S |e_q,i| + min(H S chi_i |e_v,i|, |y_i|)),   chi_i = max_t |sum e_v,i| / sum |e_v,i|
//! ```
//!
//! is the error of position that the N steps of a horizon cause if all are like this one and nothing amplifies it.
//!
//! S is the number of errors that add up. If the estimate is the error of the step itself, S is N, and N is H over the mean step of
//! about the last horizon, so every step may have the same error, however short it is ([`Estimate::typical_step`]). Where short
//! steps follow long ones the mean lags behind, and the sum may exceed the accuracy. A scheme that continues with a solution of
//! higher order than its estimate has smaller errors of varying sign. N is then H/h with the length h of the step, and S its square
//! root times the weight of [`crate::stepper::EstimatedSolution::Embedded`]. Either way the error of the run falls in proportion to
//! the accuracy (Stetter 1979, Lect. Notes Math. 679:245; Shampine 1985, BIT 25:530).
//!
//! An error of velocity grows to H e_v in free flight. The coherence chi is the fraction of the errors of velocity in the run so
//! far that has added up rather than cancelled. In a vibration errors stay bounded: y is the distance by which those of N steps move
//! the elastic mechanism ([`Estimate::response`]).
//!
//! To find y takes as long as a step of some methods. The ratio of E to what it would be without y changes little from step to step, so
//! it is found in every fourth step, after every change of a contact, and where the step would be rejected.

use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::model::Model;
use crate::newton::Response;
use crate::stepper::{Estimate, LocalError};
use crate::system::{State, Work};
use std::ops::RangeInclusive;

/// The response to an error of velocity is found again after so many steps.
const RESPONSE_EVERY: u64 = 4;
/// A response serves steps whose lengths are in this range, relative to the step for which it was found.
const LENGTHS: RangeInclusive<f64> = 0.5..=2.0;

/// Finds the errors of position.
#[derive(Debug)]
pub(super) struct PositionError {
    /// The accuracy of positions \[m\].
    pub accuracy: f64,
    horizon: f64,
    /// Metres per unit of each unknown.
    lengths: Vec<f64>,
    /// Errors of velocity so far, by unknown.
    sums: Vec<VelocityErrorSums>,
    /// For mechanisms with elastic parts: how far an error of velocity moves them.
    response: Option<Response>,
    bound: Option<Bound>,
}

/// By how much the response lowers the error of a step.
#[derive(Debug, Clone, Copy, Default)]
struct Bound {
    /// The error of position over that of free flight.
    part: f64,
    /// Length of the step for which it was found \[s\], and the number of steps before it.
    h: f64,
    step: u64,
}

carried!(Bound { part, h, step } but {});

/// Sums of the errors of a velocity.
#[derive(Debug, Clone, Copy, Default)]
struct VelocityErrorSums {
    signed: f64,
    /// Largest magnitude of the signed sum so far.
    peak: f64,
    absolute: f64,
}

carried!(VelocityErrorSums { signed, peak, absolute } but {});

impl VelocityErrorSums {
    fn add(&mut self, error: f64) {
        self.signed += error;
        self.peak = self.peak.max(self.signed.abs());
        self.absolute += error.abs();
    }

    fn coherence(&self) -> f64 {
        if self.absolute > 0.0 {
            self.peak / self.absolute
        } else {
            1.0
        }
    }
}

/// A step and its local error.
#[derive(Debug, Clone, Copy)]
pub(super) struct ErringStep<'a> {
    pub from: &'a State,
    /// Its length \[s\].
    pub h: f64,
    pub error: &'a LocalError,
    /// How many steps like this one a horizon has.
    pub steps: f64,
}

impl PositionError {
    /// For an accuracy and a horizon.
    pub fn new(model: &Model, accuracy: f64, horizon: f64) -> PositionError {
        let mut lengths = model.lengths();
        // an error of an internal state, the velocity of its unknown, counts as one of position
        for (i, state) in model.state_indices().zip(&model.states) {
            lengths[i] = state.metres / horizon;
        }
        PositionError {
            accuracy,
            horizon,
            sums: vec![VelocityErrorSums::default(); lengths.len()],
            lengths,
            response: model.is_elastic().then(|| Response::new(model, horizon)),
            bound: None,
        }
    }

    /// Carries what later steps depend on.
    pub fn carry(&mut self, model: &Model, checkpoint: &mut Checkpoint) {
        let PositionError {
            accuracy: _,
            horizon: _,
            lengths: _,
            sums,
            response,
            bound,
        } = self;
        sums.carry(checkpoint);
        if let Some(response) = response {
            response.carry(model, checkpoint);
        }
        bound.carry(checkpoint);
    }

    /// Multiply-adds so far, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        self.response.as_ref().map_or(0, Response::operations)
    }

    /// True for a mechanism with elastic parts.
    pub fn is_elastic(&self) -> bool {
        self.response.is_some()
    }

    /// The largest of some rates of the unknowns, as rates of a distance.
    pub fn largest(&self, rates: impl Iterator<Item = f64>) -> f64 {
        let rates = self.lengths.iter().zip(rates).map(|(l, x)| l * x.abs());
        rates.fold(0.0, f64::max)
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.lengths.len()
    }

    /// The error of a step over the accuracy, and the unknown that has it. `least` is the ratio of the energy balance: where an upper
    /// bound of the error is below it, that bound is returned, since the larger ratio counts.
    pub fn of_step(
        &mut self,
        model: &Model,
        work: &mut Work,
        estimate: &Estimate,
        step: ErringStep,
        least: f64,
    ) -> (f64, usize) {
        let ErringStep {
            from,
            h,
            error,
            steps,
        } = step;
        let sum = estimate.sum(steps);
        let worst = |displacement: Option<&[f64]>| {
            let mut worst = (0.0, 0);
            for (i, length) in self.lengths.iter().enumerate() {
                let coasting = self.horizon * self.sums[i].coherence() * error.v[i].abs() * sum;
                let swinging = displacement.map_or(f64::INFINITY, |y| y[i].abs());
                let error = length * (error.q[i].abs() * sum + coasting.min(swinging));
                if error.is_nan() || error > worst.0 {
                    worst = (error, i);
                }
            }
            (worst.0 / self.accuracy, worst.1)
        };
        let free = worst(None);
        let Some(response) = &mut self.response else {
            return free;
        };
        if free.0 < least {
            return free;
        }
        let is_alike = |bound: &Bound| {
            let is_recent = response.steps() < bound.step + RESPONSE_EVERY;
            is_recent && LENGTHS.contains(&(h / bound.h))
        };
        let recent = self.bound.filter(is_alike);
        let bounded = recent.map(|bound| bound.part * free.0);
        if let Some(bounded) = bounded.filter(|r| *r <= 1.0) {
            return (bounded, free.1);
        }
        let terms = estimate.response(self.horizon, h, steps);
        let y = response.displacement(model, from, terms, &error.v, work);
        let bounded = worst(Some(y));
        self.bound = Some(Bound {
            part: bounded.0 / free.0,
            h,
            step: response.steps(),
        });
        bounded
    }

    /// The response is found again in the next step: a contact has changed, or another motion begins.
    pub fn forget_response(&mut self) {
        self.bound = None;
    }

    /// A step with this local error is kept.
    pub fn keep(&mut self, error: &LocalError) {
        if let Some(response) = &mut self.response {
            response.count_step();
        }
        for (sums, error) in self.sums.iter_mut().zip(&error.v) {
            sums.add(*error);
        }
    }
}
