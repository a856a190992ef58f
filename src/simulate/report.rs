//! The report of a run, and the inspection of a scene before it runs.

use super::creep::Creep;
use super::pace::Pacer;
use super::restitution::{self, DeliveredRestitution};
use super::{
    AccuracyReport, Chatter, Choice, Closing, CriticalPoint, FoundRest, Impact, Integration,
    Overrun, Simulation,
};
use crate::body::{Body, CentredLink, RigidLink, Strain};
use crate::checkpoint::carried;
use crate::compile::is_ideal;
use crate::initial::{Freedoms, is_assembled};
use crate::model::{Model, PlacedBody};
use crate::record::Ledger;
use crate::scene::{Analysis, BodyState, Journals, Scene};
use crate::system::System;
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// To the end of the scene.
    Complete,
    /// Still running, or stopped from outside.
    Incomplete,
    /// It could not go on.
    Failed,
}

impl Status {
    /// Its name, as the summary has it.
    pub fn name(self) -> &'static str {
        match self {
            Status::Complete => "complete",
            Status::Incomplete => "incomplete",
            Status::Failed => "failed",
        }
    }
}

impl Serialize for Status {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Least and greatest recorded value of a channel, and when.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extreme {
    /// Least value.
    pub min: f64,
    /// When \[s\].
    pub t_min: f64,
    /// Greatest value.
    pub max: f64,
    /// When \[s\].
    pub t_max: f64,
}

carried!(Extreme { min, t_min, max, t_max } but {});

impl Default for Extreme {
    fn default() -> Extreme {
        Extreme {
            min: f64::INFINITY,
            t_min: 0.0,
            max: f64::NEG_INFINITY,
            t_max: 0.0,
        }
    }
}

impl Extreme {
    pub(super) fn see(&mut self, value: f64, t: f64) {
        if value < self.min {
            (self.min, self.t_min) = (value, t);
        }
        if value > self.max {
            (self.max, self.t_max) = (value, t);
        }
    }
}

/// The report of a run; a repeated run has the same report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// How the run ended.
    pub status: Status,
    /// Why, for a run that could not go on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// True where this is a limit of the drives, near which velocities and forces grow without bound.
    #[serde(skip)]
    pub ended_at_limit: bool,
    /// Time reached \[s\].
    pub t: f64,
    /// The scheme chosen and why, where the scene leaves it open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub choice: Option<Choice>,
    /// Evaluations of every effect present.
    pub effects: BTreeMap<String, u64>,
    /// Accepted steps.
    pub steps: u64,
    /// Stages solved, including those of rejected steps and of onset location.
    pub stages: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Factorisations of the tangent.
    pub factorisations: u64,
    /// Factorisations that needed row exchanges.
    pub fallbacks: u64,
    /// Multiply-adds of residuals, tangents, factorisations and solves, by their order of magnitude.
    pub operations: u64,
    /// Stages accepted at rounding, above the Newton tolerance.
    pub stagnations: u64,
    /// Stages that had no solution on the acceleration level and were solved on the position level.
    pub position_level_stages: u64,
    /// Stages that ended in a nearly singular pose, where the singular direction was left out.
    pub singular_poses: u64,
    /// Steps that the accuracy required; absent with equal steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<AccuracyReport>,
    /// Steps that failed and were halved.
    pub rejected_steps: u64,
    /// The same by the coordinate or constraint that failed.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub rejected_by: BTreeMap<String, u64>,
    /// Steps tried to locate contact onsets and losses.
    pub location_trials: u64,
    /// Steps tried with another length to pass a singular pose.
    pub singular_pose_trials: u64,
    /// Contacts closed.
    pub onsets: u64,
    /// The first contacts; [`super::Observer::contact`] receives all of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub impacts: Vec<Impact>,
    /// Onsets and losses kept although the gap could not be brought within the tolerance.
    pub unlocated_changes: u64,
    /// Joints whose journal has gone deeper into its bearing than the radius of the bearing.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub overrun: BTreeMap<String, Overrun>,
    /// Stages of accepted steps at which a contact force was clamped at zero.
    pub clamps: u64,
    /// Contacts that were lost again.
    pub ended_contacts: u64,
    /// Those of them that were closed for fewer than four steps.
    pub brief_contacts: u64,
    /// The first periods of chatter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub chatter: Vec<Chatter>,
    /// The equilibrium that the motion starts from, where the scene asks for one; of a static analysis the last one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest: Option<FoundRest>,
    /// The unstable equilibrium in which a motion rests throughout.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unstable_rest: Option<FoundRest>,
    /// Where the path of a static analysis reached a limit or branched.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub critical_points: Vec<CriticalPoint>,
    /// Joints that slid for long more slowly than their friction law needs for its full force.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub creep: BTreeMap<String, Creep>,
    /// Joints whose friction law was at a slip at which it may give energy, and when first \[s\].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub giving_friction: BTreeMap<String, f64>,
    /// Laws that deliver another restitution in a free impact than their contacts ask for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub restitution: Vec<DeliveredRestitution>,
    /// What was measured of the integrator; absent in a static analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub integration: Option<Integration>,
    /// Energy ledger at the end; a static analysis keeps none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ledger: Option<Ledger>,
    /// Values of the scene, and what the run does, that no machine has.
    #[serde(skip)]
    pub implausible: Vec<String>,
    /// How many degrees of freedom are driven, where drives leave some.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub freedoms: Option<String>,
    /// Redundant constraints that were left out: their multipliers are zero, and the forces of the joints of that loop are not
    /// unique.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub redundant: Vec<String>,
    /// Joints whose journals start in the middle of their bearings, because no force presses them; absent where the scene asks for that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unpressed: Option<Vec<String>>,
    /// Joints of a static analysis whose reactions the balance of forces does not determine: they are one of many, those of the least
    /// norm, torques divided by the length of the longest body between joints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub one_of_many: Vec<String>,
    /// Largest strains over the recorded rows, of every flexible link.
    pub strain: BTreeMap<String, Strain>,
    /// Extremes of the recorded channels, over the recorded rows from `output.extremes_from` on.
    pub extremes: BTreeMap<String, Extreme>,
    /// Errors of driven bodies, forces of joints, loads of drives, contacts.
    pub closing: Closing,
    /// What is in doubt of the motion that drives prescribe.
    #[serde(skip)]
    pub drive_doubt: Option<String>,
    /// What is remarkable about the scene, see [`Simulation::scene_notes`].
    #[serde(skip)]
    pub scene_notes: Vec<String>,
}

/// What will be simulated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Inspection {
    /// Unknown coordinates.
    pub unknowns: usize,
    /// Multipliers.
    pub multipliers: usize,
    /// Independent coordinates: unknown ones that are positions, less the constraints that are kept. Links that bend and journals that
    /// move in their bearings have theirs.
    pub independent: usize,
    /// Degrees of freedom with rigid links and ideal joints; none where they cannot be counted.
    pub freedoms: Option<Freedoms>,
    /// Contact terms.
    pub contacts: usize,
    /// Effects present.
    pub effects: Vec<String>,
    /// Values that the scene assumes, and values that the program derives from it.
    pub assumptions: Vec<String>,
    /// Names of the unknown coordinates.
    pub coordinates: Vec<String>,
    /// Names of the constraints, one a multiplier.
    pub constraints: Vec<String>,
}

/// Notes on values that the program derives from a scene.
fn notes(scene: &Scene, model: &Model) -> Vec<String> {
    let delivered = restitution::delivered(scene).into_iter().map(|one| {
        format!(
            "{}: {} with a restitution of {} gives {:.4} in a free impact",
            one.joints.join(", "),
            one.law,
            one.asked,
            one.delivered
        )
    });
    let mut notes: Vec<String> = delivered.collect();
    let assembled = is_assembled(scene, model);
    if assembled && scene.simulation.analysis == Analysis::Dynamic {
        notes.push("velocities missing in the scene are those of least kinetic energy".to_owned());
    }
    let unsaid = |s: &&BodyState| {
        !s.velocity_given && !assembled && scene.simulation.analysis == Analysis::Dynamic
    };
    for state in scene.initial.bodies.values().filter(unsaid) {
        notes.push(format!(
            "{} starts at rest, because the scene gives no velocity",
            scene.bodies[state.body].name
        ));
    }
    notes
}

impl Simulation {
    /// What is remarkable about the scene: tables that overshoot, channels that its mechanism does not have.
    pub fn scene_notes(&self) -> Vec<String> {
        let absent = self.recorder.absent().iter();
        self.scene.notes.iter().chain(absent).cloned().collect()
    }

    /// What no machine has, in the scene and in the run so far, each with its value and a question.
    pub fn implausible(&self) -> Vec<String> {
        let mut told = self.scene.implausible();
        told.extend(self.plausibility.told(&self.scene));
        told
    }

    /// Its degrees of freedom.
    fn freedoms(&self) -> Option<Freedoms> {
        *self.freedoms.get_or_init(|| Freedoms::of(&self.scene))
    }

    /// Its degrees of freedom, where drives prescribe some of them and leave others or repeat themselves.
    pub(super) fn partly_driven(&self) -> Option<Freedoms> {
        let is_driven = !(self.scene.motions.is_empty() && self.scene.drives.is_empty());
        let freedoms = is_driven.then(|| self.freedoms()).flatten();
        freedoms.filter(|freedoms| freedoms.left > 0 || freedoms.repeated > 0)
    }

    /// What is in doubt of the motion that drives prescribe, up to now. The ideal mechanism itself cannot pass a limit.
    fn drive_doubt(&self) -> Option<String> {
        let follows = !self.scene.drives.is_empty();
        let may_pass = follows || !(self.scene.motions.is_empty() || is_ideal(&self.scene));
        let is_asked = may_pass && !self.is_trial_run && !self.ended_at_limit;
        let course = is_asked.then(|| self.drive_course());
        course.and_then(|course| course.doubt(self.state.t))
    }

    /// Joints that are open at the start.
    fn unpressed(&self) -> Vec<String> {
        let tolerance = self.scene.integrator.onset_tolerance;
        let joints = self.model.joints().iter().enumerate();
        let open = joints.filter(|(j, _)| {
            let gap = self.model.gap(*j, &self.start);
            gap.is_some_and(|(gap, ..)| gap.delta < -tolerance)
        });
        open.map(|(_, joint)| joint.name.clone()).collect()
    }

    /// What will be simulated.
    pub fn inspect(&self) -> Inspection {
        let shape = self.model.shape();
        let (coordinates, constraints) = self.model.unknown_names().split_at(shape.unknowns);
        let redundant = self.model.redundant();
        Inspection {
            unknowns: shape.unknowns,
            multipliers: shape.multipliers,
            freedoms: self.freedoms(),
            independent: (shape.unknowns + redundant.len())
                .saturating_sub(self.model.states.len() + shape.multipliers),
            contacts: shape.contacts,
            effects: self
                .model
                .effects()
                .iter()
                .map(|name| (*name).to_owned())
                .collect(),
            assumptions: notes(&self.scene, &self.model)
                .into_iter()
                .chain(self.scene_notes())
                .chain(redundant.iter().map(|name| {
                    format!("{name} is redundant and left out: the constraint forces in its loop are not unique")
                }))
                .chain(self.coordinates_of_bodies())
                .chain(self.scene.assumptions.iter().map(|given| {
                    format!("{} = {}: {}", given.path, given.value, given.reason)
                }))
                .collect(),
            coordinates: coordinates.to_vec(),
            constraints: constraints.to_vec(),
        }
    }

    /// Which rigid bodies have which coordinates, of those that are not driven.
    fn coordinates_of_bodies(&self) -> impl Iterator<Item = String> {
        let bodies = self.model.bodies().iter();
        let free = bodies.filter(|body| self.model.is_free(body));
        let free: Vec<&PlacedBody> = free.collect();
        let names = |has: fn(&dyn Body) -> bool| -> String {
            let named = free.iter().filter(|body| has(&*body.placed.kind));
            named.map(|body| &*body.name).collect::<Vec<_>>().join(", ")
        };
        let centred = names(|kind| kind.get::<CentredLink>().is_some());
        let natural = names(|kind| kind.get::<RigidLink>().is_some());
        let held = free.iter().filter_map(|body| {
            let hold = body.placed.kind.hold()?;
            let left = match hold.line {
                None => "theta",
                Some(line) => ["x", "y"][line.along],
            };
            let joint = &self.scene.joints[hold.joint].name;
            Some(format!("{} ({left}, joint {joint})", body.name))
        });
        let notes = [
            (
                "rigid bodies with the one coordinate that an ideal joint leaves",
                held.collect::<Vec<_>>().join(", "),
            ),
            (
                "rigid links with x, y of their centres of mass and theta",
                centred,
            ),
            (
                "rigid links with natural coordinates, x, y of their ends",
                natural,
            ),
        ];
        let notes = notes.into_iter().filter(|(_, names)| !names.is_empty());
        notes.map(|(what, names)| format!("{what}: {names}"))
    }

    /// The report at this moment.
    pub fn report(&self) -> Report {
        let newton = self.newton.counters;
        let dynamic = self.scene.simulation.analysis == Analysis::Dynamic;
        let integration = dynamic.then(|| self.meter.report(&self.model));
        // forces of a run that failed are not asked again
        let rests =
            self.status == Status::Complete && integration.as_ref().is_some_and(Integration::rests);
        let bodies = self.model.bodies().iter().enumerate();
        let names = self.recorder.channels().iter().map(|c| c.name.clone());
        Report {
            status: self.status,
            error: self.error.clone(),
            ended_at_limit: self.ended_at_limit,
            t: self.state.t,
            choice: self.choice.clone(),
            effects: self
                .model
                .effects()
                .iter()
                .zip(&self.work.tally)
                .map(|(name, count)| ((*name).to_owned(), *count))
                .collect(),
            steps: self.counters.steps,
            stages: newton.stages,
            newton_iterations: newton.newton_iterations,
            factorisations: newton.factorisations,
            fallbacks: newton.fallbacks,
            operations: self.operations(),
            stagnations: newton.stagnations,
            position_level_stages: newton.position_level_stages,
            singular_poses: newton.singular_poses,
            accuracy: match &self.pacer {
                Pacer::Grid(_) => None,
                Pacer::Controller(controller) => Some(controller.report(&self.model)),
            },
            rejected_steps: self.counters.rejected,
            rejected_by: self
                .halved
                .iter()
                .enumerate()
                .filter(|(_, times)| **times > 0)
                .map(|(index, times)| (self.model.unknown_name(index), *times))
                .collect(),
            location_trials: self.counters.location_trials,
            singular_pose_trials: self.counters.singular_pose_trials,
            onsets: self.counters.onsets,
            impacts: self.impacts.listed(&self.model),
            unlocated_changes: self.counters.unlocated,
            overrun: self.impacts.overrun(&self.scene, &self.model),
            clamps: self.counters.clamps,
            ended_contacts: self.closures.ended,
            brief_contacts: self.closures.brief,
            chatter: self.closures.chatter(&self.model),
            creep: self.creep.report(&self.scene, &self.model),
            giving_friction: self.creep.giving(&self.model),
            restitution: restitution::delivered(&self.scene)
                .into_iter()
                .filter(DeliveredRestitution::differs)
                .collect(),
            rest: self.rest.clone(),
            unstable_rest: rests.then(|| self.unstable_rest()).flatten(),
            critical_points: self.critical_points.clone(),
            integration,
            ledger: dynamic.then(|| {
                self.recorder
                    .ledger(&self.model.energies(&self.state), &self.state)
            }),
            implausible: self.implausible(),
            freedoms: self.partly_driven().map(|freedoms| freedoms.to_string()),
            redundant: self.model.redundant(),
            unpressed: (self.scene.initial.journals == Journals::Pressed).then(|| self.unpressed()),
            one_of_many: self
                .indeterminate
                .iter()
                .map(|joint| self.model.joints()[*joint].name.clone())
                .collect(),
            strain: bodies
                .filter(|(_, p)| !p.placed.kind.is_rigid())
                .map(|(b, p)| (p.name.clone(), self.strains[b]))
                .collect(),
            extremes: names
                .zip(&self.extremes)
                .filter(|(_, extreme)| extreme.min <= extreme.max)
                .map(|(name, e)| (name, *e))
                .collect(),
            closing: self
                .closing
                .report(&self.model, &self.impacts, self.state.t),
            drive_doubt: self.drive_doubt(),
            scene_notes: self.scene_notes(),
        }
    }
}
