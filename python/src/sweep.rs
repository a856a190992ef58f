//! Sweeps: the runs of a study on the threads of this process, or one by one on those of others.

use super::errors::{output_error, raise, raised, scene_error};
use super::stack::room;
use super::value::document;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::Duration;
use studies::StudyError;
use studies::sweep::{
    FILES, RowTiming, Shard, Store, Sweep, SweepError, SweepSource, SweepTarget, Task, execute,
    merge,
};
use texts::csv;

/// Time between two looks at signals.
const LOOK: Duration = Duration::from_millis(50);

/// The study as an exception of Python.
fn sweep_error(error: &SweepError) -> PyErr {
    match error {
        SweepError::Study(StudyError::Scene(error)) => Python::attach(|py| scene_error(py, error)),
        SweepError::Study(StudyError::Plain(message)) => {
            raise::<raised::StudyError>(message.clone())
        }
        SweepError::Output(error) => output_error(error),
        error => raise::<PyRuntimeError>(error.to_string()),
    }
}

fn not_json(error: &serde_json::Error) -> PyErr {
    raise::<PyValueError>(error.to_string())
}

/// A study with its scene. Private: `looselink.sweep` uses it.
#[pyclass(module = "looselink", name = "_Sweep", frozen)]
#[derive(Debug)]
pub struct PySweep {
    sweep: Arc<Sweep>,
    /// The rows and their folder, once it is open.
    store: Mutex<Option<(PathBuf, Store)>>,
}

impl PySweep {
    fn new(sweep: impl FnOnce() -> Result<Sweep, SweepError>) -> PyResult<PySweep> {
        room()?;
        Ok(PySweep {
            sweep: Arc::new(sweep().map_err(|error| sweep_error(&error))?),
            store: Mutex::new(None),
        })
    }

    /// Does something with the rows.
    fn with_store<T>(
        &self,
        work: impl FnOnce(&PathBuf, &mut Store) -> Result<T, SweepError>,
    ) -> PyResult<T> {
        let mut store = self.store.lock().expect("no thread panics");
        let Some((folder, store)) = store.as_mut() else {
            return Err(raise::<PyRuntimeError>(
                "the folder of the rows is not open",
            ));
        };
        work(folder, store).map_err(|error| sweep_error(&error))
    }
}

fn target_of(target: Option<(String, f64)>) -> Option<SweepTarget> {
    target.map(|(measure, value)| SweepTarget::new(&measure, value))
}

#[pymethods]
impl PySweep {
    /// That of a study file.
    #[staticmethod]
    fn load(path: PathBuf, target: Option<(String, f64)>) -> PyResult<PySweep> {
        PySweep::new(|| Sweep::load(&path, target_of(target)))
    }

    /// That of a study as a dict without its scene, and of the text of the scene with the changes of every run.
    #[staticmethod]
    fn of(
        study: &Bound<PyDict>,
        name: &str,
        scene: String,
        overrides: Vec<String>,
        target: Option<(String, f64)>,
    ) -> PyResult<PySweep> {
        let study = study.copy()?;
        let py = study.py();
        let set = study.get_item("set")?;
        let set: Vec<String> = set.map_or(Ok(Vec::new()), |set| set.extract())?;
        study.set_item("set", [overrides, set].concat())?;
        study.set_item("scene", name)?;
        let callables = PyList::empty(py);
        let text = document(&study, &callables)?;
        if !callables.is_empty() {
            return Err(raise::<PyTypeError>("a study cannot hold callables"));
        }
        let source = SweepSource {
            path: PathBuf::from("study"),
            study: text,
            scene,
            target: target_of(target),
        };
        py.detach(|| PySweep::new(|| Sweep::new(source)))
    }

    /// Names of the tables and pictures, first the one that closes a result.
    #[staticmethod]
    fn files() -> [&'static str; FILES.len()] {
        FILES
    }

    /// What it is made of, as JSON.
    fn source(&self) -> PyResult<String> {
        serde_json::to_string(self.sweep.source()).map_err(|error| not_json(&error))
    }

    #[getter]
    fn title(&self) -> &str {
        &self.sweep.study.title
    }

    /// Number of runs; None for a bisection.
    #[getter]
    fn runs(&self) -> Option<usize> {
        self.sweep.runs()
    }

    /// Runs whose rows are there.
    fn done(&self) -> PyResult<usize> {
        self.with_store(|_, store| Ok(store.len()))
    }

    /// Opens the folder that receives the rows.
    fn open(&self, folder: PathBuf, force: bool) -> PyResult<()> {
        let store = Store::open(&folder, &self.sweep, Shard::WHOLE, force);
        let store = store.map_err(|error| sweep_error(&error))?;
        *self.store.lock().expect("no thread panics") = Some((folder, store));
        Ok(())
    }

    /// Closes the folder, so that another sweep can write to it.
    fn close(&self) {
        *self.store.lock().expect("no thread panics") = None;
    }

    /// Numbers of the runs that can be made now.
    fn pending(&self) -> PyResult<Vec<usize>> {
        self.with_store(|_, store| self.sweep.pending(store, Shard::WHOLE))
    }

    /// Some runs as JSON, for `make_tasks`.
    fn tasks(&self, runs: Vec<usize>) -> PyResult<Vec<String>> {
        let tasks = runs.into_iter().map(|run| {
            let task = self.with_store(|_, store| self.sweep.task(store, run))?;
            serde_json::to_string(&task).map_err(|error| not_json(&error))
        });
        tasks.collect()
    }

    /// Keeps a row that `make_tasks` has made.
    fn append(&self, row: &str, timing: &str) -> PyResult<()> {
        let row = serde_json::from_str(row).map_err(|error| not_json(&error))?;
        let timing = serde_json::from_str(timing).map_err(|error| not_json(&error))?;
        self.with_store(|_, store| store.append(&row, &timing))
    }

    /// Makes all runs on threads of this process; `told` receives the numbers of runs that are made and left.
    fn make(
        &self,
        py: Python,
        threads: Option<NonZeroUsize>,
        told: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let cores = || thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
        let threads = threads.unwrap_or_else(cores);
        py.detach(|| {
            self.with_store(|_, store| Ok(make(&self.sweep, store, threads, told.as_ref())))?
        })
    }

    /// Writes tables and pictures.
    fn merge(&self, py: Python) -> PyResult<()> {
        py.detach(|| self.with_store(|folder, store| merge(&self.sweep, store, folder).map(|_| ())))
    }
}

/// Makes runs while this thread watches signals and tells Python how far they are.
fn make(
    sweep: &Sweep,
    store: &mut Store,
    threads: NonZeroUsize,
    told: Option<&Py<PyAny>>,
) -> PyResult<()> {
    let stop = AtomicBool::new(false);
    let (sender, receiver) = mpsc::channel();
    let (ended, raised) = thread::scope(|scope| {
        let stop = &stop;
        let work = scope.spawn(move || {
            let mut tell = |progress: studies::sweep::SweepProgress| {
                // the receiver lives longer
                let _ = sender.send((progress.done, progress.left));
            };
            execute(sweep, store, Shard::WHOLE, threads, stop, &mut tell)
        });
        let mut raised = None;
        loop {
            let message = receiver.recv_timeout(LOOK);
            // the last of those that have come
            let latest = receiver.try_iter().last().or(message.ok());
            if raised.is_none() {
                let looked = Python::attach(|py| {
                    if let (Some(told), Some(latest)) = (told, latest) {
                        told.call1(py, latest)?;
                    }
                    py.check_signals()
                });
                raised = looked.err();
                stop.store(raised.is_some(), Ordering::Relaxed);
            }
            if message == Err(mpsc::RecvTimeoutError::Disconnected) {
                break (work.join().expect("a panic of a run is a row"), raised);
            }
        }
    });
    match raised {
        Some(raised) => Err(raised),
        None => ended.map_err(|error| sweep_error(&error)),
    }
}

/// The sweep that this process used last, and its source: a worker reads a scene once, not in every task.
static LATEST: Mutex<Option<(String, Arc<Sweep>)>> = Mutex::new(None);

/// The sweep with this source.
fn sweep_of(source: String) -> PyResult<Arc<Sweep>> {
    let mut latest = LATEST.lock().expect("no thread panics");
    if let Some((_, sweep)) = latest.as_ref().filter(|(latest, _)| *latest == source) {
        return Ok(sweep.clone());
    }
    let read: SweepSource = serde_json::from_str(&source).map_err(|error| not_json(&error))?;
    let sweep = Arc::new(Sweep::new(read).map_err(|error| sweep_error(&error))?);
    *latest = Some((source, sweep.clone()));
    Ok(sweep)
}

/// Says where the file of this module is, by which rows name the program that has made them.
#[pyfunction]
#[pyo3(name = "_program_is")]
pub fn program_is(path: PathBuf) {
    looselink::output::program_is(path);
}

/// Makes some runs of a sweep; sources, tasks and results are JSON. Returns a row and its time for each. `version` is that of the
/// package that asks.
#[pyfunction]
#[pyo3(name = "_make_tasks")]
pub fn make_tasks(
    py: Python,
    version: &str,
    source: String,
    tasks: Vec<String>,
) -> PyResult<Vec<(String, String)>> {
    let own = env!("CARGO_PKG_VERSION");
    if version != own {
        return Err(raise::<PyRuntimeError>(format!(
            "a worker has version {own} of Looselink, the client {version}: install the same"
        )));
    }
    let tasks = tasks.iter().map(|task| serde_json::from_str(task));
    let tasks: Result<Vec<Task>, _> = tasks.collect();
    let tasks = tasks.map_err(|error| not_json(&error))?;
    py.detach(|| {
        let sweep = sweep_of(source)?;
        let never = AtomicBool::new(false);
        let made = tasks.iter().filter_map(|task| sweep.run(task, &never));
        let written = made.map(|(row, timing): (_, RowTiming)| {
            Ok((
                serde_json::to_string(&row)?,
                serde_json::to_string(&timing)?,
            ))
        });
        let written: Result<Vec<_>, serde_json::Error> = written.collect();
        written.map_err(|error| not_json(&error))
    })
}

/// The text of a cell of a table, without what keeps a spreadsheet from taking it for a formula.
#[pyfunction]
#[pyo3(name = "_text_of")]
pub fn text_of(content: &str) -> &str {
    csv::text_of(content)
}
