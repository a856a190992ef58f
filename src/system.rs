//! The interface between physics and time integration. The equations of motion are
//!
//! ```text
//! M a + f(t, q, v; m) + Phi_q^T lambda = 0        Phi(t, q) = 0
//! ```
//!
//! with the coordinates q (unknown ones first, then known ones), their first and second derivatives v and a, the multipliers
//! lambda, and the memory m, which changes only between accepted steps (see [`Changed`]).

use crate::checkpoint::{Carried, carried};
use crate::math::lu::Symbolic;
use crate::math::saddle_point::SaddlePoint;
use crate::motion::Knot;

/// Sizes of a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Unknown coordinates.
    pub unknowns: usize,
    /// All coordinates: unknown and known.
    pub coordinates: usize,
    /// Multipliers.
    pub multipliers: usize,
    /// Contacts.
    pub contacts: usize,
    /// Functions of the state that pass zero where memory changes: one of every contact, then those of forces.
    pub crossings: usize,
    /// Numbers of memory: one of every contact, then those of forces.
    pub memory: usize,
    /// Entries of the energy ledger.
    pub entries: usize,
}

/// An internal state of a part: a quantity x with an equation of first order, dx/dt = g(t, q, v, x; m). It is the velocity of an unknown
/// of unit mass, on which the part exerts the force -g: every method integrates it as it integrates velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InternalState {
    /// Its name, after that of its part.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The displacement \[m\] that a unit of it stands for: an accuracy of positions bounds its error, too.
    pub metres: f64,
    /// True where it may change far faster than bodies move, so that explicit methods would take tiny steps.
    pub is_stiff: bool,
}

/// Everything that changes while time runs.
#[derive(Debug, Clone)]
pub struct State {
    /// Time \[s\].
    pub t: f64,
    /// The part of the weight that acts: 1 in a motion, growing to 1 in a static analysis.
    pub weight: f64,
    /// Coordinates: unknown, then known.
    pub q: Vec<f64>,
    /// Rounding errors of the unknown coordinates; a stepper continues from q + `q_low`.
    pub q_low: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
    /// Multipliers.
    pub lambda: Vec<f64>,
    /// Memory: of every contact the impact velocity \[m/s\], 0 while it is open, then what forces keep.
    pub memory: Vec<f64>,
    /// How often memory has changed so far in a way that the motion feels. Between two states with the same number the equations
    /// of motion are differentiable functions; what is extrapolated or differenced over several steps holds for one number only.
    pub changes: u64,
    /// The entries of the energy ledger: integrals over time since the start \[J\].
    pub integrals: Vec<f64>,
    /// Their integrands \[W\].
    pub powers: Vec<f64>,
}

carried!(State { t, weight, q, q_low, v, a, lambda, memory, changes, integrals, powers } but {});

impl State {
    /// All zero.
    pub fn zeros(shape: Shape) -> State {
        State {
            t: 0.0,
            weight: 1.0,
            q: vec![0.0; shape.coordinates],
            q_low: vec![0.0; shape.unknowns],
            v: vec![0.0; shape.coordinates],
            a: vec![0.0; shape.coordinates],
            lambda: vec![0.0; shape.multipliers],
            memory: vec![0.0; shape.memory],
            changes: 0,
            integrals: vec![0.0; shape.entries],
            powers: vec![0.0; shape.entries],
        }
    }

    /// Copies what no stage of a step changes: the load and the memory.
    pub fn copy_memory(&mut self, other: &State) {
        self.weight = other.weight;
        self.memory.copy_from_slice(&other.memory);
        self.changes = other.changes;
    }

    /// Copies the known coordinates and their rates.
    pub fn copy_known(&mut self, other: &State) {
        let known = self.q_low.len()..;
        self.q[known.clone()].copy_from_slice(&other.q[known.clone()]);
        self.v[known.clone()].copy_from_slice(&other.v[known.clone()]);
        self.a[known.clone()].copy_from_slice(&other.a[known]);
    }

    /// Copies everything from `other` without allocating.
    pub fn copy_from(&mut self, other: &State) {
        self.t = other.t;
        self.weight = other.weight;
        self.q.copy_from_slice(&other.q);
        self.q_low.copy_from_slice(&other.q_low);
        self.v.copy_from_slice(&other.v);
        self.a.copy_from_slice(&other.a);
        self.lambda.copy_from_slice(&other.lambda);
        self.memory.copy_from_slice(&other.memory);
        self.changes = other.changes;
        self.integrals.copy_from_slice(&other.integrals);
        self.powers.copy_from_slice(&other.powers);
    }
}

/// A change of memory between two steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Changed {
    /// A contact has closed.
    Onset {
        /// Which one.
        contact: usize,
        /// Impact velocity \[m/s\]: the rate of the penetration.
        velocity: f64,
        /// Penetration \[m\], within the tolerance of zero where it was located.
        delta: f64,
    },
    /// A contact has opened.
    Loss {
        /// Which one.
        contact: usize,
    },
    /// A force follows another law.
    Switch {
        /// Which one.
        force: usize,
    },
}

impl Changed {
    /// Of a contact its index, of a force the index behind those of the contacts.
    pub fn index(self, contacts: usize) -> usize {
        match self {
            Changed::Onset { contact, .. } | Changed::Loss { contact } => contact,
            Changed::Switch { force } => contacts + force,
        }
    }

    /// The contact that has closed, if one has.
    pub fn closed(self) -> Option<usize> {
        match self {
            Changed::Onset { contact, .. } => Some(contact),
            _ => None,
        }
    }
}

/// Derivatives of q and v with respect to the unknown of a stage, the acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// dq/da \[s2\].
    pub q: f64,
    /// dv/da \[s\].
    pub v: f64,
}

/// Multiply-adds of evaluations of a system, by their order of magnitude: what methods cost beside each other, on any machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operations {
    /// A residual.
    pub residual: u64,
    /// A residual with its tangent, before it is factorised.
    pub tangent: u64,
}

/// Memory that a system needs while it evaluates, and the counts of what it evaluated.
#[derive(Debug, Clone)]
pub struct Work {
    /// Evaluations of each effect.
    pub tally: Vec<u64>,
    /// Prescribed motions that need memory.
    pub prescribed: Vec<Box<dyn Prescribed>>,
}

carried!(Work { tally, prescribed } but {});

/// A prescribed motion that is found by solving, with its own memory.
pub trait Prescribed: Carried + std::fmt::Debug + Send + Sync {
    /// Sets the coordinates that it prescribes, and their rates, in `to` at time `to.t`; `from` is a nearby state.
    ///
    /// # Errors
    /// When the motion cannot be followed.
    fn follow(&mut self, from: &State, to: &mut State) -> Result<(), PrescribeError>;
    /// Where the functions of time behind it are not smooth, up to a time \[s\].
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }
    /// The same motion with the same memory.
    fn duplicate(&self) -> Box<dyn Prescribed>;
}

impl Clone for Box<dyn Prescribed> {
    fn clone(&self) -> Self {
        self.duplicate()
    }
}

/// The prescribed motion cannot be followed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message} at t = {t} s")]
pub struct PrescribeError {
    /// What cannot be followed, with the names the user wrote.
    pub message: String,
    /// When \[s\].
    pub t: f64,
}

/// The physics, as seen by time integration.
///
/// `r` and `phi` are overwritten. `r` has a row for every coordinate, but only the rows of unknown coordinates are complete. The
/// tangent is the matrix of the stage equations in (a, lambda), \[\[M + w.v C + w.q K, Phi_q^T\], \[Phi_q, 0\]\] with C = df/dv
/// and K = d(f + Phi_q^T lambda)/dq. The matrix of the acceleration level is \[\[M, Phi_q^T\], \[Phi_q, 0\]\], of which M is constant.
pub trait System {
    /// Sizes.
    fn shape(&self) -> Shape;
    /// The last unknowns, which are internal states.
    fn states(&self) -> &[InternalState] {
        &[]
    }
    /// Pattern of the tangent: unknown coordinates, then multipliers.
    fn symbolic(&self) -> &Symbolic;
    /// The matrix of the acceleration level.
    fn acceleration_matrix(&self) -> &SaddlePoint;
    /// What its evaluations cost.
    fn operations(&self) -> Operations;
    /// Fresh work memory.
    fn work(&self) -> Work;
    /// Sets the known coordinates and their rates in `to` at time `to.t`; `from` is a nearby state.
    ///
    /// # Errors
    /// When the prescribed motion cannot be followed.
    fn prescribe(
        &self,
        from: &State,
        to: &mut State,
        work: &mut Work,
    ) -> Result<(), PrescribeError>;
    /// The rows of M x of the unknown coordinates, with x zero on the known ones.
    fn momentum(&self, x: &[f64], out: &mut [f64]);
    /// r = M a + f + Phi_q^T lambda and phi = Phi.
    fn residual(&self, at: &State, r: &mut [f64], phi: &mut [f64], work: &mut Work);
    /// The residual, and the tangent with it.
    fn linearise(
        &self,
        at: &State,
        w: Weights,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    );
    /// phi = Phi and the entries of Phi_q in the matrix of the acceleration level.
    fn acceleration_level(&self, at: &State, phi: &mut [f64], gradient: &mut [f64]);
    /// The residual of the unknown coordinates without their accelerations and without multipliers, in the first rows of r.
    fn free_residual(&self, at: &State, r: &mut [f64], work: &mut Work);
    /// d(Phi)/dt = Phi_q v + Phi_t.
    fn constraint_velocity(&self, at: &State, out: &mut [f64]);
    /// d2(Phi)/dt2, with the accelerations in `at`.
    fn constraint_acceleration(&self, at: &State, out: &mut [f64]);
    /// The functions that pass zero from below where memory changes \[m\], and their rates \[m/s\]: the penetration delta of an open
    /// contact, -delta of a closed one.
    fn crossings(&self, at: &State, crossings: &mut [[f64; 2]]);
    /// The next instant after `at.t` \[s\] at which memory may change: a step ends there.
    fn next_instant(&self, _at: &State) -> f64 {
        f64::INFINITY
    }
    /// Opens and closes contacts and changes the memory of forces: the only place where memory changes. `crossings` are those of the state;
    /// every change that the motion feels is counted in the state and handed to `changed`.
    fn commit(
        &self,
        at: &mut State,
        crossings: &[[f64; 2]],
        tolerance: f64,
        changed: &mut dyn FnMut(Changed),
    );
    /// Integrands of the ledger \[W\]; returns the number of contacts whose force is clamped.
    fn powers(&self, at: &mut State, work: &mut Work) -> usize;
    /// True where the tangent is a differentiable function of the state.
    fn is_smooth(&self, at: &State) -> bool;
    /// The name of an unknown or of a multiplier, for messages.
    fn unknown_name(&self, index: usize) -> String;
}

/// A system whose equilibria can be found.
pub trait Equilibrium: System {
    /// The tangent of the residual alone, without inertia and constraints: d(f + Phi_q^T lambda)/dq.
    fn plain_stiffness(&self, at: &State, work: &mut Work) -> Vec<f64>;
    /// The residual at rest and its tangent with a part of the inertia: with S = w M + d(f + Phi_q^T lambda)/dq and the largest s of
    /// its diagonal, r = M a + f + Phi_q^T (lambda + s Phi) and \[\[S + s Phi_q^T Phi_q, s Phi_q^T\], \[s Phi_q, 0\]\]. w \[1/s2\] is
    /// `inertia`. Returns s, which is 1 where S has no diagonal.
    fn stiffness(
        &self,
        at: &State,
        inertia: f64,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    ) -> f64;
}
