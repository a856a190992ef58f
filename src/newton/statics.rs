//! Equilibrium: f(q) + Phi_q^T lambda = 0, Phi = 0, everything at rest.
//!
//! Without inertia the stiffness K may be singular although the mechanism is held by its constraints: a beam with a
//! prescribed direction is an example. K + s Phi_q^T Phi_q is regular and, with s Phi_q^T Phi added to the residual, has the
//! same solution for any s > 0; s is the largest stiffness on the diagonal. The constraints are written as s Phi = 0 and the
//! multipliers as lambda/s, so that all entries of the matrix are of similar size.

use super::extent::{Extent, NEARBY};
use super::iteration::Iteration;
use super::{Failure, Newton, Update, iterate_interruptibly};
use crate::math::lu::LARGEST_MULTIPLIER;
use crate::system::{Equilibrium, State, Work};

/// Largest number of Newton iterations of a load step; one that converges needs fewer.
const MAX_ITERATIONS: usize = 40;
/// An update below this part of the size of the mechanism is followed by one more, whose error is the square of it.
pub(super) const LAST_UPDATE: f64 = 1e-8;

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

/// How Newton's method for an equilibrium proceeds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Iterations at most.
    pub iterations: usize,
    /// The largest ratio of the second update to the first.
    pub contraction: f64,
    /// Longer updates are shortened to this part of the size.
    pub radius: f64,
}

impl Limits {
    /// Updates of any length, and as many as any equilibrium needs.
    const NONE: Limits = Limits {
        iterations: MAX_ITERATIONS,
        contraction: f64::INFINITY,
        radius: f64::INFINITY,
    };
}

impl Newton {
    /// Equilibrium at the known coordinates and loads of `s`, from the q and lambda in it.
    ///
    /// # Errors
    /// See [`Failure`]; updates are parts of the size of the mechanism. `s` is then undefined.
    pub fn balance(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.balance_with(system, extent, None, Limits::NONE, s, work)
    }

    /// As [`Newton::balance`] from a state nearby on a path of equilibria: fails where the second update is not much smaller than
    /// the first, so that Newton's method may end on another path.
    ///
    /// # Errors
    /// As [`Newton::balance`].
    pub fn balance_on_path(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let limits = Limits {
            contraction: CONTRACTION,
            ..Limits::NONE
        };
        self.balance_with(system, extent, None, limits, s, work)
    }

    /// The equilibrium near a state, stable or not, by steps of Newton's method that move nothing far. The multipliers begin as those
    /// that balance the forces best: without them the stiffness lacks what they contribute, and steps lead anywhere.
    ///
    /// # Errors
    /// As [`Newton::balance`].
    pub fn balance_nearby(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.make_consistent(system, s, work)?;
        let limits = Limits {
            radius: NEARBY,
            ..Limits::NONE
        };
        self.balance_with(system, extent, None, limits, s, work)
    }

    /// As [`Newton::balance`], with the pull of an anchor, within limits.
    pub(super) fn balance_with(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        anchor: Option<Anchor>,
        limits: Limits,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        s.v.fill(0.0);
        s.a.fill(0.0);
        self.counters.stages += 1;
        let inertia = anchor.map_or(0.0, |anchor| anchor.inertia);
        let mut ending = Ending::default();
        iterate_interruptibly(limits.iterations, |iteration| {
            self.counters.newton_iterations += 1;
            if let Some(Anchor { q, inertia }) = anchor {
                for (a, (q, from)) in s.a[..n].iter_mut().zip(s.q.iter().zip(q)) {
                    *a = inertia * (q - from);
                }
            }
            let scale = self.renew_stiffness(system, s, inertia, work)?;
            self.solve_against_residual(system, scale);
            let update = extent.update(&self.b[..n]);
            if update.size > limits.radius {
                let part = limits.radius / update.size;
                self.b.iter_mut().for_each(|x| *x *= part);
            }
            move_by(s, &self.b);
            let is_far = iteration.number == 1 && update.size > limits.contraction * iteration.last;
            if is_far && update.size > LAST_UPDATE {
                return Err(Failure::NoConvergence {
                    index: update.index,
                    update: update.size,
                });
            }
            Ok((update, ending.is_reached(iteration, update, extent, s)))
        })?;
        s.a.fill(0.0);
        s.q_low.fill(0.0);
        Ok(())
    }

    /// Changes of unknowns and multipliers, in `b`, by which the residual and the constraints would vanish, with the factors of the
    /// stiffness and the scale of the multipliers.
    pub(super) fn solve_against_residual(&mut self, system: &dyn Equilibrium, scale: f64) {
        let n = system.shape().unknowns;
        let negative = |(b, x): (&mut f64, &f64)| *b = -x;
        self.b[..n].iter_mut().zip(&self.r).for_each(negative);
        self.b[n..].iter_mut().zip(&self.phi).for_each(negative);
        self.solve_for_equilibrium(system, scale);
    }

    /// The same for changes of the residual and of the constraints in `b`.
    pub(super) fn solve_for_equilibrium(&mut self, system: &dyn Equilibrium, scale: f64) {
        let n = system.shape().unknowns;
        self.b[n..].iter_mut().for_each(|x| *x *= scale);
        let factors = &self.tangents[0].factors;
        factors.solve(system.symbolic(), &mut self.b);
        self.b[n..].iter_mut().for_each(|x| *x *= scale);
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
        // entries that are alike in size
        factors.renew(
            system.symbolic(),
            LARGEST_MULTIPLIER,
            &mut self.counters,
            |k| {
                scale = system.stiffness(s, inertia, r, phi, k, work);
            },
        )?;
        Ok(scale)
    }
}

/// Adds changes of unknowns and multipliers to a state.
pub(super) fn move_by(s: &mut State, changes: &[f64]) {
    let (unknowns, multipliers) = changes.split_at(s.q_low.len());
    let pairs = s.q.iter_mut().zip(unknowns);
    pairs
        .chain(s.lambda.iter_mut().zip(multipliers))
        .for_each(|(x, d)| *x += d);
}

/// When Newton's method for an equilibrium ends: after an update whose error is the square of a small one.
#[derive(Debug, Default)]
pub(super) struct Ending {
    /// True after a small update.
    is_last: bool,
}

impl Ending {
    /// True where this update, as part of the size, is the last.
    pub fn is_reached(
        &mut self,
        before: &Iteration,
        update: Update,
        extent: Extent,
        s: &State,
    ) -> bool {
        let smaller = update.size < before.last || update.size <= extent.rounding(s);
        let was_last = std::mem::replace(&mut self.is_last, update.size <= LAST_UPDATE);
        was_last && smaller
    }
}
