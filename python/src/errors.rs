//! Exceptions and the category of warnings.

use folder::OutputError;
use looselink::scene::SceneError;
use messages::{Colors, scene_fault};
use pyo3::PyTypeInfo;
use pyo3::exceptions::{PyFileExistsError, PyNotADirectoryError, PyOSError};
use pyo3::prelude::*;
use std::fmt::Display;
use texts::harmless;

/// What the package raises, under the names that it has in Python.
pub mod raised {
    use pyo3::create_exception;
    use pyo3::exceptions::{PyRuntimeError, PyUserWarning, PyValueError};

    create_exception!(
        looselink,
        SceneError,
        PyValueError,
        "A fault of a scene. The text is that of the command line: what is wrong, with file, line and column.\n\n\
     Attributes: `file` (str), `line` and `column` (int, from 1) of the fault; None where it stands in no text."
    );
    create_exception!(
        looselink,
        StudyError,
        PyValueError,
        "A fault of a study. The text is that of the command line."
    );
    create_exception!(
        looselink,
        RunError,
        PyRuntimeError,
        "A run that could not go on. `run` is the `Run` up to there, with status \"failed\"."
    );
    create_exception!(
        looselink,
        RunWarning,
        PyUserWarning,
        "A reason why results may be less accurate than they look."
    );
}

/// An exception with a text that may quote what users wrote: tracebacks show it on terminals.
pub fn raise<E: PyTypeInfo>(text: impl Display) -> PyErr {
    PyErr::new::<E, _>(harmless(&text.to_string()).into_owned())
}

/// A fault of a scene as an exception.
pub fn scene_error(py: Python, error: &SceneError) -> PyErr {
    let text = scene_fault(error, Colors::None);
    let raised = raise::<raised::SceneError>(text.trim_end());
    let place = error.place();
    let file = place.map(|(file, ..)| file);
    let line = place.map(|(_, line, _)| line);
    let column = place.map(|(.., column)| column);
    let value = raised.value(py);
    let set = value
        .setattr("file", file)
        .and_then(|()| value.setattr("line", line))
        .and_then(|()| value.setattr("column", column));
    set.err().unwrap_or(raised)
}

/// A result that could not be stored.
pub fn output_error(error: &OutputError) -> PyErr {
    let text = error.to_string();
    match error {
        OutputError::Occupied { .. } => raise::<PyFileExistsError>(format!(
            "{text}; choose another folder, or replace it with force=True"
        )),
        OutputError::NotADirectory(_) => raise::<PyNotADirectoryError>(text),
        _ => raise::<PyOSError>(text),
    }
}
