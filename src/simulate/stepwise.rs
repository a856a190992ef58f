//! Lets a program control a run: step to a time, and go on from another state of the same mechanism.

use super::{Observer, RunError, Simulation};
use crate::scene::Analysis;
use crate::system::{State, System};

impl Simulation {
    /// Steps to time `t` \[s\], in a static analysis to the loads at `t`, and records a row there, as the run of a scene does at
    /// its intervals.
    ///
    /// # Errors
    /// See [`RunError`].
    pub fn advance_to(&mut self, t: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        match self.scene.simulation.analysis {
            Analysis::Dynamic => {
                self.advance(t, observer)?;
                self.record(observer)
            }
            Analysis::Static => self.load_to(t, observer),
        }
    }

    /// Steps to time `t` with the rows on the way that the run of the scene has: warnings are relative to the motion that they show.
    ///
    /// # Errors
    /// See [`RunError`].
    pub fn approach(&mut self, t: f64, observer: &mut dyn Observer) -> Result<(), RunError> {
        let interval = self.scene.output.interval;
        let rows = (0..).map(|k| f64::from(k) * interval);
        let mut times = rows.take_while(|row| *row < t).chain([t]);
        times.try_for_each(|row| self.advance_to(row, observer))
    }

    /// Goes on, at the time reached, from the coordinates, velocities and memory of `other`.
    ///
    /// Velocities are projected on the constraints, and accelerations and multipliers follow from the equations of
    /// motion. Coordinates are not projected: a combination of consistent states at a distance d violates the constraints by
    /// d^2. Contacts close and open where the memory of `other` contradicts its gaps. The energy ledger keeps its integrals, so
    /// its balance jumps by the difference of the two energies.
    ///
    /// # Errors
    /// [`RunError::Physics`] where the state has no accelerations.
    ///
    /// # Panics
    /// When `other` belongs to another mechanism.
    pub fn continue_from(&mut self, other: &State) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            newton,
            work,
            is_between_rows,
            first_crossings,
            ..
        } = self;
        *is_between_rows = false;
        state.q.copy_from_slice(&other.q);
        state.q_low.copy_from_slice(&other.q_low);
        state.v.copy_from_slice(&other.v);
        state.memory.copy_from_slice(&other.memory);
        state.changes += 1;
        let tolerance = self.scene.integrator.onset_tolerance;
        newton.forget_motion();
        model.crossings(state, first_crossings);
        model.commit(state, first_crossings, tolerance, &mut |_| {});
        if let Err(failure) = newton.make_consistent(&**model, state, work) {
            return Err(self.failed(failure.into(), 0.0));
        }
        model.powers(state, work);
        self.pacer.start(&self.state);
        if self.counters.steps == 0 {
            // trial runs begin there
            self.start.copy_from(&self.state);
        }
        Ok(())
    }
}
