//! Location of contact onset and loss: the step is cut where a contact changes.

use super::top::top;
use super::{RunError, Simulation};
use crate::system::System;

/// Trials of one onset or loss; bisection alone needs 60.
const LOCATION_TRIALS: usize = 100;

/// The sign of the penetration that leads to a change: closed contacts open when it is negative.
fn side(z: f64) -> f64 {
    if z == 0.0 { 1.0 } else { -1.0 }
}

impl Simulation {
    /// The contact of `trial` that is furthest past its change: the distance (penetration of an open contact, gap of a closed
    /// one) and its rate.
    fn furthest_past(&mut self) -> (f64, f64) {
        self.model
            .gaps(&self.trial, &mut self.delta, &mut self.rate);
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        for (c, z) in self.trial.z.iter().enumerate() {
            let sign = side(*z);
            if sign * self.delta[c] > furthest.0 {
                furthest = (sign * self.delta[c], sign * self.rate[c]);
            }
        }
        furthest
    }

    /// The contact that is furthest past its change inside the trial step, as (distance, time): at an interior stage of the
    /// stepper, or at the maximum of the cubic between neighbouring states.
    fn furthest_past_inside(&mut self) -> (f64, f64) {
        let states = [&self.state]
            .into_iter()
            .chain(self.stepper.interior())
            .chain([&self.trial]);
        let mut furthest = (f64::NEG_INFINITY, 0.0);
        let mut before = f64::NAN;
        for s in states {
            self.model.gaps(s, &mut self.delta, &mut self.rate);
            for (c, z) in self.state.z.iter().enumerate() {
                let sign = side(*z);
                let (gap, rate) = (sign * self.delta[c], sign * self.rate[c]);
                let last = std::mem::replace(&mut self.last_gaps[c], [gap, rate]);
                if before.is_nan() {
                    continue;
                }
                if gap > furthest.0 && s.t < self.trial.t {
                    furthest = (gap, s.t);
                }
                if let Some((t, gap)) = top(s.t - before, [last[0], gap], [last[1], rate])
                    && gap > furthest.0
                {
                    furthest = (gap, before + t);
                }
            }
            before = s.t;
        }
        furthest
    }

    /// Cuts the trial step so that the first contact to close or to open does so at its end; returns the clamps of that
    /// step.
    ///
    /// Until it changes, a contact follows one smooth law, so its penetration is a smooth function of the length of the
    /// step: Newton's method on it, kept inside a bracket.
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
        for _ in 0..LOCATION_TRIALS {
            if past.abs() <= tolerance {
                return Ok(clamps);
            }
            if past > 0.0 {
                high = t
            } else {
                low = t
            }
            let newton = t - past / rate;
            let next = if newton > low && newton < high {
                newton
            } else {
                low + 0.5 * (high - low)
            };
            if next <= low || next >= high {
                break;
            }
            self.counters.location_trials += 1;
            (clamps, t) = self.try_step(next)?;
            (past, rate) = self.furthest_past();
        }
        // the gap jumps over zero between neighbouring instants; the later one is kept
        self.counters.unlocated += 1;
        if t != high {
            (clamps, _) = self.try_step(high)?;
        }
        Ok(clamps)
    }
}
