//! A stage of a step: its equations, and Newton's method for them.

use super::iteration::{Update, iterate};
use super::tangent::{Tangent, is_fast};
use super::{Costs, Failure, MAX_ITERATIONS, Newton};
use crate::system::{State, System, Weights, Work};

/// Updates that no longer decrease count as rounding below this many tolerances, or estimates of rounding.
const ROUNDING_BAND: f64 = 1e4;
/// An update up to this many estimates of rounding may itself be rounding.
const ROUNDINGS: f64 = 4.0;
/// A tangent of the same stage is renewed when an update is larger than this part of the previous one.
const SLOW: f64 = 0.1;
/// The same where updates decrease linearly, so that an update may be large because it decreases slowly.
const LINEAR_ROUNDING_BAND: f64 = 100.0;
/// In a stage whose updates decrease linearly, the error may be at most this part of the tolerance. Where they decrease
/// quadratically, the error is far below its estimate.
const LINEAR_SHARE: f64 = 0.01;

/// What a stage demands of the constraints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Phi = 0. The multipliers and the constrained accelerations are of a low order.
    Position,
    /// d2(Phi)/dt2 = 0. The stage is that of the ordinary differential equation which follows for q, and keeps its order.
    Acceleration,
}

/// A stage: q = q_hat + w.q a, v = v_hat + w.v a.
#[derive(Debug, Clone, Copy)]
pub struct StageEquations<'a> {
    /// What it demands of the constraints.
    pub level: Level,
    /// How q and v follow a.
    pub w: Weights,
    /// q for a = 0, of the unknown coordinates.
    pub q_hat: &'a [f64],
    /// v for a = 0.
    pub v_hat: &'a [f64],
}

impl StageEquations<'_> {
    /// True where there are constraints and the stage solves them on this level.
    fn constrains(&self, system: &dyn System, level: Level) -> bool {
        self.level == level && system.shape().multipliers > 0
    }

    /// The rounding of Phi, as an error of velocity \[m/s\].
    fn rounding_of_constraints(&self) -> f64 {
        let size = self.q_hat.iter().fold(0.0_f64, |m, q| m.max(q.abs()));
        16.0 * f64::EPSILON * size * self.w.v / self.w.q
    }

    /// What rounding of accelerations, and of positions in stiff springs, may change in velocities \[m/s\].
    fn rounding(&self, s: &State) -> f64 {
        let Weights { q: by_q, v: by_v } = self.w;
        let n = self.q_hat.len();
        let largest = |x: &[f64]| {
            x.iter()
                .fold(0.0, |m: f64, x| if x.abs() > m { x.abs() } else { m })
        };
        let (of_q, of_a) = (largest(&s.q[..n]), largest(&s.a[..n]));
        f64::EPSILON * (by_v * of_a).max(by_v / by_q * of_q)
    }

    /// Sets positions and velocities from the accelerations.
    fn move_to(&self, s: &mut State) {
        let (q, v) = (
            s.q.iter_mut().zip(self.q_hat),
            s.v.iter_mut().zip(self.v_hat),
        );
        for (((q, q_hat), (v, v_hat)), a) in q.zip(v).zip(&s.a) {
            *q = q_hat + self.w.q * a;
            *v = v_hat + self.w.v * a;
        }
    }
}

/// The largest update of a velocity \[m/s\]. An internal state, one of the last unknowns with `metres` per unit, counts as the velocity
/// that moves a position as far in a stage.
#[inline]
fn largest_update(updates: &[f64], metres: &[f64], w: Weights) -> Update {
    let (moving, states) = updates.split_at(updates.len() - metres.len());
    let update = Update::largest(moving.iter().map(|d| w.v * d));
    if states.is_empty() {
        return update;
    }
    let per_metre = w.v * (w.v / w.q);
    let changes = states
        .iter()
        .zip(metres)
        .map(|(d, metres)| per_metre * metres * d);
    let of_states = Update::largest(changes);
    match of_states.size > update.size || of_states.size.is_nan() {
        true => Update {
            index: moving.len() + of_states.index,
            ..of_states
        },
        false => update,
    }
}

impl Newton {
    /// Solves M a + f + Phi_q^T lambda = 0 and the constraints of the stage's level for (a, lambda), with q = q_hat + w.q a and
    /// v = v_hat + w.v a.
    ///
    /// `s` holds the guess of (a, lambda) and the known coordinates; the solution overwrites the guess. On the position level
    /// the constraint rows are divided by w.q, so that the matrix tends to that of the acceleration level as the step decreases.
    /// The same matrix serves on the acceleration level, where it leaves out the derivatives of Phi_q; each
    /// iteration then reduces the update by a factor of the order of the angle through which bodies turn in a stage.
    ///
    /// The iteration has converged when the estimated error of every velocity is below the tolerance, which on the position level
    /// is at least 16 eps |q| w.v/w.q, the rounding of Phi as an error of velocity. Where updates decrease linearly, their error
    /// must be a hundred times smaller, unless rounding does not allow it. In a smooth system the first update may be the only one, if
    /// the square of such updates has been measured to leave less than the tolerance. A stage that fails with an extrapolated guess
    /// or an earlier tangent is solved again without them. A caller that then gives up the step must call
    /// [`Newton::forget_step`]; one that tries the stage another way need not.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn solve_stage(
        &mut self,
        system: &dyn System,
        stage: StageEquations,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.counters.stages += 1;
        let is_predicted = self.prediction.guess(stage.level, s);
        let [last, other] = &self.tangents;
        if other.distance(stage.w) < last.distance(stage.w) || !last.fits(stage.w) {
            self.tangents.swap(0, 1);
        }
        // on constraints, rounding of Phi hides how fast updates decrease with an earlier tangent
        let is_on_constraints = stage.constrains(system, Level::Position);
        let is_stale = !is_on_constraints && self.tangents[0].serves(stage.w);
        let mut solved = self.iterate_stage(system, &stage, is_stale, s, work);
        if solved.is_err() && (is_predicted || is_stale) {
            self.prediction.take_back(s);
            solved = self.iterate_stage(system, &stage, false, s, work);
        }
        let [tangent, _] = &mut self.tangents;
        match solved {
            // that of updates which decrease quadratically says nothing of a stage on the other level
            Ok(ratio) => tangent.served(ratio.filter(|_| !is_on_constraints)),
            Err(failure) => {
                tangent.discard();
                return Err(failure);
            }
        }
        stage.move_to(s);
        Ok(())
    }

    /// The residual of a stage and, with `renew`, the factors of the tangent.
    fn evaluate_stage(
        &mut self,
        system: &dyn System,
        stage: &StageEquations,
        renew: bool,
        s: &State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let (r, phi) = (&mut self.r, &mut self.phi);
        match renew {
            true => {
                let [Tangent { factors, .. }, _] = &mut self.tangents;
                let symbolic = system.symbolic();
                let limit = symbolic.largest_multiplier();
                factors.renew(symbolic, limit, &mut self.counters, |k| {
                    system.linearise(s, stage.w, r, phi, k, work);
                })?;
                self.tangents[0].renewed(stage.w);
            }
            false => system.residual(s, r, phi, work),
        }
        let Costs {
            residual,
            tangent,
            solve,
            ..
        } = self.costs;
        self.counters.operations += solve + if renew { tangent } else { residual };
        let n = stage.q_hat.len();
        let (b, rows) = self.b.split_at_mut(n);
        b.iter_mut().zip(&self.r).for_each(|(b, r)| *b = -r);
        let divisor = match stage.level {
            Level::Position => stage.w.q,
            Level::Acceleration => {
                system.constraint_acceleration(s, &mut self.phi);
                1.0
            }
        };
        for (b, phi) in rows.iter_mut().zip(&self.phi) {
            *b = -phi / divisor;
        }
        Ok(())
    }

    /// Newton's iteration of a stage, at first with an earlier tangent if `is_stale`. Returns the ratio of the last two updates,
    /// where it is above rounding.
    fn iterate_stage(
        &mut self,
        system: &dyn System,
        stage: &StageEquations,
        mut is_stale: bool,
        s: &mut State,
        work: &mut Work,
    ) -> Result<Option<f64>, Failure> {
        let n = stage.q_hat.len();
        let w = stage.w;
        let tolerance = match stage.constrains(system, Level::Position) {
            true => self.tolerance.max(stage.rounding_of_constraints()),
            false => self.tolerance,
        };
        let is_quadratic = !stage.constrains(system, Level::Acceleration);
        // the next update would only come down to rounding, unless this one shows that rounding is smaller than its estimate
        let linear_tolerance = |rounding: f64, update: f64| {
            let share = LINEAR_SHARE * tolerance;
            match update > rounding {
                true => share.max(tolerance.min(ROUNDINGS * rounding)),
                false => share,
            }
        };
        let (mut renewed, mut ratio, mut error) = (0, None, f64::INFINITY);
        let mut rounding = 0.0;
        iterate(MAX_ITERATIONS, |iteration| {
            stage.move_to(s);
            self.counters.newton_iterations += 1;
            let is_first = iteration.number == 0;
            let after_three = iteration.last * iteration.rate.powi(3);
            let renew = match is_stale {
                true => !is_first && after_three > linear_tolerance(rounding, iteration.last),
                false => is_first || iteration.rate > SLOW,
            };
            if renew && std::mem::replace(&mut is_stale, false) {
                renewed = iteration.number;
                ratio = None;
            }
            self.evaluate_stage(system, stage, renew, s, work)?;
            let [tangent, _] = &mut self.tangents;
            tangent.factors.solve(system.symbolic(), &mut self.b);
            for (x, d) in s.a[..n].iter_mut().zip(&self.b) {
                *x += d;
            }
            for (lambda, d) in s.lambda.iter_mut().zip(&self.b[n..]) {
                *lambda += d;
            }
            let update = largest_update(&self.b[..n], &self.metres, w);
            let rate = update.size / iteration.last;
            let is_linear = is_stale || !is_quadratic;
            if is_stale && rate >= 1.0 && update.size > ROUNDING_BAND * tolerance {
                let Update { index, size } = update;
                return Err(Failure::NoConvergence {
                    index,
                    update: size,
                });
            }
            if is_linear || iteration.number >= renewed + 2 {
                rounding = stage.rounding(s);
            }
            let is_known_rounding = is_linear && tangent.is_known_rounding(update.size, rounding);
            // a ratio to rounding is an upper bound
            let tells_ratio = !is_known_rounding || is_fast(rate);
            if iteration.number > renewed && iteration.last > tolerance && tells_ratio {
                ratio = Some(rate);
            }
            let linear = match is_first {
                true => update.size * tangent.ratio(w).unwrap_or(1.0),
                false if rate >= 1.0 => update.size,
                false => rate / (1.0 - rate) * update.size,
            };
            // an update that does not decrease any more is rounding of an error that was small enough before
            let is_rounding = is_linear
                && rate > 0.3
                && error <= tolerance
                && update.size <= tolerance.max(ROUNDINGS * rounding);
            // after one large update the rate says nothing: this is its error for constraints with a curvature of 1/m
            error = linear.max(update.size * update.size * w.q / w.v);
            let is_fresh = !is_linear && renewed == 0;
            if is_fresh && iteration.number == 1 {
                tangent.measure(w, [iteration.last, update.size]);
            }
            // what constraints make of rounding is part of the measured curvature; the quadratic error itself is far smaller
            let leaves_little = || {
                tangent
                    .left(w, update.size)
                    .is_some_and(|left| left <= 0.5 * tolerance)
            };
            let allowed = match is_linear {
                true => linear_tolerance(rounding, update.size),
                false => tolerance,
            };
            let is_small = is_rounding
                || error <= allowed
                || is_fresh && is_first && leaves_little() && system.is_smooth(s);
            let stagnates = !is_stale
                && iteration.number >= renewed + 2
                && rate > 0.3
                && match is_quadratic {
                    true => update.size < ROUNDING_BAND * tolerance.max(rounding),
                    false => update.size < LINEAR_ROUNDING_BAND * rounding,
                };
            if stagnates && !is_small && update.size < LINEAR_ROUNDING_BAND * rounding {
                tangent.remember_rounding(update.size, rounding);
            }
            let ends_at_rounding = stagnates || is_known_rounding && error > tolerance;
            self.counters.stagnations += u64::from(ends_at_rounding && !is_small);
            Ok((update, is_small || stagnates || is_known_rounding))
        })?;
        Ok(ratio)
    }
}
