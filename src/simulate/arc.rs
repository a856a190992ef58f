//! Steps along the path of equilibria of a static run.

use super::equilibrium::{FoundRest, explain};
use super::{GRID_ROUNDING, RunError, Simulation, check_turns, scale};
use crate::model::Model;
use crate::newton::{ArcMetric, Failure, PathTangent};
use crate::stepper::StepError;
use crate::system::{State, System, Work};

/// The directions of a path at the two ends of a step differ by less than the angle of this cosine, 25 degrees: the step sees its turns.
pub(super) const LEAST_COSINE: f64 = 0.9;

/// A step along the path.
#[derive(Clone)]
pub(super) struct Arc {
    /// Where it begins, and in which direction.
    pub base: State,
    pub along: PathTangent,
    pub length: f64,
}

impl Arc {
    /// As long as the path of this direction takes to a t.
    pub fn towards(t: f64, metric: ArcMetric, base: State, along: PathTangent) -> Arc {
        Arc {
            length: (t - base.t) / (metric.duration * along.load),
            base,
            along,
        }
    }

    /// The next step: twice as long, but at most the longest.
    pub fn onward(&self, from: &State, along: PathTangent, longest: f64) -> Arc {
        Arc {
            base: from.clone(),
            along,
            length: longest.min(2.0 * self.length),
        }
    }
}

/// Sets the loads of a state, and what is prescribed, at its t.
pub(super) fn set_load(
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
    /// What arcs are measured by; `lengths` are those of the model.
    pub(super) fn arc_metric<'a>(&self, lengths: &'a [f64]) -> ArcMetric<'a> {
        ArcMetric {
            extent: scale::extent(&self.scene, &self.model, &self.start, lengths),
            duration: self.scene.simulation.duration,
        }
    }

    /// A step along the path into the trial state: what it is, and the direction there.
    pub(super) fn path_step(
        &mut self,
        metric: ArcMetric,
        step: &Arc,
    ) -> Result<(FoundRest, PathTangent), StepError> {
        self.path_point(metric, step, step.length)?;
        check_turns(&self.model, &step.base, &self.trial)?;
        let reached = self.trial.clone();
        let mut next = self.path_tangent(metric, &reached)?;
        let mut cosine = metric.cosine(&step.along, &next);
        if cosine < 0.0 {
            next.reverse();
            cosine = -cosine;
        }
        if cosine < LEAST_COSINE {
            let index = next.moves_most(metric.extent);
            let update = step.length;
            return Err(Failure::NoConvergence { index, update }.into());
        }
        let found = self.stability_of_trial(metric)?;
        Ok((found, next))
    }

    /// The same, but at most to the full load or its reverse, where the step is cut.
    pub(super) fn path_step_to_end(
        &mut self,
        metric: ArcMetric,
        step: &mut Arc,
    ) -> Result<(FoundRest, PathTangent), StepError> {
        let (found, next) = self.path_step(metric, step)?;
        // an end that is off by rounding is the end
        let rounding = GRID_ROUNDING * self.pacer.scale();
        if self.trial.t.abs() < metric.duration - rounding {
            return Ok((found, next));
        }
        let beyond = self.trial.clone();
        let end = metric.duration.copysign(beyond.t);
        let found = self.equilibrium_near(metric, &beyond, end)?;
        step.length = metric.distance(&step.along, &step.base, &self.trial);
        Ok((found, next))
    }

    /// The point of the path at a distance from the base of a step, in the trial state.
    pub(super) fn path_point(
        &mut self,
        metric: ArcMetric,
        step: &Arc,
        distance: f64,
    ) -> Result<(), StepError> {
        let (model, work) = (&*self.model, &mut self.work);
        let load = |at: &mut State, work: &mut Work| set_load(model, metric.duration, at, work);
        let (point, trial) = ((&step.base, &step.along, distance), &mut self.trial);
        self.newton
            .path_point(model, metric, &load, point, trial, work)
    }

    /// The direction of the path at an equilibrium.
    pub(super) fn path_tangent(
        &mut self,
        metric: ArcMetric,
        at: &State,
    ) -> Result<PathTangent, StepError> {
        let (model, work) = (&*self.model, &mut self.work);
        let load = |at: &mut State, work: &mut Work| set_load(model, metric.duration, at, work);
        self.newton.path_tangent(model, metric, &load, at, work)
    }

    pub(super) fn stability_of_trial(&mut self, metric: ArcMetric) -> Result<FoundRest, StepError> {
        let (newton, work) = (&mut self.newton, &mut self.work);
        Ok(FoundRest::of(
            &self.model,
            newton,
            metric.extent,
            &self.trial,
            work,
        )?)
    }

    /// The equilibrium at t near another one, in `trial`.
    pub(super) fn equilibrium_near(
        &mut self,
        metric: ArcMetric,
        near: &State,
        t: f64,
    ) -> Result<FoundRest, StepError> {
        let (model, trial, work) = (&*self.model, &mut self.trial, &mut self.work);
        trial.copy_from(near);
        trial.t = t;
        set_load(model, metric.duration, trial, work)?;
        self.newton
            .balance_on_path(model, metric.extent, trial, work)?;
        check_turns(model, &self.state, trial)?;
        self.stability_of_trial(metric)
    }

    pub(super) fn no_equilibrium(&self, error: StepError, t: f64) -> RunError {
        match error {
            StepError::Prescribe(error) => RunError::Drive(error),
            StepError::Turn { index, cause } => RunError::Equilibrium {
                name: self.model.unknown_name(index),
                cause: cause.to_owned(),
                t,
            },
            StepError::Stage(failure) => {
                let (name, cause) = explain(&self.model, &failure, "try a smaller step");
                RunError::Equilibrium { name, cause, t }
            }
        }
    }
}
