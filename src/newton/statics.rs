//! Equilibrium: f(q) + Phi_q^T lambda = 0, Phi = 0, everything at rest.
//!
//! Without inertia the stiffness K may be singular although the mechanism is held by its constraints: a beam with a
//! prescribed direction is an example. K + s Phi_q^T Phi_q is regular and, with s Phi_q^T Phi added to the residual, has the
//! same solution for any s > 0; s is the largest stiffness on the diagonal. The constraints are written as s Phi = 0 and the
//! multipliers as lambda/s, so that all entries of the matrix are of similar size.

use super::{Failure, Newton, Update, iterate};
use crate::system::{Equilibrium, State, Work};

/// Largest number of Newton iterations of a load step; one that converges needs fewer.
const MAX_ITERATIONS: usize = 40;
/// An update below this part of the largest coordinate is followed by one more, whose error is the square of it.
const LAST_UPDATE: f64 = 1e-8;
/// An update below this part of the largest coordinate that no longer decreases is rounding.
const ROUNDING: f64 = 1e-12;

/// By the theorem of Newton and Kantorovich a solution is near, and Newton's method finds it, where the second update is at most half
/// the first; half of that is left for what updates in two norms differ by (Deuflhard 2011, Newton Methods for Nonlinear Problems,
/// 2.1).
pub(super) const CONTRACTION: f64 = 0.25;

/// What a step of a descent is pulled back to: M (q - q_0) w is added to the forces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor<'a> {
    /// q_0.
    pub q: &'a [f64],
    /// w \[1/s2\].
    pub inertia: f64,
}

impl Newton {
    /// Equilibrium at the known coordinates and loads of `s`, from the q and lambda in it.
    ///
    /// # Errors
    /// See [`Failure`]; updates are reported in units of coordinates. `s` is then undefined.
    pub fn balance(
        &mut self,
        system: &dyn Equilibrium,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.balance_with(system, None, (MAX_ITERATIONS, f64::INFINITY), s, work)
    }

    /// As [`Newton::balance`] from a state nearby on a path of equilibria: fails where the second update is not much smaller than
    /// the first, so that Newton's method may end on another path.
    ///
    /// # Errors
    /// As [`Newton::balance`].
    pub fn balance_on_path(
        &mut self,
        system: &dyn Equilibrium,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.balance_with(system, None, (MAX_ITERATIONS, CONTRACTION), s, work)
    }

    /// As [`Newton::balance`], with the pull of an anchor, at most so many iterations, and the largest ratio of the second update to the
    /// first.
    pub(super) fn balance_with(
        &mut self,
        system: &dyn Equilibrium,
        anchor: Option<Anchor>,
        (iterations, contraction): (usize, f64),
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        s.v.fill(0.0);
        s.a.fill(0.0);
        self.counters.stages += 1;
        let inertia = anchor.map_or(0.0, |anchor| anchor.inertia);
        let mut finishing = false;
        iterate(iterations, |iteration| {
            self.counters.newton_iterations += 1;
            if let Some(Anchor { q, inertia }) = anchor {
                for (a, (q, from)) in s.a[..n].iter_mut().zip(s.q.iter().zip(q)) {
                    *a = inertia * (q - from);
                }
            }
            let scale = self.renew_stiffness(system, s, inertia, work)?;
            for i in 0..n {
                self.b[i] = -self.r[i];
            }
            for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
                *b = -scale * phi;
            }
            self.tangents[0]
                .factors
                .solve(system.symbolic(), &mut self.b);
            for (q, d) in s.q[..n].iter_mut().zip(&self.b) {
                *q += d;
            }
            for (lambda, d) in s.lambda.iter_mut().zip(&self.b[n..]) {
                *lambda += scale * d;
            }
            let update = Update::largest(self.b[..n].iter().copied());
            let size = s.q.iter().fold(f64::MIN_POSITIVE, |m, q| m.max(q.abs()));
            let is_far = iteration.number == 1 && update.size > contraction * iteration.last;
            if is_far && update.size > LAST_UPDATE * size {
                return Err(Failure::NoConvergence {
                    index: update.index,
                    update: update.size,
                });
            }
            let smaller = update.size < iteration.last || update.size <= ROUNDING * size;
            let converged = finishing && smaller;
            finishing = update.size <= LAST_UPDATE * size;
            Ok((update, converged))
        })?;
        s.a.fill(0.0);
        s.q_low.fill(0.0);
        Ok(())
    }

    /// The residual and the factors of the stiffness with a part of the inertia; returns the scale of the multipliers.
    pub(super) fn renew_stiffness(
        &mut self,
        system: &dyn Equilibrium,
        s: &State,
        inertia: f64,
        work: &mut Work,
    ) -> Result<f64, Failure> {
        let (r, phi) = (&mut self.r, &mut self.phi);
        let mut scale = 1.0;
        let [tangent, _] = &mut self.tangents;
        tangent.discard();
        let factors = &mut tangent.factors;
        factors.renew_homogeneous(system.symbolic(), &mut self.counters, |k| {
            scale = system.stiffness(s, inertia, r, phi, k, work);
        })?;
        Ok(scale)
    }
}
