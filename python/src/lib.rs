//! Looselink as a Python package. `looselink/_looselink.pyi` has the names with their types.

mod callable;
mod errors;
mod load;
mod memory;
mod pickle;
mod progress;
mod results;
mod run;
mod scene;
mod snapshot;
mod stack;
mod sweep;
mod value;
mod view;

use pyo3::prelude::*;

#[pymodule(name = "_looselink")]
mod module {
    #[pymodule_export]
    use super::errors::raised::{RunError, RunWarning, SceneError, StudyError};
    #[pymodule_export]
    use super::pickle::{blank_run, blank_scene, expect_version};
    #[pymodule_export]
    use super::results::PyRun;
    #[pymodule_export]
    use super::scene::{PyScene, load, loads};
    #[pymodule_export]
    use super::sweep::{PySweep, make_tasks, program_is, text_of};
    #[pymodule_export]
    use super::view::PyView;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
