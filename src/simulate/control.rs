//! Step size control by an estimate of the local error.
//!
//! A step has the error of position E ([`PositionError`]), which may reach the accuracy p: r = E/p.
//!
//! A step with r > 1 is repeated, unless its error is a small part of the allowance that earlier steps have not used. Near a
//! singular pose rounding is divided by the distance from the pose. It does not fall with the step, so shorter steps would
//! only accumulate more of it. The step that passes the pose may use all of that allowance.
//!
//! In a mechanism with clearance p is at most half the smallest clearance with an implicit method, and at most a hundredth of it with
//! an explicit one: a looser position would not tell contact from free flight. With an explicit method a closed contact vibrates with
//! an amplitude of about p. Where that is more than the penetration under load, contacts open at random and gain or lose energy.
//!
//! The energy balance needs no estimate: its change in a step is the error of that step. If the scene asks for an accuracy e of
//! the energy, the changes of a horizon may add up to e: r = |change| N/e with the mean step, and the larger r counts. Every step
//! may change the balance by 1e-5 e: below that, rounding of positions in stiff contacts would count as an error.
//!
//! With k the order of r in h and R = 1/3 the ratio that steps approach in a steady motion, the next step is h times
//! (r/R)^(-0.7/k) (r_last/R)^(0.4/k), kept between 0.2 and 5 (PI control: Gustafsson 1991, ACM Trans. Math. Softw. 17:533; the
//! exponents of Hairer & Wanner, Solving Ordinary Differential Equations II, IV.2). With this R, an estimate that misses a factor of
//! three still keeps the accuracy.
//!
//! An implicit method damps vibrations that its steps do not resolve, and its estimate does not count them. The first steps are so
//! short that such vibrations, of more than 3 rad a step, have amplitudes of p at most. At every instant a vibration of amplitude A
//! and angular frequency w has
//!
//! ```text
//! A^2 = (v/w)^2 + (a/w^2)^2 = (j/w^3)^2 + (a/w^2)^2
//! ```
//!
//! with its parts of the velocity v, the acceleration a and the rate j of the acceleration. With w > 3/h each square is below p^2, and
//! A below sqrt(2) p, where h is at most 3 p/v and 3 (p/a)^(1/2), or 3 (p/a)^(1/2) and 3 (p/j)^(1/3). In a mechanism with elastic
//! parts the first pair bounds the first step and the second pair the second one, with the largest v, a and j of all unknowns; j is
//! the change of a in the first step over its length. A bound by v alone would be far too short, because v is also the velocity of
//! the motion as a whole. In a mechanism without elastic parts 3 (p/a)^(1/2) bounds the first step. From there on steps grow as the
//! estimate allows.
//!
//! A closed contact has a time scale far below that of free flight. The first step after an onset therefore has the length
//! that was accepted after the previous onset of the same contact; the controller increases the step from there.

use super::failure::ENERGY_BALANCE;
use super::position_error::{ErringStep, PositionError};
use crate::checkpoint::{Carried, Checkpoint, carried, carry_list};
use crate::model::Model;
use crate::scene::{Accuracy, Scene};
use crate::stepper::{Estimate, LocalError};
use crate::system::{Changed, State, Work};
use serde::Serialize;
use std::collections::BTreeMap;

/// Largest useful accuracy of an implicit method, over the smallest clearance: steps that follow a looser one do not tell contact
/// from free flight, and take more of them.
const OF_CLEARANCE: f64 = 0.5;
/// The same of an explicit method, which does not damp the vibration of a closed contact.
const OF_CLEARANCE_EXPLICIT: f64 = 0.01;
/// r of the steps of a steady motion.
const STEADY_RATIO: f64 = 1.0 / 3.0;
/// A step that is repeated has this part of the length with which r would be 1.
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
    position_error: PositionError,
    estimate: Estimate,
    /// Time and energy balance at the end of the last step that was judged; not a number where the state has changed since.
    balance: [f64; 2],
    /// True before the first step of a motion is accepted.
    starts: bool,
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

/// Steps that an accuracy required.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyReport {
    /// The accuracy asked for.
    #[serde(flatten)]
    pub asked: Accuracy,
    /// The accuracy of positions that the steps follow: the one asked for, or a smaller one in a mechanism with clearance \[m\].
    pub followed: f64,
    /// The motions of which the accuracy holds. A run sums the errors of its steps; it does not measure how much its motion
    /// amplifies them.
    pub holds_for: &'static str,
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
        let of_clearance = match estimate.implicit {
            true => OF_CLEARANCE,
            false => OF_CLEARANCE_EXPLICIT,
        };
        let clearance = scene.smallest_clearance().unwrap_or(f64::INFINITY);
        let position = accuracy.position.min(of_clearance * clearance);
        let longest = scene.output.interval.min(accuracy.horizon);
        let mut controller = Controller {
            accuracy,
            position_error: PositionError::new(model, position, accuracy.horizon),
            estimate,
            balance: [f64::NAN; 2],
            starts: true,
            longest,
            shortest: LEAST_PART * scene.simulation.duration,
            next: longest,
            last: 1.0,
            unused: 0.0,
            mean: MeanStep::default(),
            rejected: 0,
            first_steps: vec![f64::INFINITY; shape.contacts],
            closing: Vec::with_capacity(shape.contacts),
            rejections: vec![0; shape.unknowns + 1],
            taken: [f64::INFINITY, 0.0],
        };
        controller.start(start);
        controller
    }

    /// A motion begins at a state that no step has led to.
    pub fn start(&mut self, at: &State) {
        self.starts = true;
        self.forget_last_step();
        if !self.estimate.implicit {
            return;
        }
        let [v, a] = [&at.v, &at.a].map(|x| self.position_error.largest(x.iter().copied()));
        self.next = self
            .next
            .min(UNRESOLVED * (self.position_error.accuracy / a).sqrt());
        if self.position_error.is_elastic() {
            self.next = self.next.min(UNRESOLVED * self.position_error.accuracy / v);
        }
    }

    /// Forgets what was found of the last step and does not hold for the next one.
    pub fn forget_last_step(&mut self) {
        self.balance = [f64::NAN; 2];
        self.position_error.forget_response();
    }

    /// Carries what later steps depend on.
    pub fn carry(&mut self, model: &Model, checkpoint: &mut Checkpoint) {
        let Controller {
            accuracy: _,
            position_error,
            estimate: _,
            balance,
            starts,
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
        } = self;
        position_error.carry(model, checkpoint);
        balance.carry(checkpoint);
        starts.carry(checkpoint);
        for x in [next, last, unused] {
            x.carry(checkpoint);
        }
        mean.carry(checkpoint);
        rejected.carry(checkpoint);
        first_steps.carry(checkpoint);
        carry_list(closing, first_steps.len(), checkpoint);
        rejections.carry(checkpoint);
        taken.carry(checkpoint);
    }

    /// Multiply-adds that it has taken to judge steps, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        self.position_error.operations()
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
            let before = match self.balance {
                [t, balance] if t == from.t => balance,
                _ => model.energies(from).balance(model, from).0,
            };
            let (after, size) = model.energies(to).balance(model, to);
            self.balance = [to.t, after];
            let change = ((after - before).abs() - BALANCE_ROUNDING * size).max(0.0);
            change / ((mean / horizon).max(LEAST_SHARE) * energy)
        });
        let steps = horizon / self.estimate.typical_step(h, mean);
        let step = ErringStep {
            from,
            h,
            error,
            steps,
        };
        let of_position = self
            .position_error
            .of_step(model, work, &self.estimate, step, of_energy);
        match of_energy > of_position.0 {
            true => (of_energy, self.position_error.unknowns()),
            false => of_position,
        }
    }

    /// The step after the first one, for an implicit method and an elastic mechanism.
    fn second_step(&self, first: &Candidate) -> f64 {
        let Candidate { from, to, .. } = *first;
        let h = to.t - from.t;
        let levels = from.a.iter().zip(&to.a);
        let changes = levels.map(|(before, after)| after - before);
        let j = self.position_error.largest(changes) / h;
        let a = self.position_error.largest(to.a.iter().copied());
        UNRESOLVED
            * (self.position_error.accuracy / a)
                .sqrt()
                .min((self.position_error.accuracy / j).cbrt())
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
        let [now, last] = [r, self.last].map(|r| r / STEADY_RATIO);
        let change = now.powf(-0.7 / order) * last.powf(0.4 / order);
        let greatest = if self.rejected > 0 {
            1.0
        } else {
            GREATEST_CHANGE
        };
        let least = if draws { 1.0 } else { SMALLEST_CHANGE };
        let starts = std::mem::replace(&mut self.starts, false);
        let bounds_second = starts && self.estimate.implicit && self.position_error.is_elastic();
        let proposed = match (bounds_second, self.rejected) {
            (false, _) => h * change.clamp(least, greatest),
            (true, 0) => self.second_step(step),
            (true, _) => self.second_step(step).min(h),
        };
        self.unused = (self.unused + (1.0 - r) * share).clamp(0.0, 1.0);
        for contact in self.closing.drain(..) {
            self.first_steps[contact] = proposed;
        }
        // a step shortened by a recorded row is no basis for the next one
        let shortened = step.to.t == step.goal && h < (1.0 - 1e-9) * self.next;
        if shortened && !starts {
            self.next = self.next.max(proposed);
        } else {
            self.next = proposed;
            self.last = r;
        }
        self.taken = [self.taken[0].min(h), self.taken[1].max(h)];
        self.rejected = 0;
        self.mean = mean;
        self.position_error.keep(step.error);
        Verdict::Keep
    }

    /// The step is kept and ends with these changes.
    pub fn kept(&mut self, changed: &[Changed]) {
        if !changed.is_empty() {
            self.forget_last_step();
        }
        self.closing.clear();
        for contact in changed.iter().filter_map(|change| change.closed()) {
            self.next = self.next.min(self.first_steps[contact]);
            self.closing.push(contact);
        }
    }

    /// What has the largest error, by the index in [`Verdict::Stuck`].
    pub fn name(&self, model: &Model, index: usize) -> String {
        let names = &model.unknown_names()[..self.position_error.unknowns()];
        let name = names.get(index).map(String::as_str);
        name.unwrap_or(ENERGY_BALANCE).to_owned()
    }

    /// What happened so far.
    pub fn report(&self, model: &Model) -> AccuracyReport {
        let rejections = self.rejections.iter().enumerate();
        let named = rejections.filter(|(_, count)| **count > 0);
        AccuracyReport {
            asked: self.accuracy,
            followed: self.position_error.accuracy,
            holds_for: "motions that do not amplify errors",
            steps: self.taken.map(|h| if h.is_finite() { h } else { 0.0 }),
            rejected_steps: self.rejections.iter().sum(),
            rejected_by: named
                .map(|(i, count)| (self.name(model, i), *count))
                .collect(),
        }
    }
}
