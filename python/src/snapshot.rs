//! What a scene is at one time.

use super::callable::{Callables, FUNCTION, evaluating, named_only};
use super::errors::scene_error;
use super::load::LOAD;
use looselink::registry::Registry;
use looselink::scene::Scene;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::ops::Deref;
use std::sync::Arc;

/// What a scene was read from, and what it says.
#[derive(Debug)]
pub struct Content {
    pub name: String,
    pub text: String,
    pub overrides: Vec<String>,
    pub scene: Scene,
}

/// Name, text, overrides and callables.
pub type Parts<T> = (String, String, Vec<String>, T);

/// A scene as it is at one time. A change of the scene makes another one: what goes on with this one does not notice.
#[derive(Debug)]
pub struct Snapshot {
    content: Arc<Content>,
    pub callables: Callables,
}

impl Deref for Snapshot {
    type Target = Content;

    fn deref(&self) -> &Content {
        &self.content
    }
}

impl Snapshot {
    /// Reads a scene, which can name its callables. The first ones have been `checked` before and are not called.
    ///
    /// # Errors
    /// The first fault, and what a callable raises.
    pub fn read(
        name: String,
        text: String,
        overrides: Vec<String>,
        callables: Bound<PyTuple>,
        checked: usize,
    ) -> PyResult<Snapshot> {
        let py = callables.py();
        let standard = Registry::standard();
        let registry = match callables.is_empty() {
            true => standard,
            false => standard.with_function(&FUNCTION).with_force(&LOAD),
        };
        let given = callables.clone().unbind();
        let (scene, callables) = evaluating(py, &given, checked, || {
            let scene = Scene::parse_with(&registry, &name, &text, &overrides);
            let scene = scene.map_err(|error| scene_error(py, &error))?;
            Ok((scene, named_only(&callables)?.unbind()))
        })?;
        Ok(Snapshot::new(name, text, overrides, scene, callables))
    }

    /// Of a scene that has been read.
    pub fn new(
        name: String,
        text: String,
        overrides: Vec<String>,
        scene: Scene,
        callables: Callables,
    ) -> Snapshot {
        let content = Content {
            name,
            text,
            overrides,
            scene,
        };
        Snapshot {
            content: Arc::new(content),
            callables,
        }
    }

    /// The scene with one more override, whose callables stand behind those that it has.
    ///
    /// # Errors
    /// As [`Snapshot::read`].
    pub fn changed(&self, change: String, callables: Bound<PyTuple>) -> PyResult<Snapshot> {
        let mut overrides = self.overrides.clone();
        overrides.push(change);
        let checked = self.callables.bind(callables.py()).len();
        let (name, text) = (self.name.clone(), self.text.clone());
        Snapshot::read(name, text, overrides, callables, checked)
    }

    /// The same with other callables under the same numbers.
    pub fn with_callables(&self, callables: Callables) -> Snapshot {
        Snapshot {
            content: self.content.clone(),
            callables,
        }
    }

    /// Reads what [`Snapshot::parts`] gives. Its callables have been checked.
    ///
    /// # Errors
    /// As [`Snapshot::read`].
    pub fn of_parts(
        (name, text, overrides, callables): Parts<Bound<PyTuple>>,
    ) -> PyResult<Snapshot> {
        let checked = callables.len();
        Snapshot::read(name, text, overrides, callables, checked)
    }

    /// What a pickle holds.
    pub fn parts<'py>(&self, py: Python<'py>) -> Parts<Bound<'py, PyTuple>> {
        let (name, text) = (self.name.clone(), self.text.clone());
        let callables = self.callables.bind(py).clone();
        (name, text, self.overrides.clone(), callables)
    }

    pub fn has_callables(&self, py: Python) -> bool {
        let callables = self.callables.bind(py).iter();
        callables.into_iter().any(|callable| !callable.is_none())
    }

    pub fn clone_ref(&self, py: Python) -> Snapshot {
        self.with_callables(self.callables.clone_ref(py))
    }

    /// True of a snapshot of the same scene between the same changes.
    pub fn is(&self, other: &Snapshot) -> bool {
        Arc::ptr_eq(&self.content, &other.content)
    }

    /// Does `work` with the scene while it can call its callables.
    ///
    /// # Errors
    /// Those of `work`, what a callable raises, and RecursionError where the stack of the thread is almost full.
    pub fn evaluate<T>(&self, py: Python, work: impl FnOnce(&Scene) -> PyResult<T>) -> PyResult<T> {
        evaluating(py, &self.callables, 0, || work(&self.scene))
    }
}
