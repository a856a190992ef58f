//! Location of contact onset and loss: the step is cut where a contact changes.

use super::cubic::{crossing, top};
use super::{RunError, Simulation};
use crate::system::System;
use std::ops::RangeInclusive;

/// Trials of one onset or loss; bisection alone needs 60.
const LOCATION_TRIALS: usize = 100;
/// Slopes of a secant over the rate of the gap that can be those of the same contact.
const SLOPES: RangeInclusive<f64> = 0.5..=2.0;

impl Simulation {
    /// What of `trial` is furthest past its change: the distance (penetration of an open contact, gap of a closed one) and its rate.
    fn furthest_past(&mut self) -> (f64, f64) {
        self.model.crossings(&self.trial, &mut self.crossings);
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        for &[past, rate] in &self.crossings {
            if past > furthest.0 {
                furthest = (past, rate);
            }
        }
        furthest
    }

    /// What is furthest past its change inside the trial step, as (distance, time): at an interior stage of the stepper, or at the maximum
    /// of the cubic between neighbouring states.
    fn furthest_past_inside(&mut self) -> (f64, f64) {
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        let mut before = self.state.t;
        self.last_crossings.copy_from_slice(&self.first_crossings);
        for s in self.stepper.interior().iter().chain([&self.trial]) {
            let is_inside = s.t < self.trial.t;
            if is_inside {
                self.model.crossings(s, &mut self.inner_crossings);
            } else {
                self.inner_crossings.copy_from_slice(&self.crossings);
            }
            for (last, &[past, rate]) in self.last_crossings.iter().zip(&self.inner_crossings) {
                if is_inside && past > furthest.0 {
                    furthest = (past, s.t);
                }
                if let Some((t, past)) = top(s.t - before, [last[0], past], [last[1], rate])
                    && past > furthest.0
                {
                    furthest = (past, before + t);
                }
            }
            std::mem::swap(&mut self.last_crossings, &mut self.inner_crossings);
            before = s.t;
        }
        furthest
    }

    /// When the first change is due, by the cubics through values and rates at both ends of the trial step.
    fn first_crossing(&self) -> Option<f64> {
        let h = self.trial.t - self.state.t;
        let ends = self.first_crossings.iter().zip(&self.crossings);
        let crossings =
            ends.filter_map(|(from, to)| crossing(h, [from[0], to[0]], [from[1], to[1]]));
        crossings.min_by(f64::total_cmp).map(|t| self.state.t + t)
    }

    /// Cuts the trial step so that the first contact to close or to open does so at its end; returns the clamps of that
    /// step.
    ///
    /// Until it changes, a contact follows one smooth law, so its penetration is a smooth function of the length of the
    /// step. Its zero is found inside a bracket: first where the cubic through the values and rates at both ends of the step passes
    /// zero, then by a step of Newton's method, then by the secant method. The rate of the gap is its derivative by the length of
    /// the step only up to the error of the scheme, so Newton's method converges linearly with schemes of low order.
    pub(super) fn locate_change(
        &mut self,
        mut clamps: usize,
        mut t: f64,
    ) -> Result<usize, RunError> {
        let tolerance = self.scene.integrator.onset_tolerance;
        let (mut low, mut high) = (self.state.t, t);
        let (mut past, mut rate) = self.furthest_past();
        if past <= tolerance {
            let (inside, middle) = self.furthest_past_inside();
            if inside <= tolerance {
                return Ok(clamps);
            }
            // the contact changes and changes back within the step
            self.counters.location_trials += 1;
            (clamps, t) = self.try_step(middle)?;
            (past, rate) = self.furthest_past();
            if past <= tolerance {
                // within rounding of the change
                return Ok(clamps);
            }
            high = t;
        }
        // the trial before: its end and how far the contact was past its change
        let mut last = None;
        for trial in 0..LOCATION_TRIALS {
            if past.abs() <= tolerance {
                return Ok(clamps);
            }
            if past > 0.0 {
                high = t
            } else {
                low = t
            }
            let newton = t - past / rate;
            let secant = |(before, value): (f64, f64)| (past - value) / (t - before);
            let expected = match last.map(secant) {
                None => self.first_crossing().unwrap_or(newton),
                // after the first trial the secant is short; of another contact it has another slope
                Some(slope) if trial > 1 && SLOPES.contains(&(slope / rate)) => t - past / slope,
                Some(_) => newton,
            };
            let next = match expected > low && expected < high {
                true => expected,
                false => low + 0.5 * (high - low),
            };
            if next <= low || next >= high {
                break;
            }
            self.counters.location_trials += 1;
            last = Some((t, past));
            (clamps, t) = self.try_step(next)?;
            (past, rate) = self.furthest_past();
        }
        // the gap jumps over zero between neighbouring instants; the later one is kept
        self.counters.unlocated += 1;
        if t != high {
            (clamps, _) = self.try_step(high)?;
            self.model.crossings(&self.trial, &mut self.crossings);
        }
        Ok(clamps)
    }
}
