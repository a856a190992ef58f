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
/// The load path from the undeformed start to the equilibrium is halved at most this many times.
const HALVINGS: i32 = 20;

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
        self.balance_against(system, &[], s, work)
    }

    /// As [`Newton::balance`], but the residual of the unknown coordinates becomes `left`; an empty `left` is zero.
    fn balance_against(
        &mut self,
        system: &dyn Equilibrium,
        left: &[f64],
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        s.v.fill(0.0);
        s.a.fill(0.0);
        self.counters.stages += 1;
        let mut finishing = false;
        iterate(MAX_ITERATIONS, |iteration| {
            self.counters.newton_iterations += 1;
            let scale = self.renew_stiffness(system, s, work)?;
            for i in 0..n {
                self.b[i] = -self.r[i];
            }
            for (b, left) in self.b.iter_mut().zip(left) {
                *b += left;
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
            let smaller = update.size < iteration.last || update.size <= ROUNDING * size;
            let converged = finishing && smaller;
            finishing = update.size <= LAST_UPDATE * size;
            Ok((update, converged))
        })?;
        s.q_low.fill(0.0);
        Ok(())
    }

    /// The residual and the factors of the stiffness; returns the scale of the multipliers.
    fn renew_stiffness(
        &mut self,
        system: &dyn Equilibrium,
        s: &State,
        work: &mut Work,
    ) -> Result<f64, Failure> {
        let (r, phi) = (&mut self.r, &mut self.phi);
        let mut scale = 1.0;
        let [tangent, _] = &mut self.tangents;
        tangent.discard();
        let factors = &mut tangent.factors;
        factors.renew(system.symbolic(), &mut self.counters, |k| {
            scale = system.stiffness(s, r, phi, k, work);
        })?;
        Ok(scale)
    }

    /// Equilibrium under the loads of `s` as they are, from an undeformed start: the residual of the start is taken off
    /// in parts, r(q) = (1 - p) r(q_0) with p from 0 to 1, in steps that halve where they fail.
    ///
    /// # Errors
    /// The failure of the smallest step.
    pub fn settle(
        &mut self,
        system: &dyn Equilibrium,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        s.v.fill(0.0);
        s.a.fill(0.0);
        s.lambda.fill(0.0);
        system.residual(s, &mut self.r, &mut self.phi, work);
        let first = self.r[..system.shape().unknowns].to_vec();
        let (mut part, mut step) = (0.0_f64, 1.0_f64);
        let mut reached = s.clone();
        while part < 1.0 {
            let next = (part + step).min(1.0);
            let left: Vec<f64> = first.iter().map(|r| (1.0 - next) * r).collect();
            match self.balance_against(system, &left, s, work) {
                Ok(()) => {
                    part = next;
                    step *= 2.0;
                    reached.copy_from(s);
                }
                Err(failure) if step < 2.0_f64.powi(-HALVINGS) => return Err(failure),
                Err(_) => {
                    step *= 0.5;
                    s.copy_from(&reached);
                }
            }
        }
        Ok(())
    }
}
