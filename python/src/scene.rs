//! A scene that Python reads, changes and runs.

use super::callable::watching;
use super::errors::{raise, scene_error};
use super::pickle::{Pickled, deep_copy, pickled, remember};
use super::progress::{ProgressDisplay, Watch};
use super::results::PyRun;
use super::run::{run, warn};
use super::snapshot::{Parts, Snapshot};
use super::value::{document, named_callable, override_value, quoted, written_key};
use folder::json;
use looselink::modes::Modes;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Simulation;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use studies::ablation::SceneEffect;
use texts::harmless_line;

/// load(source)
/// --
///
/// Reads a scene from a file or from a dict.
///
/// `source` is a path (str or os.PathLike) of a TOML file, or a dict with the tables of docs/scene.md: numbers, strings, booleans,
/// lists, NumPy scalars and arrays, and callables where a scene takes a function of time. All values are in SI units.
///
/// Raises SceneError for the first fault, TypeError and ValueError for a value of a dict that TOML cannot hold.
#[pyfunction]
#[pyo3(signature = (source, /))]
pub fn load(py: Python, source: &Bound<PyAny>) -> PyResult<PyScene> {
    if let Ok(tables) = source.cast::<PyDict>() {
        let callables = PyList::empty(py);
        let text = document(tables, &callables)?;
        let snapshot = Snapshot::read("dict".to_owned(), text, Vec::new(), callables.to_tuple(), 0);
        return snapshot.map(PyScene::new);
    }
    let path: PathBuf = source.extract().map_err(|_| {
        raise::<PyTypeError>("a scene is loaded from a path (str, os.PathLike) or from a dict")
    })?;
    let scene = Scene::load(&path, &[]).map_err(|error| scene_error(py, &error))?;
    let (name, text) = (path.display().to_string(), scene.text().to_owned());
    let callables = PyTuple::empty(py).unbind();
    Ok(PyScene::new(Snapshot::new(
        name,
        text,
        Vec::new(),
        scene,
        callables,
    )))
}

/// loads(text, name="scene")
/// --
///
/// Reads a scene from TOML text; messages call it `name`.
///
/// Raises SceneError for the first fault.
#[pyfunction]
#[pyo3(signature = (text, name="scene"))]
pub fn loads(py: Python, text: &str, name: &str) -> PyResult<PyScene> {
    let (name, text) = (name.to_owned(), text.to_owned());
    Snapshot::read(name, text, Vec::new(), PyTuple::empty(py), 0).map(PyScene::new)
}

/// A mechanism and how it is simulated, read and checked. `load` and `loads` make one.
///
/// A callable can evaluate scenes; one that evaluates its own scene
/// without end gets a RecursionError.
#[pyclass(module = "looselink", name = "Scene", frozen)]
#[derive(Debug)]
pub struct PyScene {
    /// None of a blank scene, and after the garbage collector has cleared it. The lock is held for an assignment only, never
    /// while Python works.
    snapshot: Mutex<Option<Snapshot>>,
}

impl PyScene {
    pub fn new(snapshot: Snapshot) -> PyScene {
        PyScene {
            snapshot: Mutex::new(Some(snapshot)),
        }
    }

    /// A scene that receives its content later: its callables may refer to it.
    pub fn blank() -> PyScene {
        PyScene {
            snapshot: Mutex::new(None),
        }
    }

    /// Gives a blank scene its content.
    fn fill(&self, snapshot: Snapshot) -> PyResult<()> {
        let mut content = self.lock();
        if content.is_some() {
            return Err(raise::<PyRuntimeError>("the scene has a content already"));
        }
        *content = Some(snapshot);
        Ok(())
    }

    /// Sees that its callables can be pickled.
    ///
    /// # Errors
    /// PicklingError, which names the first that cannot.
    pub fn check(&self, py: Python) -> PyResult<()> {
        let callables = self.now(py)?.callables;
        let pickles = py.import("looselink.pickles")?;
        pickles.call_method1("check", (callables,)).map(drop)
    }

    fn lock(&self) -> MutexGuard<'_, Option<Snapshot>> {
        self.snapshot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The scene as it is now.
    pub fn now(&self, py: Python) -> PyResult<Snapshot> {
        let snapshot = self.lock().as_ref().map(|snapshot| snapshot.clone_ref(py));
        snapshot.ok_or_else(|| raise::<PyRuntimeError>("the scene has no content"))
    }

    /// Puts one in the place of the snapshot from which it was made.
    fn replace(&self, before: &Snapshot, after: Snapshot) -> PyResult<()> {
        let mut snapshot = self.lock();
        if !snapshot.as_ref().is_some_and(|now| now.is(before)) {
            let message = "the scene was changed while it was being changed, by a callable that was checked or by another thread: \
                           only that change is made";
            return Err(raise::<PyRuntimeError>(message));
        }
        let before = snapshot.replace(after);
        drop(snapshot);
        // ends callables that others replace, and which are free to do anything
        drop(before);
        Ok(())
    }
}

/// JSON as Python has it.
pub fn from_json<'py>(py: Python<'py>, bytes: &[u8]) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (bytes,))
}

/// The modes of a scene about its pose at a time, the names of the unknowns, and what is in doubt. Without Python, up to callables
/// and signals.
fn modes_at(scene: &Scene, at: f64, opens: bool) -> PyResult<(Modes, Vec<String>, Vec<String>)> {
    let simulation = watching(|| Simulation::new(scene));
    let mut simulation =
        simulation.map_err(|error| Python::attach(|py| scene_error(py, &error)))?;
    let mut warnings = Vec::new();
    if at > 0.0 || scene.simulation.analysis == Analysis::Static {
        let mut watch = Watch::default();
        let reached = simulation.approach(at, &mut watch);
        watch.raised.map_or(Ok(()), Err)?;
        reached.map_err(|error| raise::<PyRuntimeError>(messages::run_failure(&error)))?;
        warnings = simulation.report().warnings();
    }
    let found = simulation.modes(opens);
    let found = found.map_err(|error| raise::<PyRuntimeError>(error.to_string()))?;
    warnings.extend(found.asymmetry_note());
    let model = simulation.model();
    let names = &model.unknown_names()[..model.shape().unknowns];
    Ok((found, names.to_vec(), warnings))
}

#[pymethods]
impl PyScene {
    /// The title of the scene.
    #[getter]
    fn title(&self, py: Python) -> PyResult<String> {
        Ok(self.now(py)?.scene.title.clone())
    }

    /// Where the scene was read from, as messages call it.
    #[getter]
    fn name(&self, py: Python) -> PyResult<String> {
        Ok(self.now(py)?.name.clone())
    }

    /// The TOML text that the scene was read from, without the changes in `overrides`.
    #[getter]
    fn text(&self, py: Python) -> PyResult<String> {
        Ok(self.now(py)?.text.clone())
    }

    /// The changes made by `set` and `add_load`, as `--set` of the command line takes them.
    #[getter]
    fn overrides(&self, py: Python) -> PyResult<Vec<String>> {
        Ok(self.now(py)?.overrides.clone())
    }

    /// A copy, which changes do not share.
    pub fn copy(&self, py: Python) -> PyResult<PyScene> {
        self.now(py).map(PyScene::new)
    }

    fn __copy__(&self, py: Python) -> PyResult<PyScene> {
        self.copy(py)
    }

    /// A copy with copies of its callables; functions are their own copies.
    fn __deepcopy__<'py>(
        slf: &Bound<'py, Self>,
        memo: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyScene>> {
        let py = slf.py();
        let now = slf.get().now(py)?;
        let copy = Bound::new(py, PyScene::blank())?;
        // a callable may hold its scene
        remember(slf, &copy, memo)?;
        let callables = deep_copy(now.callables.bind(py), memo)?;
        copy.get()
            .fill(now.with_callables(callables.cast_into()?.unbind()))?;
        Ok(copy)
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<Pickled<'py, Parts<Bound<'py, PyTuple>>>> {
        self.check(py)?;
        pickled(py, "_blank_scene", self.now(py)?.parts(py))
    }

    fn __setstate__(&self, parts: Parts<Bound<PyTuple>>) -> PyResult<()> {
        self.fill(Snapshot::of_parts(parts)?)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        match self.snapshot.try_lock().as_deref() {
            Ok(Some(snapshot)) => visit.call(&snapshot.callables),
            _ => Ok(()),
        }
    }

    fn __clear__(&self) {
        let snapshot = self.lock().take();
        drop(snapshot);
    }

    fn __repr__(&self, py: Python) -> PyResult<String> {
        let now = self.now(py)?;
        let overrides = match now.overrides.len() {
            0 => String::new(),
            1 => ", 1 override".to_owned(),
            count => format!(", {count} overrides"),
        };
        let (title, name) = (&now.scene.title, harmless_line(&now.name));
        Ok(format!(
            "<looselink.Scene {title:?} from {name}{overrides}>"
        ))
    }

    /// Changes a field and returns the scene, as `--set path=value` of the command line does.
    ///
    /// `path` is dotted, for example "joints.B1.model" or "bodies.crank.points.A.0"; a part with a dot is written in double quotes.
    /// The last part may be new in a table that is there. `value` is a bool, int, float, str, list, tuple, dict, NumPy scalar or
    /// array. Where a scene takes a function of time, it may be a callable f(t) of the time t [s]: for a load it returns the value
    /// [N, N m], for a motion (value, rate, acceleration) [m or rad, and their derivatives by s]. It is called once with t = 0 to
    /// check it.
    ///
    /// The whole scene is read again. A run that is under way does not notice: it has a copy of its own. Raises SceneError for the
    /// first fault, TypeError and ValueError for a value that a scene cannot hold, what the callable raises, and RuntimeError where
    /// the callable or another thread changes the scene meanwhile; this change is then not made. Whether the mechanism can be
    /// assembled is seen when it is run or inspected.
    fn set<'py>(
        slf: Bound<'py, Self>,
        path: &str,
        value: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, Self>> {
        if path.contains('=') {
            let message = format!("the path {path:?} has a `=`: write set(path, value)");
            return Err(raise::<PyValueError>(message));
        }
        let py = slf.py();
        let now = slf.get().now(py)?;
        let callables = now.callables.bind(py).to_list();
        let value_text = override_value(value, path, &callables)?;
        let changed = now.changed(format!("{path}={value_text}"), callables.to_tuple())?;
        slf.get().replace(&now, changed)?;
        Ok(slf)
    }

    /// Adds a load on a point that depends on its motion, and returns the scene.
    ///
    /// `name` names the load, whose channels are `name.fx` and `name.fy` [N]; `point` is "body.point". `load(t, x, y, vx, vy)`
    /// returns (fx, fy) [N], from the time [s] and the position [m] and velocity [m/s] of the point in the ground. It must be a
    /// function of its arguments alone: the solver calls it several times a step, also at states that it then rejects.
    ///
    /// `tangent(t, x, y, vx, vy)` returns the derivatives as two rows, [[dfx/dx, dfx/dy, dfx/dvx, dfx/dvy], [dfy/dx, ...]]
    /// [N/m, N s/m]. Without it they are forward differences with a step of 1.5e-8 max(|x|, 0.01) in every argument, which take
    /// four more calls. Newton's method needs derivatives to converge only; give them where the load changes within micrometres.
    ///
    /// Raises SceneError for an unknown point or a name that is taken, TypeError for what cannot be called, RuntimeError as `set`.
    #[pyo3(signature = (name, point, load, tangent=None))]
    fn add_load<'py>(
        slf: Bound<'py, Self>,
        name: &str,
        point: &str,
        load: Bound<'py, PyAny>,
        tangent: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, Self>> {
        for (what, function) in [("load", Some(&load)), ("tangent", tangent.as_ref())] {
            if function.is_some_and(|function| !function.is_callable()) {
                return Err(raise::<PyTypeError>(format!("{what} cannot be called")));
            }
        }
        let py = slf.py();
        let now = slf.get().now(py)?;
        let forces = &now.scene.forces;
        if forces.iter().any(|force| force.name == name) {
            let message = format!("the scene has a force `{name}` already");
            return Err(raise::<PyValueError>(message));
        }
        let callables = now.callables.bind(py).to_list();
        let keys = format!("point = {}, ", quoted(point));
        let name = written_key(name);
        let path = format!("forces.{name}");
        let table = named_callable(&path, &load, tangent.as_ref(), &keys, &callables)?;
        let change = match forces.is_empty() {
            true => format!("forces={{ {name} = {table} }}"),
            false => format!("{path}={table}"),
        };
        let changed = now.changed(change, callables.to_tuple())?;
        slf.get().replace(&now, changed)?;
        Ok(slf)
    }

    /// What will be simulated, as `looselink inspect --json` prints it: numbers of unknowns, multipliers and contacts, the effects
    /// of the model, assumptions, names of coordinates and constraints.
    ///
    /// Raises SceneError where the mechanism cannot be assembled or cannot start, KeyboardInterrupt after Ctrl-C.
    fn inspect<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let inspection = self.now(py)?.evaluate(py, |scene| {
            let inspected = || Ok(json(&watching(|| Simulation::new(scene))?.inspect()));
            py.detach(inspected)
                .map_err(|error| scene_error(py, &error))
        })?;
        let inspection = inspection.map_err(|e| raise::<PyRuntimeError>(e.to_string()))?;
        from_json(py, &inspection)
    }

    /// Natural frequencies of small vibrations at t = `at` [s], the slowest first; the scene is simulated up to `at`. In a static
    /// analysis `at` measures the load.
    ///
    /// `contacts` says what loose joints do: with "as-is" those that are closed there act as springs, the others not at all; with
    /// "open" none acts; with "ideal" ideal joints take their place, also on the way to `at`. `count` is the largest number of
    /// modes. Returns a list of dicts as `looselink modes --json` has them: frequency [Hz], growth [1/s] of an unstable mode,
    /// damping (ratio), moves_most, and shape, the displacement of every unknown coordinate by its name.
    ///
    /// Warnings of the run up to `at`, and of a stiffness that is not symmetric, are given with the category RunWarning.
    ///
    /// Raises ValueError for a time outside the duration or other contacts, SceneError as `inspect`, RuntimeError where there are no
    /// modes, KeyboardInterrupt after Ctrl-C.
    #[pyo3(signature = (at=0.0, contacts="as-is", count=None))]
    fn modes<'py>(
        &self,
        py: Python<'py>,
        at: f64,
        contacts: &str,
        count: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let opens = match contacts {
            "as-is" | "ideal" => false,
            "open" => true,
            other => {
                let message =
                    format!("contacts = {other:?}: it is \"as-is\", \"open\" or \"ideal\"");
                return Err(raise::<PyValueError>(message));
            }
        };
        let now = self.now(py)?;
        let duration = now.scene.simulation.duration;
        if !(0.0..=duration).contains(&at) {
            let message = format!("at = {at} lies outside the duration, 0 to {duration} s");
            return Err(raise::<PyValueError>(message));
        }
        let (found, names, warnings) = now.evaluate(py, |scene| {
            let ideal = (contacts == "ideal").then(|| SceneEffect::Clearance.removed_from(scene));
            let ideal = ideal.transpose().map_err(|error| scene_error(py, &error))?;
            py.detach(|| modes_at(ideal.as_ref().unwrap_or(scene), at, opens))
        })?;
        warn(py, warnings)?;
        let modes = found.modes.iter().take(count.unwrap_or(usize::MAX));
        let modes = modes.map(|mode| {
            let entry = json(mode).map_err(|e| raise::<PyRuntimeError>(e.to_string()))?;
            let entry = from_json(py, &entry)?;
            let shape = PyDict::new(py);
            for (name, value) in names.iter().zip(&mode.shape) {
                shape.set_item(name, value)?;
            }
            entry.set_item("shape", shape)?;
            Ok(entry)
        });
        let modes: PyResult<Vec<_>> = modes.collect();
        modes?.into_pyobject(py)
    }

    /// Runs the scene at many values of its fields; see `looselink.sweep`.
    ///
    /// Keyword arguments are those of `looselink.sweep`, such as out and threads, and the tables of docs/sweep.md without `scene`:
    /// parameters, measures, design and others. A scene with callables cannot be swept, because their values are not in its text.
    ///
    /// Returns a SweepResult. Raises ValueError for a scene with callables; otherwise as `looselink.sweep`.
    #[pyo3(signature = (client=None, **keywords))]
    fn sweep<'py>(
        slf: Bound<'py, Self>,
        client: Option<Bound<'py, PyAny>>,
        keywords: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if slf.get().now(slf.py())?.has_callables(slf.py()) {
            return Err(raise::<PyValueError>(
                "a scene with callables cannot be swept: their values are not in its text",
            ));
        }
        let py = slf.py();
        let sweeps = py.import("looselink.sweeps")?;
        sweeps.call_method("of_scene", (slf, client), keywords.as_ref())
    }

    /// Simulates the scene and returns its `Run`. Other threads of Python go on meanwhile.
    ///
    /// `progress`: True shows how far the run is on sys.stderr; a callable receives (t, duration) [s] about ten times a second.
    /// `out`: a folder that receives the files of `looselink run`; it is created. `force` replaces a result that is there.
    ///
    /// Warnings of the run are given with the category RunWarning.
    ///
    /// Raises RunError, whose `run` has the rows so far, where the run cannot go on; SceneError as `inspect`; FileExistsError where
    /// `out` holds a result and `force` is False; OSError where it cannot be written; KeyboardInterrupt within a tenth of a second
    /// after Ctrl-C; what a callable raises, and RecursionError where one runs its own scene without end. Exceptions of a run that
    /// has begun have a `run` with the rows so far, too.
    #[pyo3(signature = (progress=None, out=None, force=false))]
    fn run(
        &self,
        py: Python,
        progress: Option<&Bound<PyAny>>,
        out: Option<PathBuf>,
        force: bool,
    ) -> PyResult<Py<PyRun>> {
        let shown = ProgressDisplay::new(progress)?;
        run(py, self.now(py)?, shown, out, force)
    }
}
