//! A run of a scene.

use super::callable::{take_raised, watching};
use super::errors::{output_error, raise, raised, scene_error};
use super::memory::Memory;
use super::progress::ProgressDisplay;
use super::results::PyRun;
use super::snapshot::Snapshot;
use folder::Folder;
use looselink::output::Results;
use looselink::scene::Scene;
use looselink::simulate::{Channel, Report, RunError, Simulation};
use messages::run_failure;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::ffi::CString;
use std::path::{Path, PathBuf};

/// What has become of a run.
struct FinishedRun {
    channels: Vec<Channel>,
    memory: Memory,
    report: Report,
    error: Option<RunError>,
    /// What a callable, a signal, the shown progress or the end of the files has raised.
    raised: Option<PyErr>,
}

/// Simulates a scene.
pub fn run(
    py: Python,
    snapshot: Snapshot,
    shown: ProgressDisplay,
    out: Option<PathBuf>,
    force: bool,
) -> PyResult<Py<PyRun>> {
    let ended = snapshot.evaluate(py, |scene| {
        py.detach(|| simulate(scene, shown, out.as_deref(), force))
    })?;
    let FinishedRun {
        channels,
        mut memory,
        report,
        error,
        raised,
    } = ended;
    let last = memory.last.filter(|_| error.is_none());
    let shown = memory.shown.finish(py, last.as_ref());
    let name = out.and_then(|out| out.canonicalize().ok());
    let name = name.and_then(|out| Some(out.file_name()?.to_string_lossy().into_owned()));
    let name = name.unwrap_or_default();
    let kept = PyRun::new(py, snapshot, name, &channels, memory, &report)?;
    let kept = Py::new(py, kept)?;
    let with_rows = |error: PyErr| {
        // some exceptions cannot be changed
        let _ = error.value(py).setattr("run", &kept);
        error
    };
    if let Some(raised) = raised.or(shown.err()) {
        return Err(with_rows(raised));
    }
    match error {
        Some(RunError::Output(error)) => {
            return Err(with_rows(raise::<PyOSError>(error.to_string())));
        }
        Some(error) => return Err(with_rows(raise::<raised::RunError>(run_failure(&error)))),
        None => {}
    }
    warn(py, report.warnings()).map_err(with_rows)?;
    Ok(kept)
}

/// Gives warnings of a run to Python.
pub fn warn(py: Python, warnings: Vec<String>) -> PyResult<()> {
    let category = py.get_type::<raised::RunWarning>();
    for warning in warnings {
        PyErr::warn(py, &category, &CString::new(warning)?, 1)?;
    }
    Ok(())
}

/// Runs without Python, up to callables, signals and progress.
fn simulate(
    scene: &Scene,
    shown: ProgressDisplay,
    out: Option<&Path>,
    force: bool,
) -> PyResult<FinishedRun> {
    let folder = out.map(|out| Folder::claim(out, view::kind(), force));
    let folder = folder.transpose();
    let folder = folder.map_err(|error| output_error(&error))?;
    let simulation = watching(|| Simulation::new(scene));
    let mut simulation =
        simulation.map_err(|error| Python::attach(|py| scene_error(py, &error)))?;
    // before anything is written
    take_raised().map_or(Ok(()), Err)?;
    let results = folder.map(|folder| Results::begin(folder, scene, &simulation));
    let results = results.transpose();
    let results = results.map_err(|error| output_error(&error))?;
    let mut memory = Memory::new(scene, &simulation, results, shown);
    let error = simulation.run(&mut memory).err();
    let report = simulation.report();
    let finished = memory.finish(&report).err();
    let raised = take_raised().or(memory.raised.take());
    // what has ended the run comes first
    let unfinished = finished.filter(|_| error.is_none());
    let raised = raised.or(unfinished.map(|error| output_error(&error)));
    Ok(FinishedRun {
        channels: simulation.channels().to_vec(),
        memory,
        report,
        error,
        raised,
    })
}
