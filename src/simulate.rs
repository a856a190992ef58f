//! The loop: step, locate contact onset and loss, commit memory, record.

mod arc;
mod change;
mod checkpoint;
mod choice;
mod closing;
mod closures;
mod control;
mod creep;
mod critical;
mod cubic;
mod energy;
mod equilibrium;
mod failure;
mod first_impact;
mod foresight;
mod impacts;
mod indeterminate;
mod instants;
mod load_path;
mod meter;
mod modes;
mod notes;
mod observer;
mod pace;
mod plausibility;
mod position_error;
mod recording;
mod replay;
mod report;
mod restitution;
mod scale;
mod stall;
mod start;
mod stepwise;
mod warnings;

pub use crate::record::Channel;
pub use choice::{Choice, TrialRun};
use closing::ClosingSums;
pub use closing::{Closing, ContactTime, DriveLoad, Peak, PoseError};
pub use closures::Chatter;
use closures::Closures;
pub use control::AccuracyReport;
pub use creep::Creep;
use creep::CreepWatch;
pub use critical::{CriticalKind, CriticalPoint};
pub use energy::EnergyError;
pub use equilibrium::{FoundRest, Stability};
pub use failure::RunError;
use impacts::Impacts;
pub use impacts::{Impact, Overrun};
use load_path::Heading;
pub use meter::Integration;
use meter::Meter;
pub use observer::{ContactEnd, ContactEvent, Control, Notice, Observer, Onset, Progress};
pub use recording::Recording;
pub use report::{Extreme, Inspection, Report, Status};
pub use restitution::DeliveredRestitution;

use crate::body::Strain;
use crate::checkpoint::carried;
use crate::compile::drive_limit::{self, DriveCourse};
use crate::compile::extent::extent;
use crate::initial::Freedoms;
use crate::model::{Instant, Model};
use crate::newton::Newton;
use crate::record::{Record, Recorder};
use crate::scene::{Analysis, Scene};
use crate::stepper::{LocalError, StepError, Stepper, midpoint};
use crate::system::{Changed, State, System, Work};
use control::{Candidate, Verdict};
use indeterminate::least_reactions;
use numbers::si;
use pace::Pacer;
use plausibility::Plausibility;
use stall::Stall;
use std::collections::BTreeSet;
use std::sync::{Arc, OnceLock};

/// A step is halved this many times at most before the run gives up.
const HALVINGS: i32 = 24;
/// Largest violation of a redundant constraint that was left out, relative to the largest coordinate: above rounding divided by
/// the distance from a singular pose, and far below any motion.
const LEFT_OPEN: f64 = 1e-6;
/// Lengths tried for a step that met a singular pose: this many powers of this ratio, longer ones first.
const PASSAGES: i32 = 20;
const PASSAGE_RATIO: f64 = 2.0;
/// Message for a step that ends in the second zero of a prescribed angle.
const HALF_TURN: &str = "its direction has flipped by half a turn";
/// Message for a step that turns a body by more than half a turn.
const TURN: &str = "it rotates by more than half a turn in one step";
/// A difference of times below this part of a step is rounding.
const GRID_ROUNDING: f64 = 1e-6;

/// Counts of the loop, beside those of Newton's method.
#[derive(Debug, Clone, Copy, Default)]
struct LoopCounters {
    steps: u64,
    rejected: u64,
    location_trials: u64,
    singular_pose_trials: u64,
    onsets: u64,
    unlocated: u64,
    clamps: u64,
    /// Rows recorded.
    rows: u64,
}

carried!(LoopCounters { steps, rejected, location_trials, singular_pose_trials, onsets, unlocated, clamps, rows } but {});

/// One scene, compiled and under way.
#[derive(Debug)]
pub struct Simulation {
    scene: Scene,
    model: Arc<Model>,
    /// The start before contacts close and accelerations follow, for trial runs.
    start: State,
    stepper: Box<dyn Stepper>,
    pacer: Pacer,
    /// Where functions of time end its steps.
    instants: Vec<Instant>,
    /// True where there are contacts whose changes are located.
    locates: bool,
    /// True where constraints that repeat others are left out.
    leaves_out: bool,
    newton: Newton,
    /// True on the way from one recorded row to the next.
    is_between_rows: bool,
    /// True while steps end in a singular pose whatever their length.
    stays_in_singular_pose: bool,
    /// True of a step that met a singular pose and was given another length.
    passes_singular_pose: bool,
    work: Work,
    state: State,
    trial: State,
    /// The accepted state with consistent accelerations, for output.
    output: State,
    recorder: Recorder,
    /// What was measured of it.
    measured: Record,
    extremes: Vec<Extreme>,
    closing: ClosingSums,
    /// Largest strains over the recorded rows, by body; 0 for bodies that do not deform.
    strains: Vec<Strain>,
    plausibility: Plausibility,
    impacts: Impacts,
    closures: Closures,
    creep: CreepWatch,
    meter: Meter,
    /// True of the trial runs that foresee how many steps a run takes or compare schemes.
    is_trial_run: bool,
    /// The scheme that was chosen, where the scene leaves it open.
    choice: Option<Choice>,
    local_error: LocalError,
    stall: Stall,
    counters: LoopCounters,
    /// Failed steps by the unknown or multiplier they failed for.
    halved: Vec<u64>,
    /// What passes zero where memory changes, at the trial state, at the accepted one ...
    crossings: Vec<[f64; 2]>,
    first_crossings: Vec<[f64; 2]>,
    /// ... and at two neighbouring states within the step.
    last_crossings: Vec<[f64; 2]>,
    inner_crossings: Vec<[f64; 2]>,
    /// Changes at the end of the last step.
    changed: Vec<Changed>,
    /// The equilibrium that the motion starts from, where the scene asks for one; in a static analysis the last one.
    rest: Option<FoundRest>,
    /// The joints whose reactions in a static analysis are one of many, once a row was recorded.
    indeterminate: BTreeSet<usize>,
    /// How the load path goes on from the last stable equilibrium.
    heading: Option<Heading>,
    /// Where the load path could not go on or branched.
    critical_points: Vec<CriticalPoint>,
    status: Status,
    error: Option<String>,
    ended_at_limit: bool,
    /// Those of a mechanism that is driven, once a report has asked for them: to count them the ideal mechanism is closed.
    freedoms: OnceLock<Option<Freedoms>>,
    course: OnceLock<DriveCourse>,
}

impl Simulation {
    /// What is recorded; the first channel is the time.
    pub fn channels(&self) -> &[Channel] {
        self.recorder.channels()
    }

    /// How far the drives lead the ideal rigid mechanism: followed once, when it is first asked for.
    pub fn drive_course(&self) -> &DriveCourse {
        self.course.get_or_init(|| drive_limit::follow(&self.scene))
    }

    /// The compiled mechanism.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The last accepted state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Runs to the end of the scene.
    ///
    /// # Errors
    /// See [`RunError`]; everything observed before it stands.
    pub fn run(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let result = match self.scene.simulation.analysis {
            Analysis::Dynamic => self.run_to_end(observer),
            Analysis::Static => self.run_loads(observer),
        };
        let closed = match &result {
            Err(RunError::Output(_)) => Ok(()),
            _ => self.impacts.finish(&self.model, observer),
        };
        let result = result.and_then(|()| Ok(closed?));
        let result = result.map_err(|error| self.at_limit(error));
        self.ended_at_limit = matches!(result, Err(RunError::DriveLimit(_)));
        (self.status, self.error) = match &result {
            Ok(()) => (Status::Complete, None),
            Err(RunError::Interrupted { .. }) => (Status::Incomplete, None),
            Err(error) => (Status::Failed, Some(error.to_string())),
        };
        result
    }

    fn run_to_end(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let (interval, duration) = (self.scene.output.interval, self.scene.simulation.duration);
        // a remainder of the duration below this is the rounding of duration/interval
        let rows = (duration / interval + GRID_ROUNDING).floor() as u64;
        if self.counters.rows == 0 && self.is_undecided() {
            self.continue_trial_run(observer)?;
        }
        if self.counters.rows == 0 {
            self.tell_onsets(observer)?;
            self.record(observer)?;
        }
        while self.counters.rows <= rows {
            let next = self.counters.rows as f64 * interval;
            self.advance(next.min(duration), observer)?;
            self.record(observer)?;
        }
        self.advance(duration, observer)
    }

    /// Steps to `target`, stopping at every contact onset and loss on the way.
    fn advance(&mut self, target: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        self.choose();
        if !std::mem::replace(&mut self.is_between_rows, true) {
            self.pacer.begin(self.state.t);
        }
        self.model.crossings(&self.state, &mut self.first_crossings);
        let (mut end, mut instant) = self.stop(target);
        while self.state.t < target {
            if self.state.t >= end {
                instant.map_or(Ok(()), |instant| self.pass(instant, observer))?;
                (end, instant) = self.stop(target);
                self.pacer.begin(self.state.t);
                continue;
            }
            let goal = self.pacer.goal(self.state.t, end);
            let (mut clamps, mut reached) = self.try_step(goal)?;
            if matches!(self.pacer, Pacer::Controller(_)) {
                self.passes_singular_pose = false;
                (clamps, reached) = self.pass_singular_pose((clamps, reached), end)?;
            }
            self.estimate_error();
            if let Pacer::Controller(controller) = &mut self.pacer {
                let step = Candidate {
                    from: &self.state,
                    to: &self.trial,
                    error: &self.local_error,
                    goal,
                    passes_singular_pose: self.passes_singular_pose,
                };
                match controller.judge(&self.model, &mut self.work, &step) {
                    Verdict::Keep if self.counters.steps == 0 => self.foresee()?,
                    Verdict::Keep => {}
                    Verdict::Repeat => continue,
                    Verdict::Stuck(worst) => {
                        let name = controller.name(&self.model, worst);
                        return Err(self.stuck(name));
                    }
                }
            }
            if self.locates {
                clamps = self.locate_change(clamps, reached)?;
                if self.trial.t != reached {
                    self.estimate_error();
                }
            } else {
                self.model.crossings(&self.trial, &mut self.crossings);
            }
            self.meter.step(&self.state, &self.trial, &self.local_error);
            self.stepper.accept();
            std::mem::swap(&mut self.state, &mut self.trial);
            self.counters.steps += 1;
            self.counters.clamps += clamps as u64;
            let taken = self.state.t - self.trial.t;
            if self.leaves_out {
                self.check_left_out()?;
            }
            self.commit(observer)?;
            let impacts = &mut self.impacts;
            impacts.step(&self.model, taken, &self.state, &self.crossings, observer)?;
            match self.changed.is_empty() {
                true => std::mem::swap(&mut self.crossings, &mut self.first_crossings),
                false => {
                    self.model.crossings(&self.state, &mut self.first_crossings);
                    (end, instant) = self.stop(target);
                }
            }
            self.closures.step(self.state.t, &self.changed);
            let stalled = self.stall.step(self.state.t, &self.changed);
            stalled.map_err(|stalled| self.stalled(stalled))?;
            self.pacer.kept(&self.state, goal, &self.changed);
            let contacts = self.model.closed(&self.state).count();
            let progress = Progress {
                t: self.state.t,
                duration: self.scene.simulation.duration,
                contacts: Some(contacts),
            };
            let control = observer.step(&progress)?;
            self.obey(control, observer)?;
        }
        self.is_between_rows = false;
        Ok(())
    }

    /// Hands over a checkpoint and stops where the observer asks for it.
    fn obey(&mut self, control: Control, observer: &mut dyn Observer) -> Result<(), RunError> {
        if control != Control::Continue {
            observer.checkpoint(self.state.t, &self.checkpoint())?;
        }
        match control {
            Control::Stop => Err(RunError::Interrupted { t: self.state.t }),
            _ => Ok(()),
        }
    }

    /// Steps into `trial` towards `target` and halves the step while it fails; returns the clamps and the time reached.
    /// The next step has full length again: a full step passes a singular pose that shorter ones only approach.
    fn try_step(&mut self, target: f64) -> Result<(usize, f64), RunError> {
        let mut t = target;
        loop {
            match self.step_to(t) {
                Ok(clamps) => return Ok((clamps, t)),
                Err(error) => {
                    self.newton.forget_step();
                    self.counters.rejected += 1;
                    self.stall.failure();
                    if let Some(index) = error.index() {
                        self.halved[index] += 1;
                    }
                    let half = 0.5 * (t - self.state.t);
                    if half < self.pacer.scale() * 2.0_f64.powi(-HALVINGS) {
                        return Err(self.failed(error, 2.0 * half));
                    }
                    t = self.state.t + half;
                }
            }
        }
    }

    /// Repeats a step that met a singular pose with other lengths, at most to `target`, until it passes the pose. The
    /// argument and the result are those of [`Simulation::try_step`]. If no length passes the pose, the mechanism stays in it:
    /// the step is kept, and so are the following ones, until one does not meet a singular pose.
    ///
    /// In such a pose the constraints do not determine the acceleration in the direction they have lost, and Newton's method
    /// does not determine the position. Neither can be used for the error estimate or for the next step.
    fn pass_singular_pose(
        &mut self,
        step: (usize, f64),
        target: f64,
    ) -> Result<(usize, f64), RunError> {
        let meets = self.newton.met_singular_pose();
        if !meets || self.stays_in_singular_pose {
            self.stays_in_singular_pose = meets;
            return Ok(step);
        }
        self.passes_singular_pose = true;
        let (t, (_, reached)) = (self.state.t, step);
        let longer = (1..=PASSAGES).map(|k| (reached - t) * PASSAGE_RATIO.powi(k));
        let shorter = (1..=PASSAGES).map(|k| (reached - t) * PASSAGE_RATIO.powi(-k));
        for length in longer.filter(|length| t + length <= target).chain(shorter) {
            self.counters.singular_pose_trials += 1;
            self.newton.forget_step();
            let step = self.try_step(t + length)?;
            if !self.newton.met_singular_pose() {
                return Ok(step);
            }
        }
        self.stays_in_singular_pose = true;
        self.try_step(reached)
    }

    /// The local error of the trial step. With an accuracy, the part of it that does not stay in the motion is filtered out.
    fn estimate_error(&mut self) {
        let Simulation {
            stepper,
            pacer,
            model,
            state,
            trial,
            output,
            newton,
            work,
            local_error,
            ..
        } = self;
        if stepper.needs_midpoint(state) {
            midpoint(&**model, state, trial, output, newton, work);
        }
        stepper.local_error(state, trial, output, local_error);
        // equal steps do not depend on the estimate: the two solves would only refine the reported error
        if let Pacer::Controller(_) = pacer {
            let implicit = stepper.estimate().implicit;
            let LocalError { q, v } = local_error;
            newton.filter(&**model, implicit, &trial.v, [q, v]);
        }
    }

    fn step_to(&mut self, t: f64) -> Result<usize, StepError> {
        self.newton.forget_singular_pose();
        let Simulation {
            stepper,
            model,
            state,
            trial,
            newton,
            work,
            ..
        } = self;
        let clamps = stepper.step(&**model, state, t, trial, newton, work)?;
        check_turns(model, state, trial)?;
        Ok(clamps)
    }

    /// Opens and closes contacts.
    fn commit(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            changed,
            crossings,
            ..
        } = self;
        changed.clear();
        let tolerance = self.scene.integrator.onset_tolerance;
        model.commit(state, crossings, tolerance, &mut |change| {
            changed.push(change)
        });
        self.counters.onsets += self.impacts.begin_all(model, changed, state);
        let is_switch = |change: &Changed| matches!(change, Changed::Switch { .. });
        if changed.iter().any(is_switch) {
            self.make_consistent()?;
        }
        self.tell_onsets(observer)
    }

    fn tell_onsets(&self, observer: &mut dyn Observer) -> Result<(), RunError> {
        for contact in self.changed.iter().filter_map(|change| change.closed()) {
            if let Some(onset) = self.impacts.onset(&self.model, contact) {
                observer.onset(&onset)?;
            }
        }
        Ok(())
    }

    /// Records a row at the accepted state, with accelerations and multipliers of the acceleration level. A step with constraints
    /// ends with these ([`crate::stepper::Scheme::keeps_constraints`]), but they change where a contact changes at its end.
    fn record(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            output,
            newton,
            work,
            recorder,
            measured,
            extremes,
            closing,
            impacts,
            strains,
            plausibility,
            meter,
            scene,
            creep,
            leaves_out,
            indeterminate,
            ..
        } = self;
        output.copy_from(state);
        if *leaves_out && scene.simulation.analysis == Analysis::Static {
            indeterminate.extend(least_reactions(model, extent(scene), output, work));
        }
        let shape = model.shape();
        let is_consistent = shape.multipliers > 0 && shape.contacts == 0;
        if scene.simulation.analysis == Analysis::Dynamic
            && !is_consistent
            && let Err(failure) = newton.make_consistent(&**model, output, work)
        {
            return Err(self.failed(failure.into(), 0.0));
        }
        measured.take(model, output);
        creep.row(model, output);
        plausibility.row(scene, model, output);
        if scene.simulation.analysis == Analysis::Dynamic
            && let Err(gain) = meter.row(model, &measured.energies, output)
        {
            return Err(self.unstable(gain));
        }
        let row = recorder.row(model, output, measured, work);
        // coordinates can be finite where their squares overflow
        if let Some(channel) = row.iter().position(|x| !x.is_finite()) {
            let channel = recorder.channels()[channel].name.clone();
            return Err(self.overflown(&channel));
        }
        for (largest, strain) in strains.iter_mut().zip(&measured.strains) {
            largest.see(strain);
        }
        if closing.counts(output.t) {
            for (extreme, value) in extremes.iter_mut().zip(row) {
                extreme.see(*value, output.t);
            }
            closing.row(model, output, impacts);
        }
        self.counters.rows += 1;
        observer.state(model, output)?;
        Ok(observer.row(row)?)
    }

    /// Checks that a constraint that was left out is still satisfied; a prescribed motion may contradict the others.
    fn check_left_out(&self) -> Result<(), RunError> {
        let size = self.state.q.iter().fold(0.0_f64, |m, q| m.max(q.abs()));
        match self.model.widest_left_out(&self.state) {
            Some((index, open, unit)) if open > LEFT_OPEN * size => Err(RunError::Physics {
                name: self.model.unknown_name(index),
                cause: format!(
                    "the other constraints contradict it; it is violated by {}",
                    si(open, unit)
                ),
                t: self.state.t,
                step: self.state.t - self.trial.t,
            }),
            _ => Ok(()),
        }
    }
}

/// Refuses a step that may have added a turn to a body or a half turn to a prescribed angle.
fn check_turns(model: &Model, from: &State, to: &State) -> Result<(), StepError> {
    let half = model.half_turned(to).map(|index| (index, HALF_TURN));
    let full_turn = || model.full_turn(from, to).map(|index| (index, TURN));
    match half.or_else(full_turn) {
        Some((index, cause)) => Err(StepError::Turn { index, cause }),
        None => Ok(()),
    }
}
