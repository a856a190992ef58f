//! Equilibria: the one that a motion starts from, and what becomes of a small push.

use super::failure::describe;
use super::{Simulation, scale};
use crate::model::Model;
use crate::newton::{Extent, Failure, Newton, Softest};
use crate::scene::{Analysis, Rest, Scene, SceneError};
use crate::system::{State, System, Work};
use numbers::number;
use serde::Serialize;

/// A descent leaves at most so many saddles; each lies lower than the one before.
const SADDLES: usize = 10;
/// A saddle is left by this part of the size of the mechanism: a hundredth of the longest step of a descent, so that the descent
/// itself decides where to go.
const PUSH: f64 = 1e-3;

/// Refuses what has no equilibrium in a scene that needs one; moves the start to its equilibrium where the scene asks for it.
pub(super) fn prepare(
    scene: &Scene,
    model: &Model,
    newton: &mut Newton,
    state: &mut State,
    work: &mut Work,
) -> Result<Option<FoundRest>, SceneError> {
    let rest = scene.initial.equilibrium;
    let (start, path) = (
        rest.is_some(),
        scene.simulation.analysis == Analysis::Static,
    );
    if !start && !path {
        return Ok(None);
    }
    for joint in &scene.joints {
        if joint.contact().is_some() {
            let message = format!(
                "joint {} has clearance: its bodies have no equilibrium before it closes",
                joint.name
            );
            let error = scene.error(joint.span, message, "loose");
            return Err(error.with_help(match start {
                true => "leave `initial.equilibrium` out and let the motion settle, or make the joint ideal",
                false => "make it ideal for the static analysis, or let a motion settle",
            }));
        }
    }
    let mut forces = scene.forces.iter();
    if let Some(force) = forces.find(|force| !force.kind.states().is_empty()) {
        let message = format!(
            "force {} has an internal state, which reaches its equilibrium in time only",
            force.name
        );
        let error = scene.error(force.span, message, "this force");
        return Err(error.with_help("leave it out, or let the motion settle"));
    }
    if let Some(drive) = scene.drives.first() {
        let (what, other) = match start {
            true => (
                "`initial.equilibrium`",
                "leave it out: the drive gives the pose",
            ),
            false => (
                "a static analysis",
                "prescribe the angles of the joints instead",
            ),
        };
        let message = format!("{what} cannot have inverse kinematics");
        let error = scene.error(drive.span, message, "this drive");
        return Err(error.with_help(other));
    }
    let mut bending = scene.initial.bodies.values();
    if let Some(given) = bending.find(|given| given.deformation.bending_rate != 0.0) {
        let message = "an equilibrium is at rest: it has no `bending_rate`";
        return Err(scene.error(given.span, message, "this link bends"));
    }
    if start && path {
        let message =
            "a static analysis starts from the undeformed shape: it has no `initial.equilibrium`";
        return Err(scene.error(scene.initial.span, message, "remove it"));
    }
    if start {
        let moving = scene.initial.bodies.values().map(|b| (b.velocity, b.span));
        if let Some((_, span)) = moving.into_iter().find(|(v, _)| *v != [0.0; 3]) {
            let message = "a start in equilibrium is at rest";
            return Err(scene.error(span, message, "this body moves"));
        }
        if let Some(given) = scene.initial.velocities.first() {
            let message = "a start in equilibrium is at rest";
            return Err(scene.error(given.span, message, "this body moves"));
        }
        let known = model.shape().unknowns..;
        let rates = (
            state.v[known.clone()].to_vec(),
            state.a[known.clone()].to_vec(),
        );
        let lengths = model.lengths();
        let extent = scale::extent(scene, model, state, &lengths);
        let found = match rest {
            Some(Rest::Nearest) => newton
                .balance_nearby(model, extent, state, work)
                .and_then(|()| FoundRest::of(model, newton, extent, state, work)),
            _ => come_to_rest(model, newton, extent, state, work),
        };
        let found = found.map_err(|failure| {
            let (name, cause) = explain(model, &failure, "draw the mechanism closer to it");
            let message = format!("no equilibrium was found to start from: {name}: {cause}");
            scene.error(scene.initial.span, message, "this start")
        })?;
        state.v[known.clone()].copy_from_slice(&rates.0);
        state.a[known].copy_from_slice(&rates.1);
        model.remember(state);
        return Ok(Some(found));
    }
    Ok(None)
}

/// An equilibrium, and whether it is stable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FoundRest {
    /// When \[s\], or at which t of a static analysis.
    pub t: f64,
    /// Smallest eigenvalue of the stiffness relative to the masses, on the null space of the constraints \[1/s2\]: the square of the
    /// lowest angular frequency; zero where the mechanism can move without force, negative where it would fall. Absent where it
    /// cannot move.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smallest_eigenvalue: Option<f64>,
    /// The unknown that moves most in that direction; empty where nothing can move.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub moves_most: String,
}

/// What becomes of a small push.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stability {
    /// The mechanism returns, or cannot move.
    Stable,
    /// It can move without force.
    Neutral,
    /// It falls.
    Unstable,
}

impl FoundRest {
    /// Of a state in equilibrium.
    ///
    /// # Errors
    /// Constraints that lose rank.
    pub(super) fn of(
        model: &Model,
        newton: &mut Newton,
        extent: Extent,
        state: &State,
        work: &mut Work,
    ) -> Result<FoundRest, Failure> {
        let softest = newton.softest(model, extent, state, work)?;
        Ok(FoundRest::new(model, extent, state.t, softest.as_ref()))
    }

    /// With the softest direction, where anything can move.
    fn new(model: &Model, extent: Extent, t: f64, softest: Option<&Softest>) -> FoundRest {
        let moves_most = softest.map(|softest| {
            let (most, _) = extent.farthest(softest.direction.iter().copied());
            model.unknown_name(most)
        });
        FoundRest {
            t,
            smallest_eigenvalue: softest.map(|softest| softest.eigenvalue),
            moves_most: moves_most.unwrap_or_default(),
        }
    }

    /// The same of a state at which the eigenvalue is zero but for rounding.
    pub(super) fn at_zero(self) -> FoundRest {
        FoundRest {
            smallest_eigenvalue: Some(0.0),
            ..self
        }
    }

    /// What a user should know of an equilibrium that is not stable.
    pub(super) fn note(&self) -> Option<String> {
        let (moves, t) = (&self.moves_most, number(self.t, 7));
        match self.stability() {
            Stability::Stable => None,
            Stability::Neutral => Some(format!(
                "the equilibrium at t = {t} is neutral: {moves} can move without force"
            )),
            Stability::Unstable => Some(format!(
                "the equilibrium at t = {t} is unstable: a small push of {moves} grows"
            )),
        }
    }

    /// What becomes of a small push.
    pub fn stability(&self) -> Stability {
        match self.smallest_eigenvalue {
            Some(x) if x < 0.0 => Stability::Unstable,
            Some(0.0) => Stability::Neutral,
            _ => Stability::Stable,
        }
    }
}

impl Simulation {
    /// The equilibrium in which a mechanism without loose joints and internal states rests, if it is unstable and the scene has not
    /// asked for one.
    pub(super) fn unstable_rest(&self) -> Option<FoundRest> {
        let model = &*self.model;
        if self.rest.is_some() || model.shape().contacts > 0 || !model.states.is_empty() {
            return None;
        }
        let lengths = model.lengths();
        let extent = scale::extent(&self.scene, model, &self.state, &lengths);
        // a report changes nothing of the run
        let (mut newton, mut work) = (Newton::new(model, 0.0), self.work.clone());
        let found = FoundRest::of(model, &mut newton, extent, &self.state, &mut work).ok()?;
        (found.stability() == Stability::Unstable).then_some(found)
    }
}

/// Brings a mechanism downhill to rest, and on from the saddles of its potential that it meets.
pub(super) fn come_to_rest(
    model: &Model,
    newton: &mut Newton,
    extent: Extent,
    state: &mut State,
    work: &mut Work,
) -> Result<FoundRest, Failure> {
    let mut saddles = 0;
    loop {
        newton.descend(model, extent, state, work, &mut |_| {})?;
        let softest = newton.softest(model, extent, state, work)?;
        let falls = softest.as_ref().filter(|softest| softest.eigenvalue < 0.0);
        let Some(way) = falls.filter(|_| saddles < SADDLES) else {
            return Ok(FoundRest::new(model, extent, state.t, softest.as_ref()));
        };
        let way = (&*way.direction, -way.eigenvalue, PUSH);
        newton.leave(model, extent, way, state, work)?;
        saddles += 1;
    }
}

/// The unknown and the cause of a failure to find an equilibrium, for the message, with what to do where Newton's method fails.
pub(super) fn explain(model: &Model, failure: &Failure, advice: &str) -> (String, String) {
    let name = model.unknown_name(failure.index());
    let cause = match failure {
        Failure::Singular { .. } => {
            "it is free to move: an equilibrium needs a spring, a drive or a joint that holds it"
                .to_owned()
        }
        Failure::Falls { .. } => {
            "nothing stops it: the loads move it on and on, there is no equilibrium downhill"
                .to_owned()
        }
        Failure::NoConvergence { .. } => format!("Newton's method does not converge; {advice}"),
        Failure::NotFinite { .. } => return describe(model, failure),
    };
    (name, cause)
}
