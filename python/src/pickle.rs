//! Pickles and copies of scenes and runs. Both are made blank and filled afterwards, because what they hold may refer to them.

use super::errors::raise;
use super::results::PyRun;
use super::scene::PyScene;
use pyo3::PyTypeInfo;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What `__reduce__` returns: a function that makes the blank object, its argument, and what fills it.
pub type Pickled<'py, T> = (Bound<'py, PyAny>, (&'static str,), T);

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What `__reduce__` returns of an object that the function `blank` of this module makes.
pub fn pickled<'py, T>(py: Python<'py>, blank: &str, state: T) -> PyResult<Pickled<'py, T>> {
    let blank = py.import("looselink._looselink")?.getattr(blank)?;
    Ok((blank, (VERSION,), state))
}

/// A scene that a pickle of some version fills.
#[pyfunction]
#[pyo3(name = "_blank_scene")]
pub fn blank_scene(version: &str) -> PyResult<PyScene> {
    expect_version(version)?;
    Ok(PyScene::blank())
}

/// A run that a pickle of some version fills.
#[pyfunction]
#[pyo3(name = "_blank_run")]
pub fn blank_run(version: &str) -> PyResult<PyRun> {
    expect_version(version)?;
    Ok(PyRun::blank())
}

/// Refuses pickles of other versions, whose scenes may mean something else.
#[pyfunction]
#[pyo3(name = "_expect_version")]
pub fn expect_version(version: &str) -> PyResult<()> {
    match version == VERSION {
        true => Ok(()),
        false => Err(raise::<PyValueError>(format!(
            "the pickle was written by version {version} of Looselink, and this is version {VERSION}: only the same version reads it"
        ))),
    }
}

/// Tells `copy.deepcopy` which object is the copy of another.
pub fn remember<T: PyTypeInfo>(
    of: &Bound<T>,
    copy: &Bound<T>,
    memo: &Bound<PyDict>,
) -> PyResult<()> {
    memo.set_item(of.as_ptr() as usize, copy)
}

/// What `copy.deepcopy` makes of a value.
pub fn deep_copy<'py>(
    value: &Bound<'py, PyAny>,
    memo: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyAny>> {
    value
        .py()
        .import("copy")?
        .call_method1("deepcopy", (value, memo))
}
