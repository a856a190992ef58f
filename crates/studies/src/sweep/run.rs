//! One run of a sweep.

use super::{Recorded, RowTiming, RunStatus, Sweep, SweepRow, Task};
use cpu_time::ThreadTime;
use looselink::scene::SceneError;
use looselink::simulate::{
    ContactEvent, Control, Observer, Onset, Progress, Recording, RunError, Simulation,
};
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Keeps rows and contacts until it is told to stop.
struct Stoppable<'a> {
    recording: Recording,
    stop: &'a AtomicBool,
}

impl Observer for Stoppable<'_> {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.recording.row(values)
    }

    fn onset(&mut self, onset: &Onset) -> io::Result<()> {
        self.recording.onset(onset)
    }

    fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        self.recording.contact(contact)
    }

    fn step(&mut self, progress: &Progress) -> io::Result<Control> {
        match self.stop.load(Ordering::Relaxed) {
            true => Ok(Control::Stop),
            false => self.recording.step(progress),
        }
    }
}

/// Why a run has no measures.
enum Early {
    /// The scene or its start.
    Refused(SceneError),
    /// The run, and what it had done.
    Failed(RunError, Box<SweepRow>),
    /// It was told to stop.
    Stopped,
}

impl From<SceneError> for Early {
    fn from(error: SceneError) -> Early {
        Early::Refused(error)
    }
}

impl Sweep {
    /// Makes a run and measures it. None if `stop` was raised on the way: nothing of the run is kept.
    ///
    /// A run that cannot be made is a row with its error, also where the program itself has a fault.
    pub fn run(&self, task: &Task, stop: &AtomicBool) -> Option<(SweepRow, RowTiming)> {
        let (cpu, wall) = (ThreadTime::now(), Instant::now());
        let made = catch_unwind(AssertUnwindSafe(|| self.make(task, stop)));
        let row = match made {
            Ok(Ok(row)) => row,
            Ok(Err(Early::Stopped)) => return None,
            Ok(Err(Early::Failed(error, row))) => SweepRow {
                status: RunStatus::Failed,
                error: Some(error.to_string()),
                ..*row
            },
            Ok(Err(Early::Refused(error))) => SweepRow {
                status: RunStatus::Refused,
                error: Some(error.to_string()),
                ..empty(self, task)
            },
            Err(panic) => SweepRow {
                status: RunStatus::Failed,
                error: Some(format!("the program has a fault: {}", message(&*panic))),
                ..empty(self, task)
            },
        };
        let timing = RowTiming {
            run: task.run,
            cpu: cpu.elapsed().as_secs_f64(),
            wall: wall.elapsed().as_secs_f64(),
        };
        Some((row, timing))
    }

    fn make(&self, task: &Task, stop: &AtomicBool) -> Result<SweepRow, Early> {
        let mut simulation = Simulation::new(&self.scene(&task.values)?)?;
        let disturbed = match self.study.starts {
            Some(starts) => starts.disturb(&mut simulation, self.study.seed, task.start),
            None => Ok(()),
        };
        let mut observer = Stoppable {
            recording: Recording::new(&simulation),
            stop,
        };
        let ended = disturbed.and_then(|()| simulation.run(&mut observer));
        let report = simulation.report();
        let ledger = report.ledger.as_ref();
        let row = SweepRow {
            status: RunStatus::Complete,
            warnings: report.warnings(),
            t: report.t,
            steps: report.steps,
            onsets: report.onsets,
            energies: ledger.map(|ledger| {
                super::columns::ENERGIES.map(|(_, of)| Some(of(ledger)).filter(|e| e.is_finite()))
            }),
            ..empty(self, task)
        };
        match ended {
            Ok(()) => {}
            Err(RunError::Interrupted { .. }) => return Err(Early::Stopped),
            Err(error) => return Err(Early::Failed(error, Box::new(row))),
        }
        let recorded = Recorded::new(&observer.recording, report.t);
        let (measures, envelopes) = (&self.study.measures, &self.study.envelopes);
        let values = measures.values().map(|measure| measure.value(&recorded));
        let values: Vec<Option<f64>> = values.collect();
        let missing = measures
            .keys()
            .zip(&values)
            .filter(|(_, value)| value.is_none());
        let mut warnings = row.warnings;
        warnings.extend(missing.map(|(name, _)| {
            format!("`{name}` has no value: the run has no finite row in the part that is measured")
        }));
        let envelopes = envelopes.values().map(|plan| plan.of(&recorded));
        Ok(SweepRow {
            measures: values,
            warnings,
            envelopes: envelopes.map(Option::unwrap_or_default).collect(),
            ..row
        })
    }
}

/// A row without results.
fn empty(sweep: &Sweep, task: &Task) -> SweepRow {
    SweepRow {
        run: task.run,
        program: sweep.program.clone(),
        start: task.start,
        values: task.values.clone(),
        status: RunStatus::Refused,
        error: None,
        warnings: Vec::new(),
        t: 0.0,
        steps: 0,
        onsets: 0,
        energies: None,
        measures: vec![None; sweep.study.measures.len()],
        envelopes: Vec::new(),
    }
}

/// The message of a panic.
fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "no message".to_owned())
}
