//! The choice of a scheme for an accuracy, `method = "auto"`.
//!
//! Which scheme takes the least work depends on the stiffness of the mechanism, on its mesh, on its impacts and on the accuracy.
//! So trial runs with every one of [`CANDIDATES`] race through the beginning of the motion: the one with the fewest operations
//! so far goes on. When one has seen enough, the one wins that needs the fewest operations for the whole run, if the rest of the run
//! takes as many as the part since the first contact closed. Enough are [`FEWEST_STEPS`] steps and [`PART`]
//! of the run and, in a mechanism with contacts, [`IMPACTS`] of them that have closed and opened again or a whole horizon: the
//! steps of the free flight before the first impact say nothing of those that impacts take. After [`TRIAL_RUN_STEPS`] it has seen
//! enough in any case. Where another trial run predicts nearly as few, the race goes on until it has taken a fifth of them: impacts
//! differ, and a few of them may favour the wrong one. What counts are operations, not seconds, so that a scene has the same choice on
//! every machine.
//!
//! A trial run that lags far behind retires. That is one that has taken, since its first contact closed, more than 1 + 1/n times the
//! operations with which another came as far, where n contacts have closed: in the first contact twice as many, in the second one
//! and a half times. The run continues the trial run of the scheme chosen.

use super::foresight::{MOST_STEPS, TRIAL_RUN_STEPS};
use super::replay::Replay;
use super::start::pacer;
use super::{Observer, RunError, Simulation, instants};
use crate::scene::Pace;
use crate::stepper::{CANDIDATES, Method, Scheme};
use serde::Serialize;

/// Accepted steps before the race ends: the first ones find the length that the accuracy allows.
const FEWEST_STEPS: u64 = 16;
/// Part of the run that is simulated at least.
const PART: f64 = 1.0 / 64.0;
/// Contacts that have ended: a single one may be of an unusual kind.
const IMPACTS: u64 = 4;
/// A trial run that predicts less than this multiple of the fewest operations may still be the better one.
const CLOSE: f64 = 1.05;
/// Part of the operations of the run that such a trial run may take to show it.
const SHARE: f64 = 0.2;
/// Steps that a trial run takes before the others are looked at again.
const STRIDE: u64 = 4;

/// The scheme chosen and what its choice rests on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// Name of the scheme.
    pub method: &'static str,
    /// The trial runs, the one with the fewest operations predicted first.
    pub trial_runs: Vec<TrialRun>,
}

/// The beginning of a run with one scheme.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TrialRun {
    /// Name of the scheme.
    pub method: &'static str,
    /// Time reached \[s\].
    pub t: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Multiply-adds, by their order of magnitude.
    pub operations: u64,
    /// The same, predicted for the whole run.
    pub predicted_operations: f64,
    /// Why it could not go on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A trial run under way.
struct Racer {
    scheme: &'static Scheme,
    simulation: Simulation,
    /// What it has reported.
    replay: Replay,
    /// Time and operations at the ends of its strides, in a mechanism with contacts from the first onset on.
    course: Vec<(f64, u64)>,
    retired: bool,
    error: Option<String>,
}

impl Racer {
    fn has_contacts(&self) -> bool {
        self.simulation.model.shape().contacts > 0
    }

    /// Takes some steps. Returns true at the end of the run.
    fn go_on(&mut self) -> bool {
        self.replay.steps_left = STRIDE;
        let result = self.simulation.run_to_end(&mut self.replay);
        let Simulation {
            state, counters, ..
        } = &self.simulation;
        if !self.has_contacts() || counters.onsets > 0 {
            self.course.push((state.t, self.simulation.operations()));
        }
        match result {
            Ok(()) => true,
            Err(RunError::Interrupted { .. }) => false,
            Err(error) => {
                self.error = Some(error.to_string());
                false
            }
        }
    }

    fn has_seen_enough(&self) -> bool {
        let Simulation {
            scene,
            state,
            counters,
            closures,
            ..
        } = &self.simulation;
        let horizon = match scene.integrator.pace {
            Pace::Accuracy(accuracy) => accuracy.horizon,
            Pace::Step(_) => 0.0,
        };
        counters.steps >= TRIAL_RUN_STEPS
            || counters.steps >= FEWEST_STEPS
                && state.t >= PART * scene.simulation.duration
                && (!self.has_contacts() || closures.ended >= IMPACTS || state.t >= horizon)
    }

    /// True where another came as far as this one, from where both are compared, with far fewer operations.
    fn lags(&self, other: &Racer) -> bool {
        let Simulation {
            state, counters, ..
        } = &self.simulation;
        let seen = match self.has_contacts() {
            true => counters.onsets,
            false => counters.steps / FEWEST_STEPS,
        };
        let Some((from, _)) = self.course.first() else {
            return false;
        };
        let works = [self, other].map(|racer| racer.work_between(*from, state.t));
        let [Some(own), Some(least)] = works else {
            return false;
        };
        let has_begun = self.course.len() as u64 > FEWEST_STEPS / STRIDE;
        has_begun && own as f64 > (1.0 + 1.0 / seen as f64) * least as f64
    }

    /// Operations between two times, if it has passed them.
    fn work_between(&self, from: f64, to: f64) -> Option<u64> {
        let at = |t: f64| {
            let place = self.course.partition_point(|(reached, _)| *reached < t);
            self.course.get(place).map(|(_, operations)| *operations)
        };
        Some(at(to)? - at(from)?)
    }

    fn run(&self) -> TrialRun {
        TrialRun {
            method: self.scheme.name,
            t: self.simulation.state.t,
            steps: self.simulation.counters.steps,
            operations: self.simulation.operations(),
            predicted_operations: self.predicted_operations(),
            error: self.error.clone(),
        }
    }

    /// Operations of the whole run, if it goes on as since the first contact closed.
    fn predicted_operations(&self) -> f64 {
        let (t, operations) = (self.simulation.state.t, self.simulation.operations() as f64);
        if t == 0.0 {
            return f64::INFINITY;
        }
        let first = self.course.first().filter(|(from, _)| *from < t);
        let (from, before) = first.map_or((0.0, 0.0), |&(from, before)| (from, before as f64));
        let left = self.simulation.scene.simulation.duration - t;
        operations + left * (operations - before) / (t - from)
    }
}

/// True when a trial run has seen enough and none that predicts nearly as few operations as the best could still show that it is the
/// better one.
fn is_decided(racers: &[Racer]) -> bool {
    let sound = || racers.iter().filter(|racer| racer.error.is_none());
    let best = sound().min_by(|a, b| {
        a.predicted_operations()
            .total_cmp(&b.predicted_operations())
    });
    let (Some(best), true) = (best, sound().any(Racer::has_seen_enough)) else {
        return false;
    };
    let least = best.predicted_operations();
    let may_win = |racer: &Racer| {
        let Simulation { counters, .. } = &racer.simulation;
        let has_time = counters.steps < TRIAL_RUN_STEPS
            && (racer.simulation.operations() as f64) < SHARE * least;
        has_time && !racer.retired && racer.predicted_operations() < CLOSE * least
    };
    !sound().any(|racer| racer.scheme.name != best.scheme.name && may_win(racer))
}

/// Advances the trial runs until one has seen enough, and puts the one first that needs the fewest operations for the whole run.
fn race(racers: &mut [Racer]) {
    loop {
        let under_way = racers
            .iter_mut()
            .filter(|racer| racer.error.is_none() && !racer.retired);
        let next = under_way.min_by_key(|racer| racer.simulation.operations());
        if next.is_none_or(Racer::go_on) || is_decided(racers) {
            break;
        }
        for i in 0..racers.len() {
            let others = || racers.iter().filter(|other| other.error.is_none());
            racers[i].retired |= others().any(|other| racers[i].lags(other));
        }
    }
    let needed = |racer: &Racer| match racer.error {
        Some(_) => f64::INFINITY,
        None => racer.predicted_operations(),
    };
    racers.sort_by(|a, b| needed(a).total_cmp(&needed(b)));
}

impl Simulation {
    /// Multiply-adds of the run so far, by their order of magnitude.
    pub(super) fn operations(&self) -> u64 {
        self.newton.counters.operations + self.pacer.operations()
    }

    /// True where the scene leaves the scheme open and it has not been chosen yet.
    pub(super) fn is_undecided(&self) -> bool {
        self.scene.integrator.automatic && self.choice.is_none()
    }

    /// Chooses the scheme if the scene leaves it open.
    pub(super) fn choose(&mut self) {
        if self.is_undecided() {
            self.decide();
        }
    }

    /// Chooses the scheme and continues its trial run.
    ///
    /// # Errors
    /// Those of the observer, and [`RunError::Interrupted`] where it stops the run.
    pub(super) fn continue_trial_run(
        &mut self,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let Some(first) = self.decide() else {
            return Ok(());
        };
        let Simulation {
            state, counters, ..
        } = &first.simulation;
        let foreseen = counters.steps as f64 * self.scene.simulation.duration / state.t;
        if first.error.is_some() || !first.replay.is_complete() || foreseen > MOST_STEPS {
            return Ok(());
        }
        let mut behind = std::mem::replace(self, first.simulation);
        self.scene = behind.scene.clone();
        self.choice = behind.choice.clone();
        self.is_trial_run = false;
        let mut steps_behind = 0;
        let played = first
            .replay
            .play(&self.model, observer, |steps, control, observer| {
                // a checkpoint is that of the step that the observer has seen last
                let mut rest = Replay::default();
                rest.steps_left = steps - std::mem::replace(&mut steps_behind, steps);
                match behind.run_to_end(&mut rest) {
                    Ok(()) | Err(RunError::Interrupted { .. }) => behind.obey(control, observer),
                    Err(error) => Err(error),
                }
            });
        if let Err(RunError::Interrupted { .. }) = played {
            *self = behind;
        }
        played
    }

    /// Chooses the scheme; returns its trial run.
    fn decide(&mut self) -> Option<Racer> {
        let is_stiff = self.model.states.iter().any(|state| state.is_stiff);
        let candidates = CANDIDATES.iter();
        let candidates = candidates.filter(|scheme| !(is_stiff && scheme.is_explicit));
        let mut racers: Vec<Racer> = candidates.filter_map(|s| self.racer(s)).collect();
        race(&mut racers);
        let scheme = racers.first().map_or(CANDIDATES[0], |racer| racer.scheme);
        self.choice = Some(Choice {
            method: scheme.name,
            trial_runs: racers.iter().map(Racer::run).collect(),
        });
        let method = Method::new(scheme);
        self.stepper = method.stepper(self.model.shape);
        let estimate = self.stepper.estimate();
        self.pacer = pacer(&self.scene, &self.model, &self.state, estimate);
        self.scene.integrator.method = method;
        self.instants = instants::of_method(&self.model, &self.scene.integrator);
        racers.into_iter().next()
    }

    /// The same scene with one scheme.
    fn racer(&self, scheme: &'static Scheme) -> Option<Racer> {
        let mut scene = self.scene.clone();
        scene.integrator.method = Method::new(scheme);
        scene.integrator.automatic = false;
        Some(Racer {
            scheme,
            simulation: self.trial_run(&scene)?,
            replay: Replay::default(),
            course: Vec::new(),
            retired: false,
            error: None,
        })
    }
}
