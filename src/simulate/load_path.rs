//! Static runs: equilibria under loads that grow with t, and the points at which they lose stability.

use super::equilibrium::{FoundRest, Stability, come_to_rest, explain};
use super::{
    Control, GRID_ROUNDING, HALVINGS, Observer, Progress, RunError, Simulation, check_turns, scale,
};
use crate::model::Model;
use crate::newton::{ArcMetric, Extent, Failure, PathTangent};
use crate::stepper::StepError;
use crate::system::{State, System, Work};
use numbers::{number, share};
use serde::Serialize;
use std::fmt;

/// The directions of a path at the two ends of a step differ by less than the angle of this cosine, 25 degrees: the step sees its turns.
const LEAST_COSINE: f64 = 0.9;
/// A critical point is located to this part of a step: at a limit point t has the square of this error.
const LOCATED: f64 = 1e-10;
/// Within this part of a step of a bifurcation Newton's method may find no point: the root of rounding.
const NEAR: f64 = 1e-5;
/// Evaluations of a location at most; bisection alone needs 34.
const EVALUATIONS: usize = 60;
/// The direction of the path is taken so far before a critical point, in parts of the step, ...
const BEFORE: f64 = 1e-6;
/// ... where the load of a limit point grows less than this part of the arc length. At a bifurcation it grows as on the way.
const STANDS: f64 = 1e-4;
/// Steps along the path between two rows at most.
const ARCS: usize = 10_000;

/// What happens at a critical point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CriticalKind {
    /// The load cannot grow.
    Limit,
    /// Another path of equilibria begins.
    Bifurcation,
}

/// An equilibrium without stiffness in one direction.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CriticalPoint {
    /// What happens there.
    pub kind: CriticalKind,
    /// The measure of the load.
    pub t: f64,
    /// The same as part of the full load.
    pub part: f64,
    /// The unknown that moves most in the direction without stiffness.
    pub moves_most: String,
}

impl fmt::Display for CriticalPoint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (load, t) = (share(self.part, "the full load"), number(self.t, 9));
        let moves = &self.moves_most;
        match self.kind {
            CriticalKind::Limit => write!(
                f,
                "the load cannot grow beyond {load}: snap-through of {moves}, a limit point at t = {t}"
            ),
            CriticalKind::Bifurcation => write!(
                f,
                "the equilibrium is stable up to {load}: buckling of {moves}, a bifurcation at t = {t}"
            ),
        }
    }
}

/// Sets the loads of a state, and what is prescribed, at its t.
fn set_load(
    model: &Model,
    duration: f64,
    at: &mut State,
    work: &mut Work,
) -> Result<(), StepError> {
    at.weight = at.t / duration;
    let from = at.clone();
    model.prescribe(&from, at, work)?;
    let known = model.shape().unknowns..;
    at.v[known.clone()].fill(0.0);
    at.a[known].fill(0.0);
    Ok(())
}

impl Simulation {
    /// A row at every interval.
    pub(super) fn run_loads(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let (interval, duration) = (self.scene.output.interval, self.scene.simulation.duration);
        let rows = (duration / interval + GRID_ROUNDING).floor() as u64;
        self.load_to(0.0, observer)?;
        self.record(observer)?;
        for k in 1..=rows {
            self.load_to((k as f64 * interval).min(duration), observer)?;
            self.record(observer)?;
        }
        self.load_to(duration, observer)
    }

    /// Equilibria up to the loads at `target`.
    pub(super) fn load_to(
        &mut self,
        target: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let lengths = self.model.lengths();
        let metric = self.arc_metric(&lengths);
        if self.rest.is_none() {
            self.come_to_rest_at(self.state.t, observer)?;
        }
        while self.state.t != target {
            let left = target - self.state.t;
            // a remainder of the load factor below this is rounding
            let next = match left <= (1.0 + GRID_ROUNDING) * self.pacer.scale() {
                true => target,
                false => self.state.t + self.pacer.scale(),
            };
            let is_stable = |rest: &FoundRest| rest.stability() == Stability::Stable;
            match self.rest.as_ref().map(FoundRest::stability) {
                Some(Stability::Stable) => {}
                Some(Stability::Unstable) if self.scene.simulation.follows_limits => {
                    self.follow_path(metric, next, observer)?;
                    continue;
                }
                _ => {
                    self.come_to_rest_at(next, observer)?;
                    continue;
                }
            }
            let near = self.state.clone();
            match self.equilibrium_near(metric, &near, next) {
                Ok(found) if is_stable(&found) => self.keep_equilibrium(found, observer)?,
                _ => {
                    self.counters.rejected += 1;
                    self.follow_path(metric, next, observer)?;
                }
            }
        }
        Ok(())
    }

    /// The mechanism comes downhill to rest under the loads at t.
    fn come_to_rest_at(&mut self, t: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        let lengths = self.model.lengths();
        let duration = self.scene.simulation.duration;
        let (model, work) = (&*self.model, &mut self.work);
        let extent = Extent {
            lengths: &lengths,
            size: scale::size(&self.scene, model, &self.state),
        };
        let (newton, trial) = (&mut self.newton, &mut self.trial);
        trial.copy_from(&self.state);
        trial.t = t;
        let found = set_load(model, duration, trial, work).and_then(|()| {
            newton.project_positions(model, trial)?;
            Ok(come_to_rest(model, newton, extent, trial, work)?)
        });
        match found {
            Ok(found) => self.keep_equilibrium(found, observer),
            Err(error) => Err(self.no_equilibrium(error, t)),
        }
    }

    /// The trial state is the next equilibrium.
    fn keep_equilibrium(
        &mut self,
        found: FoundRest,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        std::mem::swap(&mut self.state, &mut self.trial);
        self.model.remember_angles(&mut self.state);
        self.counters.steps += 1;
        self.rest = Some(found);
        let progress = Progress {
            t: self.state.t,
            duration: self.scene.simulation.duration,
            contacts: None,
        };
        match observer.step(&progress)? {
            Control::Stop => Err(RunError::Interrupted { t: self.state.t }),
            _ => Ok(()),
        }
    }

    /// Follows the path of equilibria by its arc length up to `target`, through or to the points at which it loses stability.
    fn follow_path(
        &mut self,
        metric: ArcMetric,
        target: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let duration = metric.duration;
        let tangent = self.path_tangent(metric, &self.state.clone());
        let mut along = tangent.map_err(|error| self.no_equilibrium(error, self.state.t))?;
        let mut arc = (target - self.state.t) / (duration * along.load);
        let smallest = arc * 2.0_f64.powi(-HALVINGS);
        for _ in 0..ARCS {
            let (base, was) = (self.state.clone(), self.rest.clone());
            let was_unstable = was.is_some_and(|rest| rest.stability() == Stability::Unstable);
            if was_unstable {
                // what is followed beyond a limit is shown
                arc = arc.min(self.scene.output.interval / duration);
            }
            let (found, next) = match self.path_step(metric, &base, &along, arc) {
                Ok(step) => step,
                Err(error) => {
                    self.counters.rejected += 1;
                    arc *= 0.5;
                    if arc < smallest {
                        return Err(self.no_equilibrium(error, base.t));
                    }
                    continue;
                }
            };
            if (found.stability() == Stability::Unstable) != was_unstable {
                let found = self.locate_critical(metric, &base, &along, arc)?;
                let point = self.critical_point(metric, &base, &along, &found);
                self.critical_points.push(point.clone());
                if !self.scene.simulation.follows_limits {
                    self.keep_equilibrium(found, observer)?;
                    self.record(observer)?;
                    return Err(RunError::Limit(point));
                }
                // beyond the point, where the stiffness is regular again
                let (found, next) = self
                    .path_step(metric, &base, &along, arc)
                    .map_err(|error| self.no_equilibrium(error, base.t))?;
                self.keep_equilibrium(found, observer)?;
                self.record(observer)?;
                along = next;
                continue;
            }
            if self.trial.t >= target && base.t < target {
                let near = self.trial.clone();
                if let Ok(found) = self.equilibrium_near(metric, &near, target) {
                    return self.keep_equilibrium(found, observer);
                }
                arc *= 0.5;
                continue;
            }
            self.keep_equilibrium(found, observer)?;
            if was_unstable {
                self.record(observer)?;
            }
            along = next;
            arc *= 2.0;
        }
        let message = "the path of equilibria has no end".to_owned();
        Err(RunError::Equilibrium {
            name: self
                .rest
                .as_ref()
                .map_or_else(String::new, |r| r.moves_most.clone()),
            cause: message,
            t: self.state.t,
        })
    }

    /// A step along the path into the trial state: what it is, and the direction there.
    fn path_step(
        &mut self,
        metric: ArcMetric,
        base: &State,
        along: &PathTangent,
        arc: f64,
    ) -> Result<(FoundRest, PathTangent), StepError> {
        self.path_point(metric, base, along, arc)?;
        check_turns(&self.model, base, &self.trial)?;
        let reached = self.trial.clone();
        let mut next = self.path_tangent(metric, &reached)?;
        let mut cosine = metric.cosine(along, &next);
        if cosine < 0.0 {
            next.reverse();
            cosine = -cosine;
        }
        if cosine < LEAST_COSINE {
            let index = next.moves_most(metric.extent);
            return Err(Failure::NoConvergence { index, update: arc }.into());
        }
        let found = self.stability_of_trial(metric)?;
        Ok((found, next))
    }

    /// What arcs are measured by; `lengths` are those of the model.
    fn arc_metric<'a>(&self, lengths: &'a [f64]) -> ArcMetric<'a> {
        ArcMetric {
            extent: Extent {
                lengths,
                size: scale::size(&self.scene, &self.model, &self.start),
            },
            duration: self.scene.simulation.duration,
        }
    }

    /// The point of the path at a distance, in the trial state.
    fn path_point(
        &mut self,
        metric: ArcMetric,
        base: &State,
        along: &PathTangent,
        arc: f64,
    ) -> Result<(), StepError> {
        let (model, work) = (&*self.model, &mut self.work);
        let load = |at: &mut State, work: &mut Work| set_load(model, metric.duration, at, work);
        let (point, trial) = ((base, along, arc), &mut self.trial);
        self.newton
            .path_point(model, metric, &load, point, trial, work)
    }

    fn path_tangent(&mut self, metric: ArcMetric, at: &State) -> Result<PathTangent, StepError> {
        let (model, work) = (&*self.model, &mut self.work);
        let load = |at: &mut State, work: &mut Work| set_load(model, metric.duration, at, work);
        self.newton.path_tangent(model, metric, &load, at, work)
    }

    fn stability_of_trial(&mut self, metric: ArcMetric) -> Result<FoundRest, StepError> {
        let (newton, work) = (&mut self.newton, &mut self.work);
        Ok(FoundRest::of(
            &self.model,
            newton,
            metric.extent,
            &self.trial,
            work,
        )?)
    }

    /// The point at which the smallest eigenvalue changes its sign within a step, in the trial state: regula falsi with the weights
    /// of the Illinois method.
    fn locate_critical(
        &mut self,
        metric: ArcMetric,
        base: &State,
        along: &PathTangent,
        arc: f64,
    ) -> Result<FoundRest, RunError> {
        let value = |found: &FoundRest| found.smallest_eigenvalue.unwrap_or(0.0);
        let first = self.rest.as_ref().map_or(0.0, value);
        let last = self.stability_of_trial(metric).map(|found| value(&found));
        let last = last.map_err(|error| self.no_equilibrium(error, base.t))?;
        let (mut a, mut b) = ((0.0, first), (arc, last));
        for _ in 0..EVALUATIONS {
            let middle = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
            let last = self.trial.clone();
            let evaluated = self.path_point(metric, base, along, middle);
            let found = match evaluated.and_then(|()| self.stability_of_trial(metric)) {
                Ok(found) => found,
                // so near that rounding decides how far the mechanism moves in the direction without stiffness
                Err(_) if (middle - b.0).abs() <= NEAR * arc => {
                    self.trial.copy_from(&last);
                    break;
                }
                Err(error) => return Err(self.no_equilibrium(error, base.t)),
            };
            let here = value(&found);
            if here == 0.0
                || (b.0 - a.0).abs() <= LOCATED * arc
                || (middle - b.0).abs() <= LOCATED * arc
            {
                return Ok(found);
            }
            match here * b.1 < 0.0 {
                true => a = b,
                false => a.1 *= 0.5,
            }
            b = (middle, here);
        }
        self.stability_of_trial(metric)
            .map_err(|error| self.no_equilibrium(error, base.t))
    }

    /// What the critical point in the trial state is.
    fn critical_point(
        &mut self,
        metric: ArcMetric,
        base: &State,
        along: &PathTangent,
        found: &FoundRest,
    ) -> CriticalPoint {
        let reached = self.trial.clone();
        let arc = metric.distance(along, base, &reached);
        let before = self.path_point(metric, base, along, (1.0 - BEFORE) * arc);
        let near = self.trial.clone();
        let direction = before.and_then(|()| self.path_tangent(metric, &near));
        self.trial.copy_from(&reached);
        let stands = direction.map_or(true, |direction| direction.load < STANDS);
        CriticalPoint {
            kind: match stands {
                true => CriticalKind::Limit,
                false => CriticalKind::Bifurcation,
            },
            t: reached.t,
            part: reached.t / metric.duration,
            moves_most: found.moves_most.clone(),
        }
    }

    fn no_equilibrium(&self, error: StepError, t: f64) -> RunError {
        match error {
            StepError::Prescribe(error) => RunError::Drive(error),
            StepError::Turn { index, cause } => RunError::Equilibrium {
                name: self.model.unknown_name(index),
                cause: cause.to_owned(),
                t,
            },
            StepError::Stage(failure) => {
                let (name, cause) = explain(&self.model, &failure);
                RunError::Equilibrium { name, cause, t }
            }
        }
    }

    /// The equilibrium at t near another one, in `trial`.
    fn equilibrium_near(
        &mut self,
        metric: ArcMetric,
        near: &State,
        t: f64,
    ) -> Result<FoundRest, StepError> {
        let (model, trial, work) = (&*self.model, &mut self.trial, &mut self.work);
        trial.copy_from(near);
        trial.t = t;
        set_load(model, metric.duration, trial, work)?;
        self.newton.balance_on_path(model, trial, work)?;
        check_turns(model, &self.state, trial)?;
        self.stability_of_trial(metric)
    }
}
