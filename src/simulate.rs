//! The loop: step, locate contact onset and loss, commit memory, record.

mod change;
mod closures;
mod control;
mod equilibrium;
mod foresight;
mod impacts;
mod meter;
mod observer;
mod pace;
mod recording;
mod report;
mod resume;
mod stall;
mod top;
mod warnings;

pub use crate::record::Channel;
pub use closures::Chatter;
use closures::Closures;
pub use control::AccuracyReport;
use impacts::Impacts;
pub use impacts::{Impact, Overrun};
pub use meter::Integration;
use meter::{Gain, Meter};
pub use observer::{Contact, Control, End, Notice, Observer, Onset, Progress};
pub use recording::Recording;
pub use report::{Extreme, Inspection, Report, Status};

use crate::compile::compile;
use crate::initial::{self, redundancy};
use crate::model::Model;
use crate::newton::{Failure, Newton};
use crate::record::Recorder;
use crate::scene::{Accuracy, Analysis, Pace, Scene, SceneError};
use crate::statics::Statics;
use crate::stepper::{LocalError, StepError, Stepper, look_ahead};
use crate::system::{PrescribeError, State, System, Work};
use control::{Candidate, Controller, Verdict};
use pace::Pacer;
use stall::{Stall, Stalled};

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

/// Why a run ended early.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The method found no solution of the equations.
    #[error("{name}: {cause} at t = {t} s (last step tried: {} s)", short(step))]
    Physics {
        /// Coordinate or constraint.
        name: String,
        /// What happened.
        cause: String,
        /// When \[s\].
        t: f64,
        /// The last step tried \[s\].
        step: f64,
    },
    /// Even the shortest step is too long for the accuracy of the scene.
    #[error(
        "the accuracy of {accuracy} cannot be reached at t = {t} s: the estimated error of {name} is too large even with a step of \
         {} s{}; a larger `position`, a shorter `horizon` or a method of higher order may help",
        short(step),
        if *in_singular_pose {
            ", in a singular pose, near which rounding moves the mechanism"
        } else {
            ""
        }
    )]
    Accuracy {
        /// Coordinate with the largest error, or the energy balance.
        name: String,
        /// When \[s\].
        t: f64,
        /// The last step tried \[s\].
        step: f64,
        /// The accuracy asked for.
        accuracy: Accuracy,
        /// True where the step had to pass a singular pose.
        in_singular_pose: bool,
    },
    /// The accuracy takes more steps than a run may take.
    #[error(
        "the accuracy of {accuracy} takes about {} steps for the error of {name}, more than the 1e8 that a run may take; {}",
        short(steps),
        affordable.map_or_else(
            || "so does a looser one with this method".to_owned(),
            |accuracy| format!("{accuracy} can be afforded")
        )
    )]
    Unaffordable {
        /// What was asked for.
        accuracy: Accuracy,
        /// The number of steps foreseen.
        steps: f64,
        /// Coordinate with the largest error.
        name: String,
        /// What takes fewer than 1e8 steps; `None` where stability keeps the steps of the method short.
        affordable: Option<Accuracy>,
    },
    /// The integrator has put far more energy into the motion than the scene supplies.
    #[error(
        "{name}: the method is unstable with these steps: up to t = {t} s the integrator has added {} J, \
         the scene {} J",
        short(gained),
        short(supplied)
    )]
    Unstable {
        /// Coordinate with the largest velocity.
        name: String,
        /// When \[s\].
        t: f64,
        /// Energy gained \[J\].
        gained: f64,
        /// Energy supplied: that at the start plus the work of drives, loads and weight since \[J\].
        supplied: f64,
    },
    /// The steps are so short that the run would not end.
    #[error(
        "the steps are too short for the run to end, at t = {t} s after {steps} steps: {cause}"
    )]
    Stalled {
        /// When \[s\].
        t: f64,
        /// Which joint chatters, or which coordinate makes the steps short.
        cause: String,
        /// Steps so far.
        steps: u64,
    },
    /// No equilibrium was found.
    #[error("no equilibrium at t = {t}: {name}: {cause}")]
    Equilibrium {
        /// Coordinate or constraint.
        name: String,
        /// What happened.
        cause: String,
        /// The load factor.
        t: f64,
    },
    /// The prescribed motion cannot be followed.
    #[error(transparent)]
    Drive(#[from] PrescribeError),
    /// The observer asked to stop.
    #[error("interrupted at t = {t} s")]
    Interrupted {
        /// When \[s\].
        t: f64,
    },
    /// Results could not be stored.
    #[error("{0}")]
    Output(#[from] std::io::Error),
}

/// A number as messages print it.
fn short(value: &f64) -> String {
    numbers::number(*value, 2)
}

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
}

/// One scene, compiled and under way.
#[derive(Debug)]
pub struct Simulation {
    scene: Scene,
    model: Model,
    stepper: Box<dyn Stepper>,
    pacer: Pacer,
    /// True where there are contacts whose changes are located.
    locates: bool,
    /// True where constraints that repeat others are left out.
    leaves_out: bool,
    newton: Newton,
    /// True while steps end in a singular pose whatever their length.
    stays_in_singular_pose: bool,
    /// True of a step that met a singular pose and was given another length.
    passes_singular_pose: bool,
    statics: Option<Statics>,
    work: Work,
    state: State,
    trial: State,
    /// The accepted state made consistent, for output.
    output: State,
    recorder: Recorder,
    extremes: Vec<Extreme>,
    /// Axial strain of largest magnitude over the recorded rows, by body; 0 for bodies that do not deform.
    strains: Vec<f64>,
    impacts: Impacts,
    closures: Closures,
    meter: Meter,
    /// True of the pilot that foresees how many steps a run takes.
    is_pilot: bool,
    local_error: LocalError,
    stall: Stall,
    counters: LoopCounters,
    /// Failed steps by the unknown or multiplier they failed for.
    halved: Vec<u64>,
    delta: Vec<f64>,
    rate: Vec<f64>,
    /// Distance of every contact to its next change, and its rate, at the last state examined.
    last_gaps: Vec<[f64; 2]>,
    started: Vec<(usize, f64, f64)>,
    status: Status,
    error: Option<String>,
}

impl Simulation {
    /// Compiles a scene, closes its mechanism and makes its start consistent.
    ///
    /// # Errors
    /// A mechanism that cannot close, be driven or start as the scene says.
    pub fn new(scene: &Scene) -> Result<Simulation, SceneError> {
        let compiled = compile(scene)?;
        let mut state = initial::start(scene, &compiled)?;
        let mut model = compiled.model;
        keep_independent(scene, &mut model, &state)?;
        refuse_constraints(scene, &model)?;
        let mut newton = Newton::new(&model, scene.integrator.newton_tolerance);
        let mut work = model.work();
        let shape = model.shape();
        let mut started = Vec::with_capacity(shape.contacts);
        model.commit(
            &mut state,
            scene.integrator.onset_tolerance,
            &mut |c, v, d| started.push((c, v, d)),
        );
        let statics = equilibrium::prepare(scene, &model, &mut state, &mut work)?;
        if scene.simulation.analysis == Analysis::Dynamic {
            newton
                .make_consistent(&model, &mut state, &mut work)
                .map_err(|failure| {
                    let (name, cause) = describe(&model, &failure);
                    scene.error(
                        scene.initial.span,
                        format!("the start has no accelerations: {name}: {cause}"),
                        "this start",
                    )
                })?;
        }
        model.powers(&mut state, &mut work);
        let mut impacts = Impacts::new(scene, &model);
        for &(contact, velocity, delta) in &started {
            impacts.begin(&model, contact, [delta, velocity], &state);
        }
        let recorder = Recorder::new(scene, &model, model.energies(&state).total())?;
        let extremes = vec![Extreme::default(); recorder.channels().len()];
        let stepper = scene.integrator.method.stepper(model.shape());
        let pacer = match scene.integrator.pace {
            Pace::Step(step) => Pacer::grid(step),
            Pace::Accuracy(accuracy) => {
                let estimate = stepper.estimate();
                Pacer::Controller(Box::new(Controller::new(scene, &model, accuracy, estimate)))
            }
        };
        Ok(Simulation {
            stepper,
            pacer,
            leaves_out: !model.redundant().is_empty(),
            locates: scene.integrator.locate_onsets && shape.contacts > 0,
            newton,
            stays_in_singular_pose: false,
            passes_singular_pose: false,
            statics,
            work,
            meter: Meter::new(scene, &model, &state),
            is_pilot: false,
            trial: state.clone(),
            output: state.clone(),
            state,
            recorder,
            extremes,
            strains: vec![0.0; scene.bodies.len()],
            impacts,
            closures: Closures::new(shape.contacts),
            local_error: LocalError::new(shape.unknowns),
            stall: Stall::new(
                shape.contacts,
                scene.simulation.duration,
                scene.integrator.step(),
            ),
            counters: LoopCounters {
                onsets: started.len() as u64,
                ..LoopCounters::default()
            },
            halved: vec![0; shape.unknowns + shape.multipliers],
            delta: vec![0.0; shape.contacts],
            rate: vec![0.0; shape.contacts],
            last_gaps: vec![[0.0; 2]; shape.contacts],
            started,
            status: Status::Incomplete,
            error: None,
            model,
            scene: scene.clone(),
        })
    }

    /// What is recorded; the first channel is the time.
    pub fn channels(&self) -> &[Channel] {
        self.recorder.channels()
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
        self.tell_onsets(observer)?;
        self.record(observer)?;
        for k in 1..=rows {
            self.advance((k as f64 * interval).min(duration), observer)?;
            self.record(observer)?;
        }
        self.advance(duration, observer)
    }

    /// Steps to `target`, stopping at every contact onset and loss on the way.
    fn advance(&mut self, target: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        self.pacer.begin(self.state.t);
        while self.state.t < target {
            let goal = self.pacer.goal(self.state.t, target);
            let (mut clamps, mut reached) = self.try_step(goal)?;
            if matches!(self.pacer, Pacer::Controller(_)) {
                self.passes_singular_pose = false;
                (clamps, reached) = self.pass_singular_pose((clamps, reached), target)?;
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
            impacts.step(&self.model, taken, &self.state, observer)?;
            let (before, after) = (&self.trial.z, &self.state.z);
            self.closures.step(&self.model, self.state.t, before, after);
            self.stall
                .step(self.state.t, before, after)
                .map_err(|stalled| self.stalled(stalled))?;
            let onsets = self.started.iter().map(|(contact, ..)| *contact);
            self.pacer.kept(&self.state, goal, onsets);
            let contacts = self.state.z.iter().filter(|z| **z > 0.0).count();
            let progress = Progress {
                t: self.state.t,
                duration: self.scene.simulation.duration,
                contacts: Some(contacts),
            };
            if observer.step(&progress)? == Control::Stop {
                return Err(RunError::Interrupted { t: self.state.t });
            }
        }
        Ok(())
    }

    /// Steps into `trial` towards `target` and halves the step while it fails; returns the clamps and the time reached.
    /// The next step has full length again: a full step passes a singular pose that shorter ones only approach.
    fn try_step(&mut self, target: f64) -> Result<(usize, f64), RunError> {
        let mut t = target;
        loop {
            match self.step_to(t) {
                Ok(clamps) => return Ok((clamps, t)),
                Err(error) => {
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
        if stepper.looks_ahead(state) {
            look_ahead(model, state, trial, output, newton, work);
        }
        stepper.local_error(state, trial, output, local_error);
        // equal steps do not depend on the estimate: the two solves would only refine the reported error
        if let Pacer::Controller(_) = pacer {
            let implicit = stepper.estimate().implicit;
            for e in [&mut local_error.q, &mut local_error.v] {
                newton.filter(model, implicit, &trial.v, e);
            }
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
        let clamps = stepper.step(model, state, t, trial, newton, work)?;
        check_turns(model, state, trial)?;
        Ok(clamps)
    }

    /// Opens and closes contacts.
    fn commit(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            started,
            ..
        } = self;
        started.clear();
        let tolerance = self.scene.integrator.onset_tolerance;
        let onsets = model.commit(state, tolerance, &mut |c, velocity, delta| {
            started.push((c, velocity, delta))
        });
        self.counters.onsets += onsets as u64;
        for &(contact, velocity, delta) in started.iter() {
            self.impacts.begin(model, contact, [delta, velocity], state);
        }
        self.tell_onsets(observer)
    }

    fn tell_onsets(&self, observer: &mut dyn Observer) -> Result<(), RunError> {
        for &(contact, ..) in &self.started {
            if let Some(onset) = self.impacts.onset(&self.model, contact) {
                observer.onset(&onset)?;
            }
        }
        Ok(())
    }

    /// Records a row at the accepted state, with accelerations and multipliers of the acceleration level.
    fn record(&mut self, observer: &mut dyn Observer) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            output,
            newton,
            work,
            recorder,
            extremes,
            strains,
            meter,
            ..
        } = self;
        output.copy_from(state);
        if self.scene.simulation.analysis == Analysis::Dynamic
            && let Err(failure) = newton.make_consistent(model, output, work)
        {
            return Err(self.failed(failure.into(), 0.0));
        }
        if self.scene.simulation.analysis == Analysis::Dynamic
            && let Err(gain) = meter.row(model, output)
        {
            return Err(self.unstable(gain));
        }
        let row = recorder.row(model, output, work);
        // coordinates can be finite where their squares overflow
        if let Some(channel) = row.iter().position(|x| !x.is_finite()) {
            let channel = recorder.channels()[channel].name.clone();
            return Err(self.overflown(&channel));
        }
        for (b, largest) in strains.iter_mut().enumerate() {
            let strain = model.strain(b, output).unwrap_or_default();
            if strain.abs() > largest.abs() {
                *largest = strain;
            }
        }
        for (extreme, value) in extremes.iter_mut().zip(row) {
            extreme.see(*value, output.t);
        }
        observer.row(row)?;
        Ok(())
    }

    /// Checks that a constraint that was left out is still satisfied; a prescribed motion may contradict the others.
    fn check_left_out(&self) -> Result<(), RunError> {
        let size = self.state.q.iter().fold(0.0_f64, |m, q| m.max(q.abs()));
        match self.model.widest_left_out(&self.state) {
            Some((index, open)) if open > LEFT_OPEN * size => Err(RunError::Physics {
                name: self.model.unknown_name(index),
                cause: format!(
                    "the other constraints contradict it; it is violated by {}",
                    short(&open)
                ),
                t: self.state.t,
                step: self.state.t - self.trial.t,
            }),
            _ => Ok(()),
        }
    }

    /// The error of a row with a value that is not finite; it names the fastest coordinate.
    fn overflown(&self, channel: &str) -> RunError {
        RunError::Physics {
            name: self.meter.fastest(&self.model, &self.state).to_owned(),
            cause: format!("{channel} is not finite: the motion grows without bound"),
            t: self.state.t,
            step: self.state.t - self.trial.t,
        }
    }

    fn stuck(&self, name: String) -> RunError {
        let Pace::Accuracy(accuracy) = self.scene.integrator.pace else {
            unreachable!("only a run with an accuracy judges its steps")
        };
        RunError::Accuracy {
            name,
            t: self.state.t,
            step: self.trial.t - self.state.t,
            accuracy,
            in_singular_pose: self.passes_singular_pose,
        }
    }

    fn unstable(&self, gain: Gain) -> RunError {
        RunError::Unstable {
            name: self.meter.fastest(&self.model, &self.state).to_owned(),
            t: self.state.t,
            gained: gain.gained,
            supplied: gain.supplied,
        }
    }

    fn stalled(&self, stalled: Stalled) -> RunError {
        let halved = self.halved.iter().enumerate().max_by_key(|(_, n)| **n);
        let halved = halved.filter(|(_, n)| **n > 0);
        let step = self.state.t - self.trial.t;
        let cause = match (stalled.contact, halved) {
            (Some((contact, changes)), _) => {
                let joint = self.model.contact_joint(contact);
                let joint = joint.map_or("", |j| &self.model.joints()[j].name);
                format!("contact in {joint} was made or lost {changes} times")
            }
            (None, Some((index, times))) => format!(
                "for {} the step failed and was halved {times} times, down to {} s",
                self.model.unknown_name(index),
                short(&step)
            ),
            (None, None) => format!(
                "the error of {} limits the step to {} s",
                self.meter.worst(&self.model, &self.local_error),
                short(&step)
            ),
        };
        RunError::Stalled {
            t: self.state.t,
            cause,
            steps: stalled.steps,
        }
    }

    fn failed(&self, error: StepError, step: f64) -> RunError {
        match error {
            StepError::Prescribe(error) => RunError::Drive(error),
            StepError::Turn { index, cause } => RunError::Physics {
                name: self.model.unknown_name(index),
                cause: cause.to_owned(),
                t: self.state.t,
                step,
            },
            StepError::Stage(failure) => {
                let (name, cause) = describe(&self.model, &failure);
                RunError::Physics {
                    name,
                    cause,
                    t: self.state.t,
                    step,
                }
            }
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

/// Refuses constraint rows for a scheme that does not keep them.
fn refuse_constraints(scene: &Scene, model: &Model) -> Result<(), SceneError> {
    let shape = model.shape();
    if scene.integrator.method.scheme.keeps_constraints || shape.multipliers == 0 {
        return Ok(());
    }
    let first = &model.unknown_names()[shape.unknowns];
    let message = format!(
        "method {:?} cannot enforce constraints; the first of the {} constraints here is {first}",
        scene.integrator.method.name(),
        shape.multipliers
    );
    let error = scene.error(
        scene.integrator.method_span,
        message,
        "cannot take this scene",
    );
    Err(error.with_help(
        "use an implicit method, or \"dormand_prince\", which is explicit and enforces constraints",
    ))
}

/// Removes redundant constraints from the equations.
fn keep_independent(scene: &Scene, model: &mut Model, start: &State) -> Result<(), SceneError> {
    match redundancy::find(model, start) {
        redundancy::Redundancy::Rows(rows) => {
            model.drop_rows(&rows);
            Ok(())
        }
        redundancy::Redundancy::SingularStart(name) => {
            let message = format!(
                "the start is a singular pose, in which {name} depends on the other constraints"
            );
            let error = scene.error(scene.initial.span, message, "this start");
            Err(error.with_help("start slightly away from the dead centre"))
        }
    }
}

/// The unknown and the cause of a failure, for the message.
fn describe(model: &Model, failure: &Failure) -> (String, String) {
    match *failure {
        Failure::NoConvergence { index, update } => (
            model.unknown_name(index),
            format!(
                "Newton's method does not converge (last update {} m/s)",
                short(&update)
            ),
        ),
        Failure::NotFinite { index } => (
            model.unknown_name(index),
            "the state is not finite".to_owned(),
        ),
        Failure::Singular { index } => (
            model.unknown_name(index),
            "the equations are singular".to_owned(),
        ),
    }
}
