//! The trait of forces, and structural damping. Forces that a scene names are in [`crate::interaction`].

mod element_damping;
mod events;
mod mass_damping;

pub use element_damping::ElementDamping;
pub use events::{Events, passes};
pub use mass_damping::MassDamping;

use crate::effect::Effect;
use crate::ledger::{Entry, Powers};
use crate::motion::Knot;
use crate::system::{State, Weights};

/// Most coordinates that one force can depend on: a point between two nodes on both sides, and an internal state.
pub const WIDTH: usize = 9;

/// A square block in the local coordinates of a force.
pub type LocalMatrix = [[f64; WIDTH]; WIDTH];

/// A force. Its local coordinates may name a coordinate twice; what belongs to it is then the sum.
pub trait Force: std::fmt::Debug + Send + Sync {
    /// What it is counted as.
    fn effect(&self) -> Effect;
    /// The coordinates in local order: those of its first side, then those of its second.
    fn sides(&self) -> [Vec<usize>; 2];
    /// The coordinates of both sides.
    fn coordinates(&self) -> Vec<usize> {
        self.sides().concat()
    }
    /// Adds the local force f (left side of the equations of motion).
    fn force(&self, at: &State, f: &mut [f64; WIDTH]);
    /// Adds the local force and its tangent w.q df/dq + w.v df/dv.
    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix);
    /// Stored energy \[J\].
    fn energy(&self, _at: &State) -> f64 {
        0.0
    }
    /// Its entries of the energy ledger.
    fn entries(&self) -> Vec<&'static Entry>;
    /// Adds what it does and dissipates to its entries.
    fn powers(&self, at: &State, powers: &mut Powers);
    /// True of a spring: its energy is a channel.
    fn stores_energy(&self) -> bool {
        false
    }
    /// True if its tangent is a differentiable function of the state; then the first update with a new tangent leaves an error
    /// that is the square of the update.
    fn is_smooth(&self) -> bool {
        false
    }
    /// Where its functions of time are not smooth, up to a time \[s\].
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }
    /// Why it is not defined in a state, if it is not.
    fn fault(&self, _at: &State) -> Option<&'static str> {
        None
    }
    /// Sets memory before the start.
    fn begin(&self, _at: &mut State) {}
    /// Sets the memory of an angle to one with the full turns of the start \[rad\].
    fn wind(&self, _at: &mut State, _angle: f64) {}
    /// Its memory, if it has one.
    fn events(&self) -> Option<&dyn Events> {
        None
    }
    /// Names and units of what [`Force::measure`] gives, three at most.
    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }
    /// The quantities.
    fn measure(&self, _at: &State) -> [f64; 3] {
        [0.0; 3]
    }
}
