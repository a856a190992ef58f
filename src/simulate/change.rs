//! Location of contact onset and loss: the step is cut where a contact changes.

use super::{RunError, Simulation};
use crate::system::{State, System};

/// Trials of one onset or loss; bisection alone needs 60.
const LOCATION_TRIALS: usize = 100;

impl Simulation {
    /// The contact of `trial` or, with `inside`, of its interior stages, that is furthest past its change: the distance
    /// (an open one's penetration, a closed one's gap), its rate, and the time of the state.
    fn furthest_past(&mut self, inside: bool) -> (f64, f64, f64) {
        let states: &[State] = if inside {
            self.stepper.interior()
        } else {
            std::slice::from_ref(&self.trial)
        };
        let mut furthest = (f64::NEG_INFINITY, 0.0, 0.0);
        for s in states {
            self.model.gaps(s, &mut self.delta, &mut self.rate);
            for (c, z) in s.z.iter().enumerate() {
                let sign = if *z == 0.0 { 1.0 } else { -1.0 };
                if sign * self.delta[c] > furthest.0 {
                    furthest = (sign * self.delta[c], sign * self.rate[c], s.t);
                }
            }
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
        let (inside, _, middle) = self.furthest_past(true);
        let (mut past, mut rate, _) = self.furthest_past(false);
        if past <= tolerance {
            if inside <= tolerance {
                return Ok(clamps);
            }
            // there and back again within the step
            (clamps, t) = self.try_step(middle)?;
            (past, rate, _) = self.furthest_past(false);
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
            (past, rate, _) = self.furthest_past(false);
        }
        // the gap jumps over zero between neighbouring instants; the later one is kept
        self.counters.unlocated += 1;
        if t != high {
            (clamps, _) = self.try_step(high)?;
        }
        Ok(clamps)
    }
}
