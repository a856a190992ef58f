//! Descent to a stable equilibrium.
//!
//! Steepest descent in the metric of the masses, on the constraints, is q' = -M^-1 (f + Phi_q^T lambda), Phi = 0: the potential
//! falls at the largest rate that a speed of given kinetic energy allows. Its implicit steps,
//!
//! ```text
//! M (q - q_0)/tau + f(q) + Phi_q^T lambda = 0        Phi(q) = 0
//! ```
//!
//! are stationary points of the potential plus |q - q_0|_M^2/(2 tau) (pseudo-transient continuation: Kelley & Keyes 1998, SIAM J.
//! Numer. Anal. 35:508). A step is kept where the forces have done work along it and nothing moves farther than a tenth of the size of
//! the mechanism, so that it stays on its slope; otherwise tau is reduced. As the forces vanish tau grows, and the steps become those of
//! Newton's method for the equilibrium. A force that has no potential, such as one that follows a body, is judged by its work as well.

use super::extent::{Extent, NEARBY};
use super::statics::{Anchor, Limits};
use super::{Failure, Newton};
use crate::math::quadrature::GAUSS5;
use crate::system::{Equilibrium, State, Work};

/// tau of a step that inertia no longer holds back \[s2\]: (1e5 s)^2, beyond the period of any mechanism.
const LARGEST_TAU: f64 = 1e10;
/// tau shrinks by this factor where a step is refused, and grows by its square root where one is kept.
const REDUCTION: f64 = 16.0;
/// Below this tau \[s2\], (1e-15 s)^2, no mechanism moves.
const LEAST_TAU: f64 = 1e-30;
/// A descent ends where nothing moves farther than this part of the size: the root of rounding, from which Newton's method
/// reaches rounding in one iteration.
const AT_REST: f64 = 1e-8;
/// A step that needs more iterations is too long; whether it fell decides on the rest.
const LIMITS: Limits = Limits {
    iterations: 12,
    contraction: f64::INFINITY,
    radius: f64::INFINITY,
};
/// More steps than this fall two hundred times the size of the mechanism: nothing ends the fall.
const STEPS: usize = 2000;
/// The work of the forces is rounded by so many roundings of the forces times the coordinates.
const ROUNDINGS: f64 = 64.0;

impl Newton {
    /// Brings a state that satisfies the constraints downhill to rest, at its known coordinates and loads, and shows every state on
    /// the way. The end may be a saddle of the potential where the descent met one exactly.
    ///
    /// # Errors
    /// [`Failure::Falls`] of a fall without end; that of the shortest step.
    pub fn descend(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        s: &mut State,
        work: &mut Work,
        see: &mut dyn FnMut(&State),
    ) -> Result<(), Failure> {
        s.v.fill(0.0);
        s.a.fill(0.0);
        let mut next = s.clone();
        let mut tau = LARGEST_TAU;
        let mut most = 0;
        for _ in 0..STEPS {
            let distance = loop {
                next.copy_from(s);
                let anchor = Anchor {
                    q: &s.q,
                    inertia: 1.0 / tau,
                };
                let made = self.balance_with(system, extent, Some(anchor), LIMITS, &mut next, work);
                let moved = extent.update(&change(s, &next));
                let distance = moved.size;
                if made.is_ok() && distance <= NEARBY && self.falls(system, extent, s, &next, work)
                {
                    most = moved.index;
                    break distance;
                }
                tau /= REDUCTION;
                if tau < LEAST_TAU {
                    made?;
                    return Err(Failure::NoConvergence {
                        index: moved.index,
                        update: distance,
                    });
                }
            };
            s.copy_from(&next);
            // full turns are counted; there are no contacts
            system.commit(s, &[], 0.0, &mut |_| {});
            see(s);
            if distance <= AT_REST && tau == LARGEST_TAU {
                // a mechanism that can move without any force rests where it is
                if self.balance(system, extent, &mut next, work).is_ok()
                    && extent.update(&change(s, &next)).size <= AT_REST
                {
                    s.copy_from(&next);
                }
                return Ok(());
            }
            tau = LARGEST_TAU.min(tau * REDUCTION.sqrt());
        }
        Err(Failure::Falls { index: most })
    }

    /// True where the forces do work, or none to rounding, on the chord from one state to another.
    fn falls(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        from: &State,
        to: &State,
        work: &mut Work,
    ) -> bool {
        let n = system.shape().unknowns;
        let mut at = from.clone();
        // constraints carry the rounding of the farthest coordinate to all others
        let far = extent.farthest_coordinate(from);
        let (mut rise, mut magnitude) = (0.0, 0.0);
        for (x, weight) in GAUSS5 {
            for i in 0..n {
                at.q[i] = from.q[i] + x * (to.q[i] - from.q[i]);
            }
            system.free_residual(&at, &mut self.r, work);
            for i in 0..n {
                let (force, way) = (weight * self.r[i], to.q[i] - from.q[i]);
                rise += force * way;
                magnitude +=
                    force.abs() * (way.abs() + from.q[i].abs().max(far / extent.lengths[i]));
            }
        }
        rise <= ROUNDINGS * f64::EPSILON * magnitude
    }

    /// A state of equilibrium moved along a direction by which it falls, to a state on the constraints nearby. `growth` \[1/s2\] is
    /// the magnitude of the negative eigenvalue of the direction, whose largest displacement is `part` of the size.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn leave(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        (direction, growth, part): (&[f64], f64, f64),
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let (_, largest) = extent.farthest(direction.iter().copied());
        let amplitude = part * extent.size / largest;
        for (q, x) in s.q.iter_mut().zip(direction) {
            *q += amplitude * x;
        }
        let origin = s.q.clone();
        // twice the growth makes the step a minimum, so that it stays near its origin
        let anchor = Anchor {
            q: &origin,
            inertia: 2.0 * growth,
        };
        self.balance_with(system, extent, Some(anchor), LIMITS, s, work)
    }
}

/// Changes of the coordinates from one state to another.
fn change(from: &State, to: &State) -> Vec<f64> {
    from.q.iter().zip(&to.q).map(|(a, b)| b - a).collect()
}
