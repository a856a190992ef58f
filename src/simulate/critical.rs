//! Critical points of static runs: where equilibria lose their stability or regain it.

use super::arc::{Arc, set_load};
use super::equilibrium::FoundRest;
use super::{Simulation, check_turns};
use crate::newton::{ArcMetric, Crossing};
use crate::stepper::StepError;
use crate::system::{State, Work};
use numbers::{number, share};
use serde::Serialize;
use std::fmt;

/// An imperfection of this part of the size was not meant: of machines of half a metre the finest grade of tolerances, IT01 of ISO
/// 286-1, has 4 um, and seven digits have 5e-7. Codes ask columns to bear a thousandth. By Koiter's law it changes a
/// critical load by a part of 1e-3.
const NOT_MEANT: f64 = 1e-5;
/// A critical point is located to this part of a step: at a limit point t has the square of this error.
const LOCATED: f64 = 1e-10;
/// Within this part of a step of a critical point Newton's method may find no point: the root of what points are located to.
const NEAR: f64 = 1e-5;
/// Evaluations of a location at most; bisection alone needs 34.
const EVALUATIONS: usize = 60;
/// At a crossing the smallest eigenvalue is below this part of that at the start of the step; else another one is smaller.
const VANISHES: f64 = 1e-6;

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
    /// True of the first one, up to which the load grows.
    #[serde(skip)]
    pub is_first: bool,
}

impl fmt::Display for CriticalPoint {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (load, t) = (share(self.part, "the full load"), number(self.t, 9));
        let moves = &self.moves_most;
        match self.kind {
            CriticalKind::Limit if self.is_first => write!(
                f,
                "the load cannot grow beyond {load}: snap-through of {moves}, a limit point at t = {t}"
            ),
            CriticalKind::Limit => write!(
                f,
                "the load turns round at {load}: snap-through of {moves}, a limit point at t = {t}"
            ),
            CriticalKind::Bifurcation if self.is_first => write!(
                f,
                "the equilibrium is stable up to {load}: buckling of {moves}, a bifurcation at t = {t}"
            ),
            CriticalKind::Bifurcation => write!(
                f,
                "the equilibrium branches at {load}: buckling of {moves}, a bifurcation at t = {t}"
            ),
        }
    }
}

/// A critical point of the path.
pub(super) struct Critical {
    pub kind: CriticalKind,
    /// The equilibrium there; of a bifurcation that of the perfect structure.
    pub state: State,
    pub found: FoundRest,
    /// The step that leads beyond it.
    pub onward: Arc,
}

impl Critical {
    /// The measure of the load.
    pub fn t(&self) -> f64 {
        self.state.t
    }

    /// What a user reads of it.
    pub fn point(&self, duration: f64, is_first: bool) -> CriticalPoint {
        CriticalPoint {
            kind: self.kind,
            t: self.state.t,
            part: self.state.t / duration,
            moves_most: self.found.moves_most.clone(),
            is_first,
        }
    }
}

impl Simulation {
    /// The crossing of paths near an equilibrium at which the smallest eigenvalue vanishes, of a structure that was meant to be
    /// perfect. The trial state is then undefined.
    pub(super) fn bifurcation_near(&mut self, metric: ArcMetric, near: &State) -> Option<Critical> {
        let (model, newton, work) = (&*self.model, &mut self.newton, &mut self.work);
        let softest = newton.softest(model, metric.extent, near, work).ok()??;
        let from = (near, &*softest.direction);
        let load = |at: &mut State, work: &mut Work| set_load(model, metric.duration, at, work);
        let crossing = newton.crossing(model, metric, &load, from, work);
        let Crossing {
            state,
            imperfection,
            along,
        } = crossing.ok()??;
        check_turns(model, near, &state).ok()?;
        self.trial.copy_from(&state);
        let found = self.stability_of_trial(metric).ok()?;
        let size = |rest: &FoundRest| rest.smallest_eigenvalue.map_or(0.0, f64::abs);
        let vanishes = size(&found) <= VANISHES * self.rest.as_ref().map_or(0.0, size);
        if imperfection > NOT_MEANT || !vanishes {
            return None;
        }
        let onward = Arc {
            base: state.clone(),
            along,
            length: self.scene.output.interval / metric.duration,
        };
        Some(Critical {
            kind: CriticalKind::Bifurcation,
            state,
            found: found.at_zero(),
            onward,
        })
    }

    /// The bifurcation within a step along the path, near a state of it.
    pub(super) fn bifurcation_within(
        &mut self,
        metric: ArcMetric,
        step: &Arc,
        near: &State,
    ) -> Option<Critical> {
        let critical = self.bifurcation_near(metric, near)?;
        let distance = metric.distance(&step.along, &step.base, &critical.state);
        (distance > 0.0 && distance <= step.length).then_some(critical)
    }

    /// The critical point within a step at whose end, in the trial state, the smallest eigenvalue has the other sign.
    pub(super) fn critical_within(
        &mut self,
        metric: ArcMetric,
        step: &Arc,
    ) -> Result<Critical, StepError> {
        let end = self.trial.clone();
        if let Some(critical) = self.bifurcation_within(metric, step, &step.base) {
            return Ok(critical);
        }
        self.trial.copy_from(&end);
        let located = self.locate_critical(metric, step);
        let state = self.trial.clone();
        if let Some(critical) = self.bifurcation_within(metric, step, &state) {
            return Ok(critical);
        }
        Ok(Critical {
            kind: CriticalKind::Limit,
            state,
            found: located?.at_zero(),
            onward: step.clone(),
        })
    }

    /// The point at which the smallest eigenvalue changes its sign within a step, in the trial state: regula falsi with the weights
    /// of the Illinois method.
    fn locate_critical(&mut self, metric: ArcMetric, step: &Arc) -> Result<FoundRest, StepError> {
        let arc = step.length;
        let value = |found: &FoundRest| found.smallest_eigenvalue.unwrap_or(0.0);
        let first = self.rest.as_ref().map_or(0.0, value);
        let last = value(&self.stability_of_trial(metric)?);
        let (mut a, mut b) = ((0.0, first), (arc, last));
        for _ in 0..EVALUATIONS {
            let middle = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
            let last = self.trial.clone();
            let evaluated = self.path_point(metric, step, middle);
            let found = match evaluated.and_then(|()| self.stability_of_trial(metric)) {
                Ok(found) => found,
                Err(error) => {
                    self.trial.copy_from(&last);
                    // so near that rounding decides how far the mechanism moves in the direction without stiffness
                    match (middle - b.0).abs() <= NEAR * arc {
                        true => break,
                        false => return Err(error),
                    }
                }
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
    }
}
