//! Equilibria under a load that is an unknown itself: the path of (q, lambda, t) by its arc length.
//!
//! With the tangent (q', t') of the path, |q'|^2/size^2 + t'^2/duration^2 = 1, a point at the distance s from a base point is the
//! solution of
//!
//! ```text
//! f(q, t) + Phi_q^T lambda = 0    Phi(q, t) = 0    (q' . (q - q_0))/size^2 + t' (t - t_0)/duration^2 = s
//! ```
//!
//! (Keller 1977; Crisfield 1981, Comput. Struct. 13:55). The products weigh coordinates by the distances by which they move points. The
//! equations are regular at a limit point, where K is singular. They are solved by two right sides for K, which lose digits there
//! in the update only, so that Newton's method still converges.

use super::statics::{CONTRACTION, Ending, move_by};
use super::{Extent, Failure, Newton, iterate_interruptibly};
use crate::system::{Equilibrium, State, Work};

/// Largest number of iterations of a point; one that stays on its path needs fewer.
pub(super) const MAX_ITERATIONS: usize = 20;
/// Loads are differenced over this part of the duration; those that grow in proportion to t have no error of truncation.
pub(super) const DIFFERENCE: f64 = 1e-4;

/// Sets the known coordinates and the loads of a state at its t.
pub type SetLoad<'a, E> = &'a dyn Fn(&mut State, &mut Work) -> Result<(), E>;

/// A direction of the path.
#[derive(Debug, Clone)]
pub struct PathTangent {
    /// Change of the unknown coordinates, then of the multipliers, per arc length, ...
    unknowns: Vec<f64>,
    /// ... and how many coordinates these are.
    coordinates: usize,
    /// Change of t per arc length, as part of the duration.
    pub load: f64,
}

/// What arcs are measured by.
#[derive(Debug, Clone, Copy)]
pub struct ArcMetric<'a> {
    /// How far coordinates move points.
    pub extent: Extent<'a>,
    /// The t of the full load.
    pub duration: f64,
}

impl ArcMetric<'_> {
    /// The product of two changes of coordinates.
    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        let lengths = self.extent.lengths.iter();
        let parts = lengths
            .zip(a.iter().zip(b))
            .map(|(l, (a, b))| l * l * a * b);
        parts.sum::<f64>() / self.extent.size.powi(2)
    }

    /// The length of a change of coordinates and of t, as part of the duration.
    fn length(&self, change: &[f64], load: f64) -> f64 {
        (self.product(change, change) + load * load).sqrt()
    }

    /// The distance of a state from a base point along a tangent.
    pub fn distance(&self, tangent: &PathTangent, base: &State, at: &State) -> f64 {
        let from_base: Vec<f64> = at.q.iter().zip(&base.q).map(|(a, b)| a - b).collect();
        let load = (at.t - base.t) / self.duration;
        self.product(tangent.way(), &from_base) + tangent.load * load
    }

    /// The cosine of the angle between two tangents.
    pub fn cosine(&self, a: &PathTangent, b: &PathTangent) -> f64 {
        self.product(a.way(), b.way()) + a.load * b.load
    }
}

impl PathTangent {
    /// Along some changes of unknowns and multipliers and of t, as part of the duration.
    pub(super) fn normalised(
        metric: ArcMetric,
        coordinates: usize,
        mut unknowns: Vec<f64>,
        load: f64,
    ) -> PathTangent {
        let length = metric.length(&unknowns[..coordinates], load);
        unknowns.iter_mut().for_each(|x| *x /= length);
        PathTangent {
            unknowns,
            coordinates,
            load: load / length,
        }
    }

    /// The part of the coordinates.
    fn way(&self) -> &[f64] {
        &self.unknowns[..self.coordinates]
    }

    /// The unknown that moves a point farthest.
    pub fn moves_most(&self, extent: Extent) -> usize {
        extent.farthest(self.way().iter().copied()).0
    }

    /// The other way.
    pub fn reverse(&mut self) {
        self.unknowns.iter_mut().for_each(|x| *x = -*x);
        self.load = -self.load;
    }
}

impl Newton {
    /// The tangent of the path at an equilibrium, towards growing loads.
    ///
    /// # Errors
    /// [`Failure::Singular`] at a limit point to the last digit.
    pub fn path_tangent<E: From<Failure>>(
        &mut self,
        system: &dyn Equilibrium,
        metric: ArcMetric,
        set_load: SetLoad<E>,
        s: &State,
        work: &mut Work,
    ) -> Result<PathTangent, E> {
        let scale = self.renew_stiffness(system, s, 0.0, work)?;
        let slope = self.follow_load(system, metric, set_load, s, scale, work)?;
        let n = system.shape().unknowns;
        Ok(PathTangent::normalised(metric, n, slope, 1.0))
    }

    /// The point of the path at the distance `arc` from `base` along its tangent, in `to`. Where the first correction
    /// is more than a quarter of the step along the tangent, and the second more than a quarter of the first, the point may be on another
    /// path.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn path_point<E: From<Failure>>(
        &mut self,
        system: &dyn Equilibrium,
        metric: ArcMetric,
        set_load: SetLoad<E>,
        (base, tangent, arc): (&State, &PathTangent, f64),
        to: &mut State,
        work: &mut Work,
    ) -> Result<(), E> {
        let n = system.shape().unknowns;
        to.copy_from(base);
        to.v.fill(0.0);
        to.a.fill(0.0);
        let way = tangent.way();
        let step: Vec<f64> = tangent.unknowns.iter().map(|x| arc * x).collect();
        move_by(to, &step);
        to.t += arc * tangent.load * metric.duration;
        set_load(to, work)?;
        self.counters.stages += 1;
        let mut ending = Ending::default();
        // why the load could not be set, within an iteration that fails for it
        let mut refused = None;
        let mut refuse = |error: E| {
            refused = Some(error);
            Failure::NotFinite { index: 0 }
        };
        let predicted = metric.extent.update(&step[..n]).size;
        let mut corrects = false;
        let ended = iterate_interruptibly(MAX_ITERATIONS, |iteration| {
            self.counters.newton_iterations += 1;
            let scale = self.renew_stiffness(system, to, 0.0, work)?;
            self.solve_against_residual(system, scale);
            let mut change = self.b.clone();
            let slope = self.follow_load(system, metric, set_load, to, scale, work);
            let slope = slope.map_err(&mut refuse)?;
            let missing = arc - metric.distance(tangent, base, to) - metric.product(way, &change);
            let growth = missing / (metric.product(way, &slope) + tangent.load);
            for (x, d) in change.iter_mut().zip(&slope) {
                *x += growth * d;
            }
            move_by(to, &change);
            to.t += growth * metric.duration;
            set_load(to, work).map_err(&mut refuse)?;
            let update = metric.extent.update(&change[..n]);
            match iteration.number {
                0 => {
                    let rounding = metric.extent.rounding(to);
                    corrects = update.size > CONTRACTION * predicted.max(rounding);
                }
                1 if corrects && iteration.last * CONTRACTION < update.size => {
                    return Err(Failure::NoConvergence {
                        index: update.index,
                        update: update.size,
                    });
                }
                _ => {}
            }
            Ok((
                update,
                ending.is_reached(iteration, update, metric.extent, to),
            ))
        });
        if let Some(error) = refused {
            return Err(error);
        }
        ended?;
        to.q_low.fill(0.0);
        Ok(())
    }

    /// Change of unknowns and multipliers with t, over the duration, with the factors of the stiffness at hand.
    pub(super) fn follow_load<E: From<Failure>>(
        &mut self,
        system: &dyn Equilibrium,
        metric: ArcMetric,
        set_load: SetLoad<E>,
        s: &State,
        scale: f64,
        work: &mut Work,
    ) -> Result<Vec<f64>, E> {
        let n = system.shape().unknowns;
        let mut k = vec![0.0; system.symbolic().len()];
        let mut sides = [1.0, -1.0].map(|sign| (sign, self.r.clone(), self.phi.clone()));
        for (sign, r, phi) in &mut sides {
            let mut near = s.clone();
            near.t += *sign * DIFFERENCE * metric.duration;
            set_load(&mut near, work)?;
            system.stiffness(&near, 0.0, r, phi, &mut k, work);
        }
        let [(_, r, phi), (_, r_before, phi_before)] = &sides;
        let over = 0.5 / DIFFERENCE;
        for i in 0..n {
            self.b[i] = -over * (r[i] - r_before[i]);
        }
        for (b, (after, before)) in self.b[n..].iter_mut().zip(phi.iter().zip(phi_before)) {
            *b = -over * (after - before);
        }
        self.solve_for_equilibrium(system, scale);
        Ok(self.b.clone())
    }
}
