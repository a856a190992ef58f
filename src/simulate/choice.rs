//! The choice of a scheme for an accuracy, `method = "auto"`.
//!
//! Which scheme takes the least work depends on the stiffness of the mechanism, on its mesh, on its impacts and on the accuracy.
//! So pilot runs with every one of [`CANDIDATES`] race through the beginning of the motion: the one with the fewest operations
//! so far goes on. When one has seen enough, the one that has come furthest wins. Enough are [`FEWEST_STEPS`] steps and [`PART`]
//! of the run and, in a mechanism with contacts, [`IMPACTS`] of them that have closed and opened again or a whole horizon: the
//! steps of the free flight before the first impact say nothing of those that impacts take. After [`PILOT_STEPS`] it has seen
//! enough in any case. What counts are operations, not seconds, so that a scene has the same choice on every machine.

use super::foresight::PILOT_STEPS;
use super::start::pacer;
use super::{Control, Observer, Progress, RunError, Simulation};
use crate::scene::Pace;
use crate::stepper::{CANDIDATES, Method, Scheme};
use serde::Serialize;
use std::io::Result;

/// Accepted steps before the race ends: the first ones find the length that the accuracy allows.
const FEWEST_STEPS: u64 = 16;
/// Part of the run that is simulated at least.
const PART: f64 = 1.0 / 64.0;
/// Contacts that have ended: a single one may be of an unusual kind.
const IMPACTS: u64 = 4;
/// Steps that a pilot takes before the others are looked at again.
const STRIDE: u64 = 4;

/// The scheme chosen and what its choice rests on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Choice {
    /// Name of the scheme.
    pub method: &'static str,
    /// The pilot runs, the one that got furthest first.
    pub pilots: Vec<PilotRun>,
}

/// The beginning of a run with one scheme.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PilotRun {
    /// Name of the scheme.
    pub method: &'static str,
    /// Time reached \[s\].
    pub t: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Multiply-adds, by their order of magnitude.
    pub operations: u64,
    /// Why it could not go on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A pilot under way.
struct Racer {
    scheme: &'static Scheme,
    simulation: Simulation,
    error: Option<String>,
}

/// Stops a pilot after some steps.
struct Stride(u64);

impl Observer for Stride {
    fn row(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> Result<Control> {
        self.0 -= 1;
        Ok(match self.0 {
            0 => Control::Stop,
            _ => Control::Continue,
        })
    }
}

impl Racer {
    /// Takes some steps. Returns true when it has seen enough, at the latest at the end of the run.
    fn go_on(&mut self) -> bool {
        match self.simulation.run_to_end(&mut Stride(STRIDE)) {
            Ok(()) => true,
            Err(RunError::Interrupted { .. }) => self.has_seen_enough(),
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
        let has_impacts = !state.z.is_empty();
        counters.steps >= PILOT_STEPS
            || counters.steps >= FEWEST_STEPS
                && state.t >= PART * scene.simulation.duration
                && (!has_impacts || closures.ended >= IMPACTS || state.t >= horizon)
    }

    fn run(self) -> PilotRun {
        PilotRun {
            method: self.scheme.name,
            t: self.simulation.state.t,
            steps: self.simulation.counters.steps,
            operations: self.simulation.operations(),
            error: self.error,
        }
    }
}

/// Lets pilots run until one has seen enough, and puts the one first that has come furthest.
fn race(racers: &mut [Racer]) {
    loop {
        let under_way = racers.iter_mut().filter(|racer| racer.error.is_none());
        let next = under_way.min_by_key(|racer| racer.simulation.operations());
        if next.is_none_or(Racer::go_on) {
            break;
        }
    }
    let reached = |racer: &Racer| match racer.error {
        Some(_) => f64::NEG_INFINITY,
        None => racer.simulation.state.t,
    };
    racers.sort_by(|a, b| reached(b).total_cmp(&reached(a)));
}

impl Simulation {
    /// Multiply-adds of the run so far, by their order of magnitude.
    pub(super) fn operations(&self) -> u64 {
        self.newton.counters.operations + self.pacer.operations()
    }

    /// Chooses the scheme, where the scene leaves it open and it has not been chosen yet.
    pub(super) fn choose(&mut self) {
        if !self.scene.integrator.automatic || self.choice.is_some() {
            return;
        }
        let mut racers: Vec<Racer> = CANDIDATES.iter().filter_map(|s| self.racer(s)).collect();
        race(&mut racers);
        let scheme = racers.first().map_or(CANDIDATES[0], |racer| racer.scheme);
        self.choice = Some(Choice {
            method: scheme.name,
            pilots: racers.into_iter().map(Racer::run).collect(),
        });
        let method = Method::new(scheme);
        self.stepper = method.stepper(self.model.shape);
        self.pacer = pacer(&self.scene, &self.model, self.stepper.estimate());
        self.scene.integrator.method = method;
    }

    /// The same scene with one scheme.
    fn racer(&self, scheme: &'static Scheme) -> Option<Racer> {
        let mut scene = self.scene.clone();
        scene.integrator.method = Method::new(scheme);
        scene.integrator.automatic = false;
        // the scene has been compiled once
        let mut simulation = Simulation::new(&scene).ok()?;
        simulation.is_pilot = true;
        Some(Racer {
            scheme,
            simulation,
            error: None,
        })
    }
}
