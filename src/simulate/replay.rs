//! What a run has reported, kept to be reported again to another observer.

use super::{ContactEvent, Control, Impact, Observer, Onset, Progress, RunError};
use crate::model::Model;
use crate::system::State;
use std::io::Result;

/// Reports after which no more of them are kept: some megabytes for a mechanism of a few bodies.
const MOST: usize = 1 << 15;

/// Keeps the reports of a run, and stops it after some steps.
#[derive(Default)]
pub(super) struct Replay {
    reports: Vec<Reported>,
    /// Steps until the run is stopped.
    pub steps_left: u64,
}

enum Reported {
    Row(Vec<f64>),
    State(State),
    Onset(Impact),
    Contact(Impact),
    Step(Progress),
}

impl Replay {
    /// True where no report is missing.
    pub fn is_complete(&self) -> bool {
        self.reports.len() <= MOST
    }

    /// Passes all reports on. Where the observer asks for more than to go on, `obey` is called with the number of steps so far.
    ///
    /// # Errors
    /// Those of the observer and of `obey`.
    pub fn play(
        &self,
        model: &Model,
        observer: &mut dyn Observer,
        mut obey: impl FnMut(u64, Control, &mut dyn Observer) -> std::result::Result<(), RunError>,
    ) -> std::result::Result<(), RunError> {
        let mut steps = 0;
        for report in &self.reports {
            match report {
                Reported::Row(values) => observer.row(values)?,
                Reported::State(state) => observer.state(model, state)?,
                Reported::Onset(impact) => observer.onset(&impact.event().onset)?,
                Reported::Contact(impact) => observer.contact(&impact.event())?,
                Reported::Step(progress) => {
                    steps += 1;
                    let control = observer.step(progress)?;
                    if control != Control::Continue {
                        obey(steps, control, observer)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn keep(&mut self, report: impl FnOnce() -> Reported) -> Result<()> {
        if self.is_complete() {
            self.reports.push(report());
        }
        Ok(())
    }
}

impl Observer for Replay {
    fn row(&mut self, values: &[f64]) -> Result<()> {
        self.keep(|| Reported::Row(values.to_vec()))
    }

    fn state(&mut self, _: &Model, at: &State) -> Result<()> {
        self.keep(|| Reported::State(at.clone()))
    }

    fn onset(&mut self, onset: &Onset) -> Result<()> {
        self.keep(|| Reported::Onset(Impact::from(onset)))
    }

    fn contact(&mut self, contact: &ContactEvent) -> Result<()> {
        self.keep(|| Reported::Contact(Impact::from(contact)))
    }

    fn step(&mut self, progress: &Progress) -> Result<Control> {
        self.keep(|| Reported::Step(*progress))?;
        self.steps_left -= 1;
        Ok(match self.steps_left {
            0 => Control::Stop,
            _ => Control::Continue,
        })
    }
}
