//! Static runs: equilibria under loads that grow with t, and the path on which they lose stability.

use super::arc::{Arc, LEAST_COSINE, set_load};
use super::critical::{Critical, CriticalKind};
use super::equilibrium::{FoundRest, Stability, come_to_rest};
use super::{Control, GRID_ROUNDING, HALVINGS, Observer, Progress, RunError, Simulation, scale};
use crate::newton::{ArcMetric, PathTangent};
use crate::stepper::StepError;
use crate::system::State;

/// Steps along the path between two rows, or between two critical points, at most.
const ARCS: usize = 10_000;

/// How the path goes on from the last stable equilibrium.
#[derive(Debug)]
pub(super) struct Heading {
    along: PathTangent,
    /// True where the smallest eigenvalue has fallen in the last step, or the bifurcation is ahead for which it fell.
    softens: bool,
}

/// What a step along the path leads to.
enum Walked {
    /// An equilibrium, in the trial state, and the direction of the path there.
    To(FoundRest, PathTangent),
    Met(Box<Critical>),
}

fn is_stable(found: &FoundRest) -> bool {
    found.stability() == Stability::Stable
}

impl Simulation {
    /// A row at every interval.
    pub(super) fn run_loads(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let (interval, duration) = (self.scene.output.interval, self.scene.simulation.duration);
        let rows = (duration / interval + GRID_ROUNDING).floor() as u64;
        for k in 0..=rows {
            self.load_to((k as f64 * interval).min(duration), observer)?;
        }
        self.reach(duration, observer)
    }

    /// Equilibria up to the loads at `target`, with a row there; nothing more once the path was followed to its end.
    pub(super) fn load_to(
        &mut self,
        target: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        self.reach(target, observer)?;
        match self.is_followed() {
            true => Ok(()),
            false => self.record(observer),
        }
    }

    /// True where the path was followed beyond a critical point.
    fn is_followed(&self) -> bool {
        self.scene.simulation.follows_limits && !self.critical_points.is_empty()
    }

    /// Equilibria up to the loads at `target`, or to the end of the path beyond a critical point.
    fn reach(&mut self, target: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        let lengths = self.model.lengths();
        let metric = self.arc_metric(&lengths);
        if self.rest.is_none() {
            self.come_to_rest_at(self.state.t, observer)?;
        }
        while self.state.t != target && !self.is_followed() {
            let left = target - self.state.t;
            // a remainder of the load factor below this is rounding
            let next = match left <= (1.0 + GRID_ROUNDING) * self.pacer.scale() {
                true => target,
                false => self.state.t + self.pacer.scale(),
            };
            match self.rest.as_ref().is_some_and(is_stable) {
                true => self.step_load(metric, next, observer)?,
                false => self.come_to_rest_at(next, observer)?,
            }
        }
        Ok(())
    }

    /// The next stable equilibrium of the path; by arc length where it turns too fast for a step of the load.
    fn step_load(
        &mut self,
        metric: ArcMetric,
        next: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let base = self.state.clone();
        let Heading { along, softens } = match self.heading.take() {
            Some(heading) => heading,
            None => Heading {
                along: self
                    .path_tangent(metric, &base)
                    .map_err(|error| self.no_equilibrium(error, base.t))?,
                softens: false,
            },
        };
        let growth = next - base.t;
        let tried = self.equilibrium_near(metric, &base, next).ok();
        let reached = self.trial.clone();
        let tried = tried.filter(is_stable);
        let tried =
            tried.and_then(|found| Some((found, self.path_tangent(metric, &reached).ok()?)));
        let Some((found, onward)) = tried else {
            if self.cannot_move() {
                return self.step_drives(metric, &base, growth, observer);
            }
            let within = |critical: &Critical| critical.t() > base.t && critical.t() <= next;
            if let Some(critical) = self.bifurcation_near(metric, &base).filter(within) {
                return self.meet(metric, critical, observer);
            }
            return self.follow_stable(
                metric,
                Arc::towards(next, metric, base, along),
                next,
                observer,
            );
        };
        let before = self.rest.as_ref().and_then(|rest| rest.smallest_eigenvalue);
        let mut falls = found.smallest_eigenvalue < before;
        let turns = metric.cosine(&along, &onward) < LEAST_COSINE;
        if turns || (softens && !falls) {
            // the step passes a crossing of paths, or the path has begun to turn away from one
            let critical = self.bifurcation_near(metric, &base);
            match critical.filter(|critical| critical.t() > base.t - growth) {
                Some(critical) if critical.t() <= next => {
                    return self.meet(metric, critical, observer);
                }
                Some(_) => falls = true,
                // it may have left the path
                None if turns => {
                    return self.follow_stable(
                        metric,
                        Arc::towards(next, metric, base, along),
                        next,
                        observer,
                    );
                }
                None => {}
            }
            self.trial.copy_from(&reached);
        }
        self.keep_equilibrium(found, observer)?;
        self.heading = Some(Heading {
            along: onward,
            softens: falls,
        });
        Ok(())
    }

    /// True of a mechanism without stiffness whose drives leave no freedom. Its eigenvalues do not tell: close to the limit of a drive
    /// rounding makes one.
    fn cannot_move(&self) -> bool {
        let is_driven = !self.scene.motions.is_empty();
        is_driven && !self.model.is_elastic() && self.partly_driven().is_none()
    }

    /// The longest step of a mechanism that follows its drives alone, which may have come to their limit: there is no other path.
    fn step_drives(
        &mut self,
        metric: ArcMetric,
        base: &State,
        growth: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let mut t = base.t + growth;
        let mut halved = 0;
        loop {
            match self.equilibrium_near(metric, base, t) {
                Ok(found) => return self.keep_equilibrium(found, observer),
                Err(error) if halved == HALVINGS => return Err(self.no_equilibrium(error, t)),
                Err(_) => {
                    halved += 1;
                    t = base.t + growth * 0.5_f64.powi(halved);
                }
            }
        }
    }

    /// The mechanism comes downhill to rest under the loads at t.
    fn come_to_rest_at(&mut self, t: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        let lengths = self.model.lengths();
        let duration = self.scene.simulation.duration;
        let (model, work) = (&*self.model, &mut self.work);
        let extent = scale::extent(&self.scene, model, &self.state, &lengths);
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
        self.model.remember(&mut self.state);
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

    /// Follows stable equilibria by the arc length of their path up to `target`, or to the point at which they lose stability.
    fn follow_stable(
        &mut self,
        metric: ArcMetric,
        mut step: Arc,
        target: f64,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let smallest = step.length * 2.0_f64.powi(-HALVINGS);
        // the step of the load that failed has searched
        let mut searches = false;
        for _ in 0..ARCS {
            let (found, next) = match self.walk(metric, &mut step, Some(true), searches) {
                Ok(Walked::To(found, next)) => (found, next),
                Ok(Walked::Met(critical)) => return self.meet(metric, *critical, observer),
                Err(error) => {
                    self.shorten(&mut step, smallest, error)?;
                    searches = false;
                    continue;
                }
            };
            if self.trial.t >= target {
                let near = self.trial.clone();
                match self.equilibrium_near(metric, &near, target) {
                    Ok(found) if is_stable(&found) => {
                        return self.keep_equilibrium(found, observer);
                    }
                    Ok(_) => step.length *= 0.5,
                    Err(error) => self.shorten(&mut step, smallest, error)?,
                }
                continue;
            }
            self.keep_equilibrium(found, observer)?;
            step = step.onward(&self.state, next, f64::INFINITY);
            searches = true;
        }
        Err(self.endless())
    }

    /// The path meets a critical point: the run ends there, or follows the path through it to its end.
    fn meet(
        &mut self,
        metric: ArcMetric,
        mut critical: Critical,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        loop {
            let point = critical.point(metric.duration, self.critical_points.is_empty());
            self.critical_points.push(point.clone());
            self.trial.copy_from(&critical.state);
            self.keep_equilibrium(critical.found, observer)?;
            self.record(observer)?;
            if !self.scene.simulation.follows_limits {
                return Err(RunError::Limit(point));
            }
            match self.follow(metric, critical.kind, critical.onward, observer)? {
                Some(next) => critical = next,
                None => return Ok(()),
            }
        }
    }

    /// Follows the path from a critical point, a row a step, to the next one or to the full load.
    fn follow(
        &mut self,
        metric: ArcMetric,
        from: CriticalKind,
        mut step: Arc,
        observer: &mut dyn Observer,
    ) -> Result<Option<Critical>, RunError> {
        let longest = self.scene.output.interval / metric.duration;
        let smallest = longest * 2.0_f64.powi(-HALVINGS);
        // whether the equilibria beyond the critical point are stable, once a step has left it
        let mut side = None;
        let mut searches = false;
        for _ in 0..ARCS {
            let (found, next) = match self.walk(metric, &mut step, side, searches) {
                Ok(Walked::To(found, next)) => (found, next),
                Ok(Walked::Met(critical)) => return Ok(Some(*critical)),
                // an imperfection bends the paths near their crossing, which a longer step leaves behind
                Err(_)
                    if side.is_none() && from == CriticalKind::Bifurcation && step.length < 1.0 =>
                {
                    step.length *= 2.0;
                    continue;
                }
                Err(error) => {
                    self.shorten(&mut step, smallest, error)?;
                    searches = false;
                    continue;
                }
            };
            side = Some(is_stable(&found));
            self.keep_equilibrium(found, observer)?;
            self.record(observer)?;
            if self.state.t == metric.duration {
                return Ok(None);
            }
            if self.state.t == -metric.duration {
                let cause =
                    "the path of equilibria leads to the reversed load instead of the full one";
                return Err(self.ends_elsewhere(cause));
            }
            step = step.onward(&self.state, next, longest);
            searches = true;
        }
        Err(self.endless())
    }

    /// A step along the path, at most to the full load or its reverse, or the critical point at which equilibria would change their
    /// side. Where the step fails, a bifurcation within it is searched for if asked to.
    fn walk(
        &mut self,
        metric: ArcMetric,
        step: &mut Arc,
        side: Option<bool>,
        searches: bool,
    ) -> Result<Walked, StepError> {
        let walked = self.path_step_to_end(metric, step);
        let walked = walked.and_then(|(found, next)| {
            match side.is_some_and(|side| side != is_stable(&found)) {
                true => self
                    .critical_within(metric, step)
                    .map(|critical| Walked::Met(Box::new(critical))),
                false => Ok(Walked::To(found, next)),
            }
        });
        walked.or_else(|error| {
            let search = || self.bifurcation_within(metric, step, &step.base);
            let critical = searches.then(search).flatten();
            let met = |critical| Walked::Met(Box::new(critical));
            critical.map(met).ok_or(error)
        })
    }

    /// Halves a step that failed.
    fn shorten(&mut self, step: &mut Arc, smallest: f64, error: StepError) -> Result<(), RunError> {
        self.counters.rejected += 1;
        step.length *= 0.5;
        match step.length < smallest {
            true => Err(self.no_equilibrium(error, step.base.t)),
            false => Ok(()),
        }
    }

    fn endless(&self) -> RunError {
        self.ends_elsewhere("the path of equilibria has no end")
    }

    fn ends_elsewhere(&self, cause: &str) -> RunError {
        let name = self.rest.as_ref().map(|rest| rest.moves_most.clone());
        RunError::Equilibrium {
            name: name.unwrap_or_default(),
            cause: cause.to_owned(),
            t: self.state.t,
        }
    }
}
