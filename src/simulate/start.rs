//! A simulation before its first step.

use super::closing::ClosingSums;
use super::closures::Closures;
use super::control::Controller;
use super::creep::CreepWatch;
use super::failure::describe;
use super::impacts::Impacts;
use super::meter::Meter;
use super::pace::Pacer;
use super::plausibility::Plausibility;
use super::report::{Extreme, Status};
use super::stall::Stall;
use super::{LoopCounters, Simulation, equilibrium, instants, scale};
use crate::body::{Moving, Strain};
use crate::compile::compile;
use crate::compile::extent::extent;
use crate::initial;
use crate::initial::redundancy::{Ranks, Redundancy};
use crate::model::Model;
use crate::newton::Newton;
use crate::record::{Record, Recorder};
use crate::scene::{Analysis, Pace, Scene, SceneError};
use crate::stepper::{Estimate, LocalError};
use crate::system::{State, System};
use std::sync::{Arc, OnceLock};

impl Simulation {
    /// Compiles a scene, closes its mechanism and makes its start consistent.
    ///
    /// # Errors
    /// A mechanism that cannot close, be driven or start as the scene says.
    pub fn new(scene: &Scene) -> Result<Simulation, SceneError> {
        // a number in a wrong unit may be what keeps a mechanism from closing
        let explained = |error| {
            scene
                .implausible()
                .into_iter()
                .fold(error, SceneError::with_help)
        };
        Simulation::assembled(scene).map_err(explained)
    }

    fn assembled(scene: &Scene) -> Result<Simulation, SceneError> {
        let compiled = compile(scene)?;
        let state = initial::start(scene, &compiled)?;
        let mut model = compiled.model;
        keep_independent(scene, &mut model, &state)?;
        refuse_constraints(scene, &model)?;
        Simulation::begin(scene, Arc::new(model), state)
    }

    /// A run aside of the same mechanism, which is not compiled again; the scene may have another scheme or accuracy.
    pub(super) fn trial_run(&self, scene: &Scene) -> Option<Simulation> {
        let model = Arc::clone(&self.model);
        let mut run = Simulation::begin(scene, model, self.start.clone()).ok()?;
        run.is_trial_run = true;
        Some(run)
    }

    fn begin(scene: &Scene, model: Arc<Model>, start: State) -> Result<Simulation, SceneError> {
        let shape = model.shape();
        let mut state = start.clone();
        let size = scale::size(scene, &model, &state);
        let mut newton = Newton::new(&*model, scene.integrator.newton_tolerance_for(size));
        let mut work = model.work();
        let mut changed = Vec::with_capacity(shape.contacts);
        let mut crossings = vec![[0.0; 2]; shape.crossings];
        model.crossings(&state, &mut crossings);
        model.commit(
            &mut state,
            &crossings,
            scene.integrator.onset_tolerance,
            &mut |change| changed.push(change),
        );
        let rest = equilibrium::prepare(scene, &model, &mut newton, &mut state, &mut work)?;
        if scene.simulation.analysis == Analysis::Dynamic {
            newton
                .make_consistent(&*model, &mut state, &mut work)
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
        let onsets = impacts.begin_all(&model, &changed, &state);
        let recorder = Recorder::new(scene, &model, model.energies(&state).total())?;
        let extremes = vec![Extreme::default(); recorder.channels().len()];
        let stepper = scene.integrator.method.stepper(model.shape());
        let pacer = pacer(scene, &model, &state, stepper.estimate());
        Ok(Simulation {
            stepper,
            pacer,
            instants: instants::of_method(&model, &scene.integrator),
            leaves_out: !model.redundant().is_empty(),
            locates: scene.integrator.locate_onsets && shape.crossings > 0,
            newton,
            is_between_rows: false,
            stays_in_singular_pose: false,
            passes_singular_pose: false,
            work,
            meter: Meter::new(scene, &model, &state),
            closing: ClosingSums::new(scene, &model),
            is_trial_run: false,
            choice: None,
            start,
            trial: state.clone(),
            output: state.clone(),
            state,
            recorder,
            measured: Record::default(),
            extremes,
            strains: vec![Strain::default(); scene.bodies.len()],
            plausibility: Plausibility::default(),
            impacts,
            closures: Closures::new(shape.contacts),
            creep: CreepWatch::new(shape.contacts),
            local_error: LocalError::new(shape.unknowns),
            stall: Stall::new(
                [shape.contacts, model.forces.len()],
                scene.simulation.duration,
                scene.integrator.step(),
            ),
            counters: LoopCounters {
                onsets,
                ..LoopCounters::default()
            },
            halved: vec![0; shape.unknowns + shape.multipliers],
            first_crossings: crossings.clone(),
            last_crossings: crossings.clone(),
            inner_crossings: crossings.clone(),
            crossings,
            changed,
            rest,
            indeterminate: Default::default(),
            heading: None,
            critical_points: Vec::new(),
            status: Status::Incomplete,
            error: None,
            ended_at_limit: false,
            freedoms: OnceLock::new(),
            course: OnceLock::new(),
            model,
            scene: scene.clone(),
        })
    }
}

/// What chooses the steps from a start.
pub(super) fn pacer(scene: &Scene, model: &Model, start: &State, estimate: Estimate) -> Pacer {
    match scene.integrator.pace {
        Pace::Step(step) => Pacer::grid(step),
        Pace::Accuracy(accuracy) => {
            let controller = Controller::new(scene, model, start, accuracy, estimate);
            Pacer::Controller(Box::new(controller))
        }
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

/// True where a motion is prescribed, by a drive or by the path of a body.
fn is_driven(scene: &Scene) -> bool {
    let mut bodies = scene.bodies.iter();
    let moves = bodies.any(|body| body.kind.get::<Moving>().is_some());
    moves || !(scene.motions.is_empty() && scene.drives.is_empty())
}

/// Removes redundant constraints from the equations.
fn keep_independent(scene: &Scene, model: &mut Model, start: &State) -> Result<(), SceneError> {
    let ranks = Ranks::of(model, start, extent(scene));
    match ranks.redundancy() {
        Redundancy::Rows(rows) => {
            // without a prescribed motion no unknown that moves is determined
            let has_determined = model.shape().multipliers > 0 && is_driven(scene);
            if let Some(determined) = has_determined.then(|| ranks.determined()) {
                model.determined = determined;
            }
            model.drop_rows(&rows);
            Ok(())
        }
        Redundancy::SingularStart(name) => {
            let message = format!(
                "the start is a singular pose, in which {name} depends on the other constraints"
            );
            let error = scene.error(scene.initial.span, message, "this start");
            Err(error.with_help("start slightly away from the dead centre"))
        }
        Redundancy::Shaky(name) => {
            // of a point without its axis
            let what = name.rsplit_once('.').map_or(&*name, |(what, _)| what);
            let message = format!(
                "the constraints lose rank at the start: {what} can move to first order but not to second, so the mechanism is rigid \
                 but shaky, and its constraint forces have no bound"
            );
            let error = scene.error(scene.initial.span, message, "this start");
            Err(error.with_help(
                "change a length or move a joint, so that the joints there do not lie in one line; a drive may start slightly away \
                 from a dead centre",
            ))
        }
    }
}
