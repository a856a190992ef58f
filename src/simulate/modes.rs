//! Small vibrations about the state that a run has reached.

use super::Simulation;
use crate::modes::{Modes, ModesError, modes};
use crate::system::System;

impl Simulation {
    /// Natural frequencies and mode shapes about the last accepted state: its contacts act as they do there or, with
    /// `opens`, not at all.
    ///
    /// # Errors
    /// See [`ModesError`].
    pub fn modes(&mut self, opens: bool) -> Result<Modes, ModesError> {
        let (mut at, mut work) = (self.state.clone(), self.work.clone());
        if opens {
            self.model.open_contacts(&mut at);
            // the multipliers without the contacts
            let newton = &mut self.newton;
            let solved = newton.accelerate_aside(&*self.model, &mut at, &mut work);
            solved.map_err(|failure| {
                ModesError::SingularPose(self.model.unknown_name(failure.index()))
            })?;
        }
        let lengths = self.model.lengths();
        modes(&self.model, &at, &lengths, &mut work)
    }
}
