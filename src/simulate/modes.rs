//! Small vibrations about the state that a run has reached.

use super::Simulation;
use super::meter::lengths;
use crate::modes::{Modes, ModesError, modes};

impl Simulation {
    /// Natural frequencies and mode shapes about the last accepted state: its contacts act as they do there or, with
    /// `opens`, not at all.
    ///
    /// # Errors
    /// See [`ModesError`].
    pub fn modes(&self, opens: bool) -> Result<Modes, ModesError> {
        let mut at = self.state.clone();
        if opens {
            at.z.fill(0.0);
        }
        let lengths = lengths(&self.scene, &self.model);
        modes(&self.model, &at, &lengths, &mut self.work.clone())
    }
}
