//! What a run reports while it is under way.

use crate::checkpoint::carried;
use crate::model::Model;
use crate::system::State;

/// A contact that closes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Onset<'a> {
    /// When \[s\].
    pub t: f64,
    /// The joint.
    pub joint: &'a str,
    /// delta_dot at onset \[m/s\].
    pub impact_velocity: f64,
    /// Penetration at the located instant \[m\], zero within the onset tolerance.
    pub delta: f64,
    /// Direction of the eccentricity vector, from the x axis \[rad\].
    pub angle: f64,
}

/// A contact that has opened again, or that is still closed when the run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactEvent<'a> {
    /// How it began.
    pub onset: Onset<'a>,
    /// Largest penetration \[m\].
    pub deepest_penetration: f64,
    /// Largest force at the end of a step, normal force and friction together \[N\].
    pub largest_force: f64,
    /// How it ended; absent when it is still closed.
    pub end: Option<ContactEnd>,
}

/// The end of a contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactEnd {
    /// When \[s\].
    pub t: f64,
    /// -delta_dot \[m/s\]: divided by the impact velocity it is the restitution delivered.
    pub exit_velocity: f64,
}

carried!(ContactEnd { t, exit_velocity } but {});

/// Where a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Simulated time \[s\].
    pub t: f64,
    /// Duration of the scene \[s\].
    pub duration: f64,
    /// Contacts closed now; a static analysis has none.
    pub contacts: Option<usize>,
}

/// Reports of a series of runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notice<'a> {
    /// A run with this name begins, or another part of the work.
    Begun(&'a str),
    /// The run with this name has ended with a warning.
    Warned {
        /// Name of the run.
        run: &'a str,
        /// See [`super::Report::warnings`].
        warning: &'a str,
    },
}

/// Whether a run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Hand over a checkpoint, then go on.
    Checkpoint,
    /// Hand over a checkpoint, then stop.
    Stop,
}

/// Receives the results of a run as they come.
pub trait Observer {
    /// A recorded row, in the order of [`super::Simulation::channels`].
    ///
    /// # Errors
    /// When it cannot be stored; the run stops.
    fn row(&mut self, values: &[f64]) -> std::io::Result<()>;
    /// The state of the row that comes next, with accelerations and multipliers of the acceleration level.
    ///
    /// # Errors
    /// When it cannot be stored; the run stops.
    fn state(&mut self, _model: &Model, _at: &State) -> std::io::Result<()> {
        Ok(())
    }
    /// A contact has closed.
    ///
    /// # Errors
    /// When it cannot be stored; the run stops.
    fn onset(&mut self, _onset: &Onset) -> std::io::Result<()> {
        Ok(())
    }
    /// A contact has opened, or the run has ended while it is closed: called once for every contact. Contacts that open within
    /// one step come in the order of the joints, and so do those that are closed at the end.
    ///
    /// # Errors
    /// When it cannot be stored; the run stops.
    fn contact(&mut self, _contact: &ContactEvent) -> std::io::Result<()> {
        Ok(())
    }
    /// A checkpoint was asked for, or the run is stopped: from these bytes [`super::Simulation::restore`] goes on at `t` as if
    /// the run had never stopped. A static analysis has none.
    ///
    /// # Errors
    /// When it cannot be stored; the run stops.
    fn checkpoint(&mut self, _t: f64, _bytes: &[u8]) -> std::io::Result<()> {
        Ok(())
    }
    /// A step has been taken.
    ///
    /// # Errors
    /// When it cannot be reported; the run stops.
    fn step(&mut self, progress: &Progress) -> std::io::Result<Control>;
}

/// Discards everything, for callers that need only the final state and the report.
impl Observer for () {
    fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> std::io::Result<Control> {
        Ok(Control::Continue)
    }
}
