//! Step size control by an estimate of the local error.
//!
//! A step of length h has the local errors e_q and e_v (see the stepper's estimate and [`crate::newton::Newton::filter`]).
//! With l_i the distance by which a unit of coordinate i moves a point of its body, and H the horizon,
//!
//! ```text
//! E = max_i l_i (S |e_q,i| + min(H S kappa_i |e_v,i|, |y_i|)),   kappa_i = max_t |sum e_v,i| / sum |e_v,i|
//! ```
//!
//! is the error of position that the N steps of a horizon cause if all are like this one and nothing amplifies it. It may reach the
//! accuracy p: r = E/p.
//!
//! S is the number of errors that add up. If the estimate is the error of the step itself, S is N, and N is H over the mean step of
//! about the last horizon, so every step may have the same error, however short it is ([`Estimate::typical_step`]). Where short
//! steps follow long ones the mean lags behind, and the sum may exceed p. A scheme that continues with a solution of higher order
//! than its estimate has smaller errors of varying sign. N is then H/h with the length h of the step, and S its square root times
//! the weight of [`crate::stepper::EstimatedSolution::Embedded`]. Either way the error of the run falls in proportion to p (Stetter
//! 1979, Lect. Notes Math. 679:245; Shampine 1985, BIT 25:530).
//!
//! An error of velocity grows to H e_v in free flight. The coherence kappa is the fraction of the errors of velocity in the run so
//! far that has added up rather than cancelled. In a vibration errors stay bounded: y is the distance by which those of N steps move
//! the elastic mechanism ([`Estimate::response`]).
//!
//! A step with r > 1 is repeated, unless its error is a small part of the allowance that earlier steps have not used. Near a
//! singular pose rounding is divided by the distance from the pose. It does not fall with the step, so shorter steps would
//! only accumulate more of it. The step that passes the pose may use all of that allowance.
//!
//! In a mechanism with clearance p is at most half the smallest clearance: a looser position would not tell contact from free
//! flight.
//!
//! The energy balance needs no estimate: its change in a step is the error of that step. If the scene asks for an accuracy e of
//! the energy, the changes of a horizon may add up to e: r = |change| N/e with the mean step, and the larger r counts. Every step
//! may change the balance by 1e-5 e: below that, rounding of positions in stiff contacts would count as an error.
//!
//! With k the order of r in h, the next step is h times 0.9 r^(-0.7/k) r_last^(0.4/k), kept between 0.2 and 5 (PI control:
//! Gustafsson 1991, ACM Trans. Math. Softw. 17:533; the exponents of Hairer & Wanner, Solving Ordinary Differential
//! Equations II, IV.2).
//!
//! An implicit method damps vibrations that its steps do not resolve, and its estimate does not count them. The first step h is so
//! short that such vibrations, of more than 3 rad a step, have an amplitude below p: h = 3 sqrt(p/a) with the largest acceleration a of
//! the start. From there on steps grow as the estimate allows.
//!
//! A closed contact has a time scale far below that of free flight. The first step after an onset therefore has the length
//! that was accepted after the previous onset of the same contact; the controller increases the step from there.

use super::failure::ENERGY_BALANCE;
use crate::checkpoint::{Carried, Checkpoint, carried, carry_list};
use crate::model::Model;
use crate::newton::Response;
use crate::scene::{Accuracy, Scene};
use crate::stepper::{Estimate, LocalError};
use crate::system::{State, Work};
use serde::Serialize;
use std::collections::BTreeMap;

/// Largest useful accuracy, over the smallest clearance: steps that follow a looser one do not tell contact from free flight,
/// and take more of them.
const OF_CLEARANCE: f64 = 0.5;
const SAFETY: f64 = 0.9;
/// Smallest and largest ratio of a step to the previous one.
const SMALLEST_CHANGE: f64 = 0.2;
const GREATEST_CHANGE: f64 = 5.0;
/// From this angle a step on a vibration is not resolved \[rad\].
const UNRESOLVED: f64 = 3.0;
/// Lower bound of r in the formula of the next step: a much smaller r shows that the step may grow, but not by how much.
const LEAST_RATIO: f64 = 1e-4;
/// A change of the energy balance below this part of its terms is rounding of a sum of a few dozen terms.
const BALANCE_ROUNDING: f64 = 32.0 * f64::EPSILON;
/// Part of the allowed energy that every step may use, however short.
const LEAST_SHARE: f64 = 1e-5;
/// Largest part of the unused allowance of earlier steps that one step may use.
const LARGEST_DRAW: f64 = 1e-3;
/// After so many rejections in a row no step is expected to be accepted: with changes of 0.2 to 0.9, far more than it takes
/// from the longest step to the shortest.
const MOST_REJECTIONS: u32 = 200;
/// Steps below this part of the duration are refused: they approach the rounding of t.
const LEAST_PART: f64 = 1e4 * f64::EPSILON;

/// Chooses steps.
#[derive(Debug)]
pub(super) struct Controller {
    accuracy: Accuracy,
    /// The accuracy of positions that the steps follow \[m\].
    position: f64,
    estimate: Estimate,
    /// Metres per unit of each unknown.
    lengths: Vec<f64>,
    /// For mechanisms with elastic parts: how far an error of velocity moves them.
    response: Option<Response>,
    longest: f64,
    shortest: f64,
    /// The step proposed.
    next: f64,
    /// r of the last step kept.
    last: f64,
    /// Part of the accuracy that earlier steps have not used.
    unused: f64,
    /// Mean of the accepted steps.
    mean: MeanStep,
    /// Rejections since the last accepted step; after one the step must not grow.
    rejected: u32,
    /// Length of the first step after the last onset of each contact.
    first_steps: Vec<f64>,
    /// Contacts that closed at the end of the last step.
    closing: Vec<usize>,
    /// Rejected steps by the unknown with the largest error; the last entry is the energy balance.
    rejections: Vec<u64>,
    /// Shortest and longest step.
    taken: [f64; 2],
    /// Errors of velocity so far, by unknown.
    sums: Vec<VelocityErrorSums>,
}

/// The mean of the steps of about the last horizon: the weight of a step decreases exponentially.
#[derive(Debug, Clone, Copy, Default)]
struct MeanStep {
    time: f64,
    steps: f64,
}

carried!(MeanStep { time, steps } but {});

impl MeanStep {
    /// With one more step.
    fn with(self, h: f64, horizon: f64) -> MeanStep {
        let kept = (-h / horizon).exp();
        MeanStep {
            time: kept * self.time + h,
            steps: kept * self.steps + 1.0,
        }
    }

    fn length(self) -> f64 {
        self.time / self.steps
    }
}

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

/// Steps that an accuracy required.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyReport {
    /// The accuracy asked for.
    #[serde(flatten)]
    pub asked: Accuracy,
    /// The shortest and the longest step taken \[s\], before it was cut where a contact changed; 0 before the first step.
    pub steps: [f64; 2],
    /// Steps repeated because their estimated error was too large.
    pub rejected_steps: u64,
    /// The same by the coordinate with the largest error.
    pub rejected_by: BTreeMap<String, u64>,
}

/// A step to judge, before it is cut where a contact changes.
pub(super) struct Candidate<'a> {
    pub from: &'a State,
    pub to: &'a State,
    pub error: &'a LocalError,
    /// Where it was meant to end \[s\].
    pub goal: f64,
    pub passes_singular_pose: bool,
}

/// Verdict on a step.
pub(super) enum Verdict {
    /// It is kept.
    Keep,
    /// It is repeated with a shorter length.
    Repeat,
    /// It cannot be made shorter: index of the unknown with the largest error, or the number of unknowns for the energy balance.
    Stuck(usize),
}

impl Controller {
    /// For a stepper that has an estimate, from a start.
    pub fn new(
        scene: &Scene,
        model: &Model,
        start: &State,
        accuracy: Accuracy,
        estimate: Estimate,
    ) -> Controller {
        let shape = model.shape();
        let position = accuracy
            .position
            .min(OF_CLEARANCE * scene.smallest_clearance().unwrap_or(f64::INFINITY));
        let longest = scene.output.interval.min(accuracy.horizon);
        let mut lengths = model.lengths();
        // an error of an internal state, the velocity of its unknown, counts as one of position
        for state in &model.states {
            lengths[*state] = 1.0 / accuracy.horizon;
        }
        let accelerations = lengths.iter().zip(&start.a).map(|(l, a)| l * a.abs());
        let first = match estimate.implicit {
            true => UNRESOLVED * (position / accelerations.fold(0.0, f64::max)).sqrt(),
            false => longest,
        };
        Controller {
            accuracy,
            position,
            estimate,
            lengths,
            response: model
                .is_elastic()
                .then(|| Response::new(model, accuracy.horizon)),
            longest,
            shortest: LEAST_PART * scene.simulation.duration,
            next: first,
            last: 1.0,
            unused: 0.0,
            mean: MeanStep::default(),
            rejected: 0,
            first_steps: vec![f64::INFINITY; shape.contacts],
            closing: Vec::with_capacity(shape.contacts),
            rejections: vec![0; shape.unknowns + 1],
            taken: [f64::INFINITY, 0.0],
            sums: vec![VelocityErrorSums::default(); shape.unknowns],
        }
    }

    /// Carries what later steps depend on.
    pub fn carry(&mut self, model: &Model, checkpoint: &mut Checkpoint) {
        let Controller {
            accuracy: _,
            position: _,
            estimate: _,
            lengths: _,
            response,
            longest: _,
            shortest: _,
            next,
            last,
            unused,
            mean,
            rejected,
            first_steps,
            closing,
            rejections,
            taken,
            sums,
        } = self;
        if let Some(response) = response {
            response.carry(model, checkpoint);
        }
        for x in [next, last, unused] {
            x.carry(checkpoint);
        }
        mean.carry(checkpoint);
        rejected.carry(checkpoint);
        first_steps.carry(checkpoint);
        carry_list(closing, first_steps.len(), checkpoint);
        rejections.carry(checkpoint);
        taken.carry(checkpoint);
        sums.carry(checkpoint);
    }

    /// Multiply-adds that it has taken to judge steps, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        self.response.as_ref().map_or(0, Response::operations)
    }

    /// No step is longer \[s\].
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// The end of the step from t; a step never ends just short of the target.
    pub fn goal(&mut self, t: f64, target: f64) -> f64 {
        let left = target - t;
        self.next = self.next.min(self.longest);
        if left <= 1.001 * self.next {
            target
        } else if left < 2.0 * self.next {
            t + 0.5 * left
        } else {
            t + self.next
        }
    }

    /// r among steps of this mean length, and the index of the unknown with the largest error, or the number of unknowns for the energy
    /// balance.
    fn ratio(
        &mut self,
        model: &Model,
        work: &mut Work,
        step: &Candidate,
        mean: f64,
    ) -> (f64, usize) {
        let Candidate {
            from, to, error, ..
        } = *step;
        let Accuracy {
            energy, horizon, ..
        } = self.accuracy;
        let h = to.t - from.t;
        let of_energy = energy.map_or(0.0, |energy| {
            let [(before, _), (after, size)] = [from, to].map(|s| model.energies(s).balance(s));
            let change = ((after - before).abs() - BALANCE_ROUNDING * size).max(0.0);
            change / ((mean / horizon).max(LEAST_SHARE) * energy)
        });
        let steps = horizon / self.estimate.typical_step(h, mean);
        let sum = self.estimate.sum(steps);
        let worst = |displacement: Option<&[f64]>| {
            let mut worst = (0.0, 0);
            for (i, length) in self.lengths.iter().enumerate() {
                let coasting = horizon * self.sums[i].coherence() * error.v[i].abs() * sum;
                let swinging = displacement.map_or(f64::INFINITY, |y| y[i].abs());
                let error = length * (error.q[i].abs() * sum + coasting.min(swinging));
                if error.is_nan() || error > worst.0 {
                    worst = (error, i);
                }
            }
            (worst.0 / self.position, worst.1)
        };
        let of_position = match &mut self.response {
            None => worst(None),
            Some(response) => {
                // an elastic mechanism moves less than one in free flight: the energy may be the worse even without y
                let free = (of_energy > 0.0).then(|| worst(None));
                let free = free.filter(|(of_position, _)| *of_position < of_energy);
                free.unwrap_or_else(|| {
                    let terms = self.estimate.response(horizon, h, steps);
                    let y = response.displacement(model, from, terms, &error.v, work);
                    worst(Some(y))
                })
            }
        };
        match of_energy > of_position.0 {
            true => (of_energy, self.lengths.len()),
            false => of_position,
        }
    }

    /// Accepts or rejects a step.
    pub fn judge(&mut self, model: &Model, work: &mut Work, step: &Candidate) -> Verdict {
        let h = step.to.t - step.from.t;
        let horizon = self.accuracy.horizon;
        let mean = self.mean.with(h, horizon);
        let (r, worst) = self.ratio(model, work, step, mean.length());
        let share = self.estimate.typical_step(h, mean.length()) / horizon;
        let largest_draw = if step.passes_singular_pose {
            1.0
        } else {
            LARGEST_DRAW
        };
        let draws = r > 1.0 && r * share <= largest_draw * self.unused;
        let order = self.estimate.order_of_ratio();
        if r.is_nan() || (r > 1.0 && !draws) {
            self.rejections[worst] += 1;
            self.rejected += 1;
            // an r that is not finite counts as far too large
            let change = (SAFETY * r.powf(-1.0 / order)).max(SMALLEST_CHANGE);
            self.next = h * change.min(SAFETY);
            let stuck = self.next < self.shortest || self.rejected >= MOST_REJECTIONS;
            return match stuck {
                true => Verdict::Stuck(worst),
                false => Verdict::Repeat,
            };
        }
        let r = r.max(LEAST_RATIO);
        let change = SAFETY * r.powf(-0.7 / order) * self.last.powf(0.4 / order);
        let greatest = if self.rejected > 0 {
            1.0
        } else {
            GREATEST_CHANGE
        };
        let least = if draws { 1.0 } else { SMALLEST_CHANGE };
        let proposed = h * change.clamp(least, greatest);
        self.unused = (self.unused + (1.0 - r) * share).clamp(0.0, 1.0);
        for contact in self.closing.drain(..) {
            self.first_steps[contact] = proposed;
        }
        // a step shortened by a recorded row is no basis for the next one
        let shortened = step.to.t == step.goal && h < (1.0 - 1e-9) * self.next;
        if shortened {
            self.next = self.next.max(proposed);
        } else {
            self.next = proposed;
            self.last = r;
        }
        self.taken = [self.taken[0].min(h), self.taken[1].max(h)];
        self.rejected = 0;
        self.mean = mean;
        for (sums, error) in self.sums.iter_mut().zip(&step.error.v) {
            sums.add(*error);
        }
        Verdict::Keep
    }

    /// The step is kept; `onsets` are the contacts that closed at its end.
    pub fn kept(&mut self, onsets: impl Iterator<Item = usize>) {
        self.closing.clear();
        for contact in onsets {
            self.next = self.next.min(self.first_steps[contact]);
            self.closing.push(contact);
        }
    }

    /// What has the largest error, by the index in [`Verdict::Stuck`].
    pub fn name(&self, model: &Model, index: usize) -> String {
        let names = &model.unknown_names()[..self.lengths.len()];
        let name = names.get(index).map(String::as_str);
        name.unwrap_or(ENERGY_BALANCE).to_owned()
    }

    /// What happened so far.
    pub fn report(&self, model: &Model) -> AccuracyReport {
        let rejections = self.rejections.iter().enumerate();
        let named = rejections.filter(|(_, count)| **count > 0);
        AccuracyReport {
            asked: self.accuracy,
            steps: self.taken.map(|h| if h.is_finite() { h } else { 0.0 }),
            rejected_steps: self.rejections.iter().sum(),
            rejected_by: named
                .map(|(i, count)| (self.name(model, i), *count))
                .collect(),
        }
    }
}
