//! A compiled mechanism: immutable lists of the terms that the scene has.

mod assemble;
mod block;
mod instants;
mod measure;
mod memory;
mod reaction;

pub use crate::motion::Pose;
pub use block::{Block, Border};
pub use instants::{Instant, InstantKind};
pub use measure::Energies;
pub(crate) use memory::PlacedEvents;
pub(crate) use reaction::{DrivenForces, Grip, Source};
pub use reaction::{Reaction, Share};

use crate::body::Content;
use crate::constraint::ROWS;
use crate::contact::ContactPair;
use crate::eccentric_mass::EccentricMass;
use crate::effect::{self, Effect};
use crate::force::Force;
use crate::interaction::Placed;
use crate::ledger::{Entry, Side};
use crate::link::AncfCable;
use crate::marker::Marker;
use crate::math::lu::Symbolic;
use crate::math::plane::Vec2;
use crate::math::saddle_point::SaddlePoint;
use crate::math::sparse_product::SparseProduct;
use crate::motion::{Function, Path};
use crate::system::{InternalState, Prescribed, Shape, State, Work};
use crate::terms::{ConstraintTerm, Inertia, JointTerms};
use std::ops::Range;
use std::sync::Arc;

/// A mechanism ready to be integrated.
#[derive(Debug)]
pub struct Model {
    pub(crate) shape: Shape,
    pub(crate) symbolic: Symbolic,
    pub(crate) acceleration_matrix: SaddlePoint,
    /// Names of the unknowns, then of the multipliers.
    pub(crate) names: Vec<String>,
    /// The last unknowns, which are internal states.
    pub(crate) states: Vec<InternalState>,
    /// Unknown angles of rigid bodies.
    pub(crate) angles: Vec<usize>,
    /// True of unknowns that prescribed motions determine through the constraints alone.
    pub(crate) determined: Vec<bool>,
    /// Index of the effect of inverse kinematics, if there is one, and of that of elements.
    pub(crate) kinematics_counter: usize,
    pub(crate) elastic_counter: usize,
    /// Effects present, in the order of their counters.
    pub(crate) effects: Vec<Effect>,
    pub(crate) mass: Mass,
    pub(crate) eccentric: Vec<PlacedEccentric>,
    pub(crate) elements: Vec<PlacedElement>,
    pub(crate) constraints: Vec<PlacedConstraint>,
    pub(crate) forces: Vec<PlacedForce>,
    /// Evaluations of each effect in one residual; contacts are counted separately, because they may be open.
    pub(crate) counts: Vec<(usize, u64)>,
    /// Instants at which functions of time are not smooth.
    pub(crate) instants: Vec<Instant>,
    /// Entries of the energy ledger.
    pub(crate) ledger: Vec<&'static Entry>,
    /// Forces that have memory.
    pub(crate) events: Vec<PlacedEvents>,
    /// Forces with a name of their own, as indices into the forces.
    pub(crate) named_forces: Vec<(String, usize)>,
    /// In the order of their memory.
    pub(crate) contacts: Vec<PlacedContact>,
    /// Weight: (coordinate, force on the left side of the equations of motion) \[N\].
    pub(crate) weight: Vec<(usize, f64)>,
    /// Known coordinates that never change, with their values.
    pub(crate) fixed: Vec<(usize, f64)>,
    /// Coordinates known as functions of time.
    pub(crate) rules: Vec<Rule>,
    /// Prescribed motions that need memory, before they start.
    pub(crate) prescribed: Vec<Box<dyn Prescribed>>,
    /// Forces on known coordinates that move.
    pub(crate) driven: DrivenForces,
    /// Known nodes that are fixed to a known rigid body.
    pub(crate) driven_nodes: Vec<DrivenNode>,
    /// Bodies of the scene, in its order.
    pub(crate) bodies: Vec<PlacedBody>,
    /// Joints of the scene, in its order.
    pub(crate) joints: Vec<PlacedJoint>,
    /// The joint of every contact.
    pub(crate) contact_joints: Vec<Option<usize>>,
}

/// Known coordinates as a function of time.
#[derive(Debug)]
pub(crate) enum Rule {
    /// (x, y, theta) from index `x` follow a path.
    Path { x: usize, path: Arc<dyn Path> },
    /// A rigid body turns about a fixed node.
    Turn {
        /// First coordinate of the fixed node.
        pivot: usize,
        /// First coordinate of a point of the body and its place relative to the pivot at angle zero \[m\].
        point: (usize, Vec2),
        /// The angle as a coordinate, of a body that has it.
        theta: Option<usize>,
        angle: Function,
        /// -1 if the angle is measured from this body.
        sign: f64,
    },
}

/// A known node at `x` that follows a marker on a known body.
#[derive(Debug)]
pub(crate) struct DrivenNode {
    pub x: usize,
    pub marker: Marker,
}

/// A constraint with its place in the equations.
#[derive(Debug)]
pub(crate) struct PlacedConstraint {
    pub term: ConstraintTerm,
    /// Index of its first multiplier among the multipliers.
    pub row: usize,
    pub rows: usize,
    pub block: Block,
    /// Slots of the gradient of each row in the tangent ...
    pub border: Vec<Border>,
    /// ... and its entries in the matrix of the acceleration level.
    pub entries: Vec<Vec<u32>>,
    /// The body that each local coordinate stands for.
    pub owners: Vec<usize>,
    /// 0 for a redundant row that is left out of the equations, otherwise 1.
    pub kept: [f64; ROWS],
}

impl PlacedConstraint {
    /// Removes row `d` from the equations; it is replaced by lambda = 0.
    fn drop_row(&mut self, d: usize, symbolic: &Symbolic, level: &mut SaddlePoint) {
        self.kept[d] = 0.0;
        self.border[d] = Border::discarded(self.block.coordinates.len(), symbolic);
        self.entries[d].fill(level.discarded_entry());
        level.drop_row(self.row + d);
    }

    /// Its multipliers.
    #[inline]
    pub fn multipliers(&self, at: &State) -> [f64; ROWS] {
        let mut lambda = [0.0; ROWS];
        lambda[..self.rows].copy_from_slice(&at.lambda[self.row..self.row + self.rows]);
        lambda
    }
}

/// A force with its place in the equations.
#[derive(Debug)]
pub(crate) struct PlacedForce {
    pub term: Box<dyn Force>,
    pub block: Block,
    /// The body that each local coordinate stands for.
    pub owners: Vec<usize>,
    /// Index of its effect.
    pub counter: usize,
    /// Indices of its entries of the energy ledger.
    pub entries: Vec<usize>,
}

/// A contact with its place in the equations.
#[derive(Debug)]
pub(crate) struct PlacedContact {
    pub pair: Box<dyn ContactPair>,
    pub block: Block,
    /// Indices of its effects.
    pub counters: Vec<usize>,
    /// Indices of its entries of the energy ledger.
    pub entries: Vec<usize>,
}

impl PlacedContact {
    /// Counts an evaluation of touching surfaces.
    #[inline]
    pub fn count(&self, work: &mut Work) {
        for counter in &self.counters {
            work.tally[*counter] += 1;
        }
    }
}

/// An ANCF element with its place in the equations.
#[derive(Debug)]
pub(crate) struct PlacedElement {
    pub kernel: AncfCable,
    pub block: Block,
}

/// An eccentric mass and the slot of its tangent.
#[derive(Debug)]
pub(crate) struct PlacedEccentric {
    pub mass: EccentricMass,
    pub slot: u32,
}

/// Masses: the parts as they belong to bodies, and their constant sum.
#[derive(Debug, Default)]
pub(crate) struct Mass {
    pub parts: Vec<Inertia>,
    /// Sum over the parts, row by row, over all coordinates: columns and masses ...
    pub entries: Vec<(u32, f64)>,
    /// ... and the end of every row.
    pub ends: Vec<u32>,
    /// The sum over unknowns in the layout of the tangent ...
    pub tangent: Vec<f64>,
    /// ... and for products.
    pub product: SparseProduct,
    /// The sum over all coordinates but internal states, for the kinetic energy.
    pub kinetic: SparseProduct,
    /// (unknown row, known column, mass): inertia forces on unknown coordinates from accelerations of known ones.
    pub known: Vec<(usize, usize, f64)>,
}

impl Mass {
    /// Row i of the sum: columns and masses.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        let row = self.entries[start as usize..self.ends[i] as usize].iter();
        row.map(|&(j, m)| (j as usize, m))
    }
}

/// A body of the scene and its place in the equations.
#[derive(Debug, Clone)]
pub struct PlacedBody {
    /// The name the user wrote.
    pub name: String,
    /// The body with its coordinates.
    pub placed: Placed,
    /// What its slots hold.
    pub contents: Vec<Content>,
    /// False of the ground.
    pub moves: bool,
    /// Its coordinates in the ideal mechanism that the drive follows, for the driven body.
    pub prescribed: Option<usize>,
    /// Its named points, if it moves.
    pub points: Vec<PlacedPoint>,
    /// Indices of its masses, eccentric masses and elements in the model.
    pub(crate) inertia: Range<usize>,
    pub(crate) eccentric: Range<usize>,
    pub(crate) elements: Range<usize>,
}

impl PlacedBody {
    /// Indices of its coordinates, slot by slot.
    pub(crate) fn coordinates(&self) -> impl Iterator<Item = usize> {
        let slots = self.placed.x.iter().zip(&self.contents);
        slots.flat_map(|(x, content)| *x..x + content.names().len())
    }
}

/// A named point of a body.
#[derive(Debug, Clone)]
pub struct PlacedPoint {
    /// The name the user wrote.
    pub name: String,
    /// Where it is.
    pub marker: Marker,
    /// Index of the first coordinate of r' there, of a flexible link.
    pub slope: Option<usize>,
}

/// A joint of the scene and its terms.
#[derive(Debug)]
pub struct PlacedJoint {
    /// The name the user wrote.
    pub name: String,
    /// Its terms, as indices into the lists of the model.
    pub terms: JointTerms,
    /// Indices of its internal states among the unknowns.
    pub states: Vec<usize>,
    /// Its force, where it shares or eliminates coordinates: the sum over the terms on one side.
    pub reaction: Option<Reaction>,
    /// Present if a drive actuates the joint and the joint moves a body.
    pub actuator: Option<Actuator>,
}

/// An actuated joint: its centre, and the known coordinates that turn with it.
#[derive(Debug, Clone)]
pub struct Actuator {
    /// Index of the bearing's and the journal's body; the angle is that of the journal relative to the bearing.
    pub bodies: [usize; 2],
    /// Centre of the joint.
    pub centre: Marker,
    /// Forces on the coordinates outboard: nodes and rigid bodies.
    pub(crate) outboard: Vec<Grip>,
    /// -1 where the bearing is the side that the joint moves.
    pub sign: f64,
}

impl Model {
    /// Sizes.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The unknowns that are internal states.
    pub(crate) fn state_indices(&self) -> Range<usize> {
        self.shape.unknowns - self.states.len()..self.shape.unknowns
    }

    /// The effects present, in the order of the tally.
    pub fn effects(&self) -> &[Effect] {
        &self.effects
    }

    /// True of a body with an unknown coordinate.
    pub fn is_free(&self, body: &PlacedBody) -> bool {
        let mut coordinates = body.placed.x.iter();
        coordinates.any(|x| *x < self.shape.unknowns)
    }

    /// Names of the unknown coordinates, then of the multipliers.
    pub fn unknown_names(&self) -> &[String] {
        &self.names
    }

    /// Bodies in the order of the scene.
    pub fn bodies(&self) -> &[PlacedBody] {
        &self.bodies
    }

    /// Joints in the order of the scene.
    pub fn joints(&self) -> &[PlacedJoint] {
        &self.joints
    }

    /// Removes rows, as (constraint, row of it), from the equations.
    pub(crate) fn drop_rows(&mut self, rows: &[(usize, usize)]) {
        for &(i, d) in rows {
            let placed = &mut self.constraints[i];
            placed.drop_row(d, &self.symbolic, &mut self.acceleration_matrix);
            let m = self.shape.unknowns + placed.row + d;
            self.mass.tangent[self.symbolic.slot(m, m) as usize] = 1.0;
        }
    }

    /// Collects the effects present, and how often each but contact is evaluated with every residual.
    pub(crate) fn count_effects(&mut self) {
        let mut effects: Vec<Effect> = Vec::new();
        let mut counts: Vec<u64> = Vec::new();
        let mut counter = |effect: Effect, count: usize| {
            let known = effects.iter().position(|e| *e == effect);
            let index = known.unwrap_or_else(|| {
                effects.push(effect);
                counts.push(0);
                effects.len() - 1
            });
            counts[index] += count as u64;
            index
        };
        if !self.elements.is_empty() {
            self.elastic_counter = counter(effect::ELASTIC, self.elements.len());
        }
        for c in &self.constraints {
            counter(c.term.effect(), 1);
        }
        for c in &mut self.contacts {
            c.counters = c.pair.effects().iter().map(|e| counter(e, 0)).collect();
        }
        if !self.weight.is_empty() {
            counter(effect::GRAVITY, 1);
        }
        if !self.prescribed.is_empty() {
            self.kinematics_counter = counter(effect::INVERSE_KINEMATICS, 0);
        }
        for f in &mut self.forces {
            f.counter = counter(f.term.effect(), 1);
        }
        let counts = counts.into_iter().enumerate();
        self.counts = counts.filter(|(_, count)| *count > 0).collect();
        self.effects = effects;
    }

    /// The sum of the entries on a side of the energy ledger \[J\].
    pub fn booked(&self, at: &State, side: Side) -> f64 {
        let entries = self.ledger.iter().zip(&at.integrals);
        let own = entries.filter(|(entry, _)| entry.side == side);
        own.fold(0.0, |sum, (_, integral)| sum + integral)
    }

    /// True where a link or a spring stores energy.
    pub fn is_elastic(&self) -> bool {
        !self.elements.is_empty() || self.has_springs()
    }

    /// True where a spring stores energy.
    pub fn has_springs(&self) -> bool {
        self.forces.iter().any(|f| f.term.stores_energy())
    }

    /// The redundant rows that are left out, by the indices of their multipliers.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = usize> {
        self.constraints.iter().flat_map(|p| {
            let dropped = (0..p.rows).filter(|&d| p.kept[d] == 0.0);
            dropped.map(|d| p.row + d)
        })
    }

    /// Names of the redundant rows that are left out.
    pub fn redundant(&self) -> Vec<String> {
        let rows = self.left_out();
        rows.map(|row| self.names[self.shape.unknowns + row].clone())
            .collect()
    }
}

impl Model {
    /// The angles of bodies whose motion is known as a function of time.
    pub(crate) fn known_angles(&self) -> Vec<usize> {
        let angles = self.rules.iter().filter_map(|rule| match rule {
            Rule::Path { x, .. } => Some(x + 2),
            Rule::Turn { theta, .. } => *theta,
        });
        angles.collect()
    }

    /// A state with the fixed coordinates in place and everything else zero.
    pub(crate) fn blank_state(&self) -> State {
        let mut state = State::zeros(self.shape);
        for &(i, value) in &self.fixed {
            state.q[i] = value;
        }
        for acting in &self.forces {
            acting.term.begin(&mut state);
        }
        state
    }
}
