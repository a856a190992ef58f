//! What a run leaves in memory, and passes on to the disk.

use super::progress::ProgressDisplay;
use folder::OutputError;
use looselink::model::Model;
use looselink::output::Results;
use looselink::record::MotionLayout;
use looselink::scene::Scene;
use looselink::simulate::{ContactEvent, Control, Impact, Observer, Progress, Report, Simulation};
use looselink::system::State;
use messages::Ticker;
use pyo3::prelude::*;
use std::io;
use std::mem;
use std::process;
use std::time::{Duration, Instant};

/// Rows of a folder reach the disk at least this often.
const FLUSH: Duration = Duration::from_secs(1);
/// Rows for which memory is reserved at most before they come.
const RESERVED: f64 = 1e6;

/// Keeps the rows, column by column.
pub struct Memory {
    pub columns: Vec<Vec<f64>>,
    /// What stands in a row of the motion, and the rows one after the other.
    pub motion: Option<(MotionLayout, Vec<f64>)>,
    /// In the order of `onsets.csv`.
    pub contacts: Vec<Impact>,
    results: Option<Results>,
    /// The process that writes the results.
    process: u32,
    pub shown: ProgressDisplay,
    /// What Python has raised.
    pub raised: Option<PyErr>,
    /// Where the run was last.
    pub last: Option<Progress>,
    ticker: Ticker,
    flushed: Instant,
}

impl Memory {
    pub fn new(
        scene: &Scene,
        simulation: &Simulation,
        results: Option<Results>,
        shown: ProgressDisplay,
    ) -> Memory {
        let rows = scene.simulation.duration / scene.output.interval + 2.0;
        let rows = rows.min(RESERVED) as usize;
        let motion = scene.output.motion.then(|| {
            let layout = MotionLayout::new(simulation.model());
            let numbers = rows * layout.names().len();
            (layout, Vec::with_capacity(numbers))
        });
        let columns = simulation.channels().iter();
        Memory {
            columns: columns.map(|_| Vec::with_capacity(rows)).collect(),
            motion,
            contacts: Vec::new(),
            results,
            process: process::id(),
            shown,
            raised: None,
            last: None,
            ticker: Ticker::new(),
            flushed: Instant::now(),
        }
    }

    /// The results, if any are written.
    ///
    /// # Errors
    /// In a process that a callable has forked: the results are its parent's, and so are the files that both have open.
    fn results(&mut self) -> io::Result<Option<&mut Results>> {
        if self.results.is_some() && process::id() != self.process {
            // without a last word to the files
            mem::forget(self.results.take());
            return Err(io::Error::other(
                "this process was forked during the run: its parent writes the result",
            ));
        }
        Ok(self.results.as_mut())
    }

    /// Ends the results, if any are written.
    ///
    /// # Errors
    /// As [`Results::finish`], and in a process that a callable has forked.
    pub fn finish(&mut self, report: &Report) -> Result<(), OutputError> {
        self.results()?;
        let results = self.results.take();
        results.map_or(Ok(()), |results| results.finish(report))
    }

    /// Lets Python see signals and the user progress.
    fn tell(&mut self, progress: &Progress) -> bool {
        let shown = &mut self.shown;
        let told = Python::attach(|py| {
            py.check_signals()?;
            shown.show(py, progress)
        });
        self.raised = told.err();
        self.raised.is_none()
    }
}

impl Observer for Memory {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(*value);
        }
        self.results()?.map_or(Ok(()), |r| r.row(values))
    }

    fn state(&mut self, model: &Model, at: &State) -> io::Result<()> {
        if let Some((layout, numbers)) = &mut self.motion {
            layout.measure(model, at, numbers);
        }
        self.results()?.map_or(Ok(()), |r| r.state(model, at))
    }

    fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        self.contacts.push(Impact::from(contact));
        self.results()?.map_or(Ok(()), |r| r.contact(contact))
    }

    fn step(&mut self, progress: &Progress) -> io::Result<Control> {
        self.last = Some(*progress);
        if !self.ticker.tick() {
            return Ok(Control::Continue);
        }
        if self.flushed.elapsed() >= FLUSH {
            self.results()?.map_or(Ok(()), Results::flush)?;
            self.flushed = Instant::now();
        }
        Ok(match self.tell(progress) {
            true => Control::Continue,
            false => Control::Stop,
        })
    }
}
