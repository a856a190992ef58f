//! Location of contact onset and loss: the step is cut where a contact changes.

use super::cubic::{crossing, top};
use super::{RunError, Simulation};
use crate::system::System;
use std::ops::RangeInclusive;

/// Trials of one onset or loss; bisection alone needs 60.
const LOCATION_TRIALS: usize = 100;
/// Slopes of a secant over the rate of the gap that can be those of the same contact.
const SLOPES: RangeInclusive<f64> = 0.5..=2.0;

/// The sign of the penetration that leads to a change: closed contacts open when it is negative.
fn side(impact_velocity: f64) -> f64 {
    if impact_velocity == 0.0 { 1.0 } else { -1.0 }
}

impl Simulation {
    /// The contact of `trial` that is furthest past its change: the distance (penetration of an open contact, gap of a closed
    /// one) and its rate.
    fn furthest_past(&mut self) -> (f64, f64) {
        self.model.gaps(&self.trial, &mut self.gaps);
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        for (&[delta, rate], v) in self.gaps.iter().zip(&self.trial.memory) {
            let sign = side(*v);
            if sign * delta > furthest.0 {
                furthest = (sign * delta, sign * rate);
            }
        }
        furthest
    }

    /// The contact that is furthest past its change inside the trial step, as (distance, time): at an interior stage of the
    /// stepper, or at the maximum of the cubic between neighbouring states.
    fn furthest_past_inside(&mut self) -> (f64, f64) {
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        let mut before = self.state.t;
        self.last_gaps.copy_from_slice(&self.first_gaps);
        for s in self.stepper.interior().iter().chain([&self.trial]) {
            let is_inside = s.t < self.trial.t;
            if is_inside {
                self.model.gaps(s, &mut self.inner_gaps);
            } else {
                self.inner_gaps.copy_from_slice(&self.gaps);
            }
            let pairs = self.last_gaps.iter().zip(&self.inner_gaps);
            for ((last, &[delta, rate]), v) in pairs.zip(&self.state.memory) {
                let sign = side(*v);
                if is_inside && sign * delta > furthest.0 {
                    furthest = (sign * delta, s.t);
                }
                let ends = [sign * last[0], sign * delta];
                if let Some((t, gap)) = top(s.t - before, ends, [sign * last[1], sign * rate])
                    && gap > furthest.0
                {
                    furthest = (gap, before + t);
                }
            }
            std::mem::swap(&mut self.last_gaps, &mut self.inner_gaps);
            before = s.t;
        }
        furthest
    }

    /// When the first contact changes, by the cubics through penetrations and rates at both ends of the trial step.
    fn first_crossing(&self) -> Option<f64> {
        let h = self.trial.t - self.state.t;
        let ends = self.first_gaps.iter().zip(&self.gaps);
        let crossings = ends.zip(&self.trial.memory).filter_map(|((from, to), v)| {
            let sign = side(*v);
            let [y, rate] = [0, 1].map(|i| [sign * from[i], sign * to[i]]);
            crossing(h, y, rate)
        });
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
            self.model.gaps(&self.trial, &mut self.gaps);
        }
        Ok(clamps)
    }
}
