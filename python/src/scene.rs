//! A scene that Python reads, changes and runs.

use super::callable::{FUNCTION, Given, take_raised, with_given};
use super::errors::{raise, scene_error};
use super::load::LOAD;
use super::progress::ProgressDisplay;
use super::results::PyRun;
use super::run::{run, warn};
use super::value::{document, named_callable, override_value, quoted, written_key};
use folder::json;
use looselink::registry::Registry;
use looselink::scene::{Analysis, Scene, SceneError};
use looselink::simulate::Simulation;
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;
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
        let mut given = Vec::new();
        let text = document(tables, &mut given)?;
        return PyScene::parse(py, "dict".to_owned(), text, Vec::new(), given);
    }
    let path: PathBuf = source.extract().map_err(|_| {
        raise::<PyTypeError>("a scene is loaded from a path (str, os.PathLike) or from a dict")
    })?;
    let scene = Scene::load(&path, &[]).map_err(|error| scene_error(py, &error))?;
    Ok(PyScene {
        name: path.display().to_string(),
        text: scene.text().to_owned(),
        overrides: Vec::new(),
        given: Vec::new(),
        scene: Arc::new(scene),
    })
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
    PyScene::parse(py, name.to_owned(), text.to_owned(), Vec::new(), Vec::new())
}

/// A mechanism and how it is simulated, read and checked. `load` and `loads` make one.
#[pyclass(module = "looselink", name = "Scene")]
#[derive(Debug)]
pub struct PyScene {
    name: String,
    text: String,
    overrides: Vec<String>,
    /// The callables, by the numbers that name them.
    given: Vec<Arc<Given>>,
    scene: Arc<Scene>,
}

impl PyScene {
    fn parse(
        py: Python,
        name: String,
        text: String,
        overrides: Vec<String>,
        given: Vec<Arc<Given>>,
    ) -> PyResult<PyScene> {
        let scene = read(&name, &text, &overrides, &given);
        // what a callable raised is the cause of the fault
        let scene = match (take_raised(), scene) {
            (Some(raised), _) => return Err(raised),
            (None, scene) => scene.map_err(|error| scene_error(py, &error))?,
        };
        Ok(PyScene {
            name,
            text,
            overrides,
            given,
            scene: Arc::new(scene),
        })
    }

    /// Adds an override with the callables that it names, or leaves the scene as it is.
    fn change(&mut self, py: Python, change: String, given: Vec<Arc<Given>>) -> PyResult<()> {
        let mut overrides = self.overrides.clone();
        overrides.push(change);
        *self = PyScene::parse(py, self.name.clone(), self.text.clone(), overrides, given)?;
        Ok(())
    }
}

/// Reads a scene; one with callables can name them.
fn read(
    name: &str,
    text: &str,
    overrides: &[String],
    given: &[Arc<Given>],
) -> Result<Scene, SceneError> {
    let standard = Registry::standard();
    let registry = match given.is_empty() {
        true => standard,
        false => standard.with_function(&FUNCTION).with_force(&LOAD),
    };
    with_given(given, || {
        Scene::parse_with(&registry, name, text, overrides)
    })
}

/// The simulation of a scene at its start.
fn compiled(py: Python, scene: &Scene) -> PyResult<Simulation> {
    let simulation = Simulation::new(scene);
    match (take_raised(), simulation) {
        (Some(raised), _) => Err(raised),
        (None, simulation) => simulation.map_err(|error| scene_error(py, &error)),
    }
}

/// JSON as Python has it.
pub fn from_json<'py>(py: Python<'py>, bytes: &[u8]) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (bytes,))
}

#[pymethods]
impl PyScene {
    /// The title of the scene.
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// Where the scene was read from, as messages call it.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The TOML text that the scene was read from, without the changes in `overrides`.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The changes made by `set` and `add_load`, as `--set` of the command line takes them.
    #[getter]
    fn overrides(&self) -> Vec<String> {
        self.overrides.clone()
    }

    /// A copy, which changes do not share.
    fn copy(&self) -> PyScene {
        PyScene {
            name: self.name.clone(),
            text: self.text.clone(),
            overrides: self.overrides.clone(),
            given: self.given.clone(),
            scene: self.scene.clone(),
        }
    }

    fn __copy__(&self) -> PyScene {
        self.copy()
    }

    fn __repr__(&self) -> String {
        let overrides = match self.overrides.len() {
            0 => String::new(),
            1 => ", 1 override".to_owned(),
            count => format!(", {count} overrides"),
        };
        format!(
            "<looselink.Scene {:?} from {}{overrides}>",
            self.scene.title,
            harmless_line(&self.name)
        )
    }

    /// Changes a field and returns the scene, as `--set path=value` of the command line does.
    ///
    /// `path` is dotted, for example "joints.B1.model" or "bodies.crank.points.A.0"; a part with a dot is written in double quotes.
    /// The last part may be new in a table that is there. `value` is a bool, int, float, str, list, tuple, dict, NumPy scalar or
    /// array. Where a scene takes a function of time, it may be a callable f(t) of the time t [s]: for a load it returns the value
    /// [N, N m], for a motion (value, rate, acceleration) [m or rad, and their derivatives by s]. It is called once with t = 0 to
    /// check it.
    ///
    /// The whole scene is read again. Raises SceneError for the first fault, TypeError and ValueError for a value that a scene
    /// cannot hold, and what the callable raises; the scene is then as it was. Whether the mechanism can be assembled is seen when
    /// it is run or inspected.
    fn set<'py>(
        mut slf: PyRefMut<'py, Self>,
        path: &str,
        value: &Bound<'py, PyAny>,
    ) -> PyResult<PyRefMut<'py, Self>> {
        if path.contains('=') {
            let message = format!("the path {path:?} has a `=`: write set(path, value)");
            return Err(raise::<PyValueError>(message));
        }
        let mut given = slf.given.clone();
        let value_text = override_value(value, path, &mut given)?;
        slf.change(value.py(), format!("{path}={value_text}"), given)?;
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
    /// Raises SceneError for an unknown point or a name that is taken, TypeError for what cannot be called.
    #[pyo3(signature = (name, point, load, tangent=None))]
    fn add_load<'py>(
        mut slf: PyRefMut<'py, Self>,
        name: &str,
        point: &str,
        load: Bound<'py, PyAny>,
        tangent: Option<Bound<'py, PyAny>>,
    ) -> PyResult<PyRefMut<'py, Self>> {
        for (what, function) in [("load", Some(&load)), ("tangent", tangent.as_ref())] {
            if function.is_some_and(|function| !function.is_callable()) {
                return Err(raise::<PyTypeError>(format!("{what} cannot be called")));
            }
        }
        let taken = slf.scene.forces.iter().any(|force| force.name == name);
        if taken {
            let message = format!("the scene has a force `{name}` already");
            return Err(raise::<PyValueError>(message));
        }
        let py = load.py();
        let mut given = slf.given.clone();
        let keys = format!("point = {}, ", quoted(point));
        let tangent = tangent.map(Bound::unbind);
        let table = named_callable(load.unbind(), tangent, &keys, &mut given);
        let name = written_key(name);
        let change = match slf.scene.forces.is_empty() {
            true => format!("forces={{ {name} = {table} }}"),
            false => format!("forces.{name}={table}"),
        };
        slf.change(py, change, given)?;
        Ok(slf)
    }

    /// What will be simulated, as `looselink inspect --json` prints it: numbers of unknowns, multipliers and contacts, the effects
    /// of the model, assumptions, names of coordinates and constraints.
    ///
    /// Raises SceneError where the mechanism cannot be assembled or cannot start.
    fn inspect<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let simulation = compiled(py, &self.scene)?;
        let inspection = json(&simulation.inspect());
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
    /// modes.
    #[pyo3(signature = (at=0.0, contacts="as-is", count=None))]
    fn modes<'py>(
        &self,
        py: Python<'py>,
        at: f64,
        contacts: &str,
        count: Option<usize>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let scene = match contacts {
            "as-is" | "open" => Scene::clone(&self.scene),
            "ideal" => {
                let removed = SceneEffect::Clearance.removed_from(&self.scene);
                removed.map_err(|error| scene_error(py, &error))?
            }
            other => {
                let message =
                    format!("contacts = {other:?}: it is \"as-is\", \"open\" or \"ideal\"");
                return Err(raise::<PyValueError>(message));
            }
        };
        let duration = self.scene.simulation.duration;
        if !(0.0..=duration).contains(&at) {
            let message = format!("at = {at} lies outside the duration, 0 to {duration} s");
            return Err(raise::<PyValueError>(message));
        }
        let mut simulation = compiled(py, &scene)?;
        let mut warnings = Vec::new();
        if at > 0.0 || scene.simulation.analysis == Analysis::Static {
            let reached = simulation.approach(at, &mut ());
            let raised = take_raised();
            let failed = |error: looselink::simulate::RunError| {
                raise::<PyRuntimeError>(messages::run_failure(&error))
            };
            raised.map_or_else(|| reached.map_err(failed), Err)?;
            warnings = simulation.report().warnings();
        }
        let found = simulation.modes(contacts == "open");
        let found = found.map_err(|error| raise::<PyRuntimeError>(error.to_string()))?;
        warnings.extend(found.asymmetry_note());
        warn(py, warnings)?;
        let model = simulation.model();
        let names = &model.unknown_names()[..model.shape().unknowns];
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
        if !slf.borrow().given.is_empty() {
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
    /// after Ctrl-C; what a callable raises. The last three have a `run` with the rows so far, too, once rows have come.
    #[pyo3(signature = (progress=None, out=None, force=false))]
    fn run(
        &self,
        py: Python,
        progress: Option<&Bound<PyAny>>,
        out: Option<PathBuf>,
        force: bool,
    ) -> PyResult<Py<PyRun>> {
        run(
            py,
            self.scene.clone(),
            ProgressDisplay::new(progress)?,
            out,
            force,
        )
    }
}
