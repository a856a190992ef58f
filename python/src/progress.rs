//! How far a run is, shown by Python.

use super::errors::raise;
use looselink::simulate::{Control, Observer, Progress};
use messages::{Start, Ticker};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBool;
use std::io;

/// Lines of a run whose standard error is no terminal: one after every tenth of its duration.
const LINES: f64 = 10.0;

/// Where progress is shown.
pub enum ProgressDisplay {
    Nowhere,
    /// On sys.stderr: one line that changes on a terminal, otherwise a line at every tenth; how many have been written.
    Line {
        start: Start,
        terminal: bool,
        tenths: f64,
    },
    /// By a callable that receives (t, duration).
    Callable(Py<PyAny>),
}

impl ProgressDisplay {
    /// What the argument `progress` asks for.
    pub fn new(progress: Option<&Bound<PyAny>>) -> PyResult<ProgressDisplay> {
        let Some(progress) = progress else {
            return Ok(ProgressDisplay::Nowhere);
        };
        if let Ok(wanted) = progress.cast::<PyBool>() {
            if !wanted.is_true() {
                return Ok(ProgressDisplay::Nowhere);
            }
            let stderr = progress.py().import("sys")?.getattr("stderr")?;
            let terminal = stderr.call_method0("isatty")?.extract()?;
            return Ok(ProgressDisplay::Line {
                start: Start::at(0.0),
                terminal,
                tenths: 1.0,
            });
        }
        match progress.is_callable() {
            true => Ok(ProgressDisplay::Callable(progress.clone().unbind())),
            false => Err(raise::<PyTypeError>(
                "progress is True, False or a callable that receives (t, duration)",
            )),
        }
    }

    /// Shows where the run is, some times a second.
    pub fn show(&mut self, py: Python, at: &Progress) -> PyResult<()> {
        match self {
            ProgressDisplay::Nowhere => Ok(()),
            ProgressDisplay::Callable(function) => {
                function.call1(py, (at.t, at.duration)).map(drop)
            }
            ProgressDisplay::Line {
                start,
                terminal,
                tenths,
            } => {
                let part = (LINES * at.t / at.duration).floor();
                if *terminal {
                    return write(py, &format!("\r{}\x1b[K", start.line(at)));
                }
                if part < *tenths {
                    return Ok(());
                }
                *tenths = part + 1.0;
                write(py, &format!("{}\n", start.line(at)))
            }
        }
    }

    /// Ends what is shown, `at` the last step.
    pub fn finish(&mut self, py: Python, at: Option<&Progress>) -> PyResult<()> {
        match (&self, at) {
            (ProgressDisplay::Line { terminal: true, .. }, _) => write(py, "\r\x1b[K"),
            (ProgressDisplay::Callable(_), Some(at)) => self.show(py, at),
            _ => Ok(()),
        }
    }
}

fn write(py: Python, text: &str) -> PyResult<()> {
    let stderr = py.import("sys")?.getattr("stderr")?;
    stderr.call_method1("write", (text,))?;
    stderr.call_method0("flush").map(drop)
}

/// Lets Python see signals during a simulation of which nothing is kept.
#[derive(Default)]
pub struct Watch {
    ticker: Ticker,
    pub raised: Option<PyErr>,
}

impl Observer for Watch {
    fn row(&mut self, _: &[f64]) -> io::Result<()> {
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> io::Result<Control> {
        if self.ticker.tick() {
            self.raised = Python::attach(|py| py.check_signals()).err();
        }
        Ok(match self.raised {
            None => Control::Continue,
            Some(_) => Control::Stop,
        })
    }
}
