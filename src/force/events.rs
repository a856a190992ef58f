//! What of a force changes at the end of steps only: its memory, and when it may change.

use crate::system::State;

/// The memory of a force, which is constant within a step, and the events at which it changes.
pub trait Events {
    /// Number of functions of the state that pass zero from below where the memory changes.
    fn crossings(&self) -> usize {
        0
    }
    /// The functions \[m\] and their rates \[m/s\]. One that cannot pass zero now is negative infinity.
    fn cross(&self, _at: &State, _out: &mut [[f64; 2]]) {}
    /// The next instant after `at.t` \[s\] at which a step ends.
    fn next_instant(&self, _at: &State) -> f64 {
        f64::INFINITY
    }
    /// Changes the memory at the end of a step, where the functions have these values. What the change releases of the stored energy is
    /// booked in the ledger of the state. True where the motion feels the change.
    fn commit(&self, at: &mut State, crossings: &[[f64; 2]], tolerance: f64) -> bool;
}

/// True where a function passes zero from below, within a tolerance of it.
pub fn passes([past, rate]: [f64; 2], tolerance: f64) -> bool {
    past > tolerance || past >= -tolerance && rate > 0.0
}
