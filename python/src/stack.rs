//! Room on the stack: a callable that runs its own scene would fill it.

use super::errors::raise;
use pyo3::exceptions::PyRecursionError;
use pyo3::prelude::*;

/// What a scene takes of the stack at most \[bytes\]: the scenes of the project take less than half of it with the profile of the
/// tests, and the rest is for the callables.
const NEEDED: usize = 256 * 1024;

/// Sees that the stack of this thread has room for a scene.
///
/// # Errors
/// RecursionError where it has not.
pub fn room() -> PyResult<()> {
    match stacker::remaining_stack() {
        Some(left) if left < NEEDED => Err(raise::<PyRecursionError>(
            "the stack of this thread has no room for a scene: does a callable run its own scene without end?",
        )),
        _ => Ok(()),
    }
}
