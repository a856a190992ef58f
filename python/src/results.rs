//! The results of a run.

use super::callable::watching;
use super::errors::{output_error, raise};
use super::memory::Memory;
use super::pickle::{Pickled, deep_copy, pickled, remember};
use super::scene::{PyScene, from_json};
use super::snapshot::Snapshot;
use super::view::PyView;
use looselink::document::nearest;
use looselink::output::summary;
use looselink::record::patterns;
use looselink::simulate::{Channel, Impact, Report};
use messages::closing_table;
use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyException, PyKeyError, PyRuntimeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyList};
use serde::Deserialize;
use std::sync::OnceLock;
use view::{StoredChannel, StoredRun, page};

/// The results of a run: a mapping from the names of channels to arrays over time.
///
/// `run["error.x"]` is a float64 array of shape (rows,) in the unit `run.units["error.x"]`. It holds the memory that the solver has
/// filled, without a copy, and is read-only; `.copy()` gives one that can be changed.
#[pyclass(module = "looselink", name = "Run", frozen, mapping)]
pub struct PyRun {
    /// Nothing before a pickle has filled it.
    kept: OnceLock<Kept>,
}

/// A channel over time.
#[derive(FromPyObject, IntoPyObjectRef)]
#[pyo3(from_item_all)]
struct Column {
    name: String,
    unit: String,
    values: Py<PyArray1<f64>>,
}

/// How many numbers a row of the motion has, and the rows one after the other.
type Motion = (usize, Py<PyArray1<f64>>);

/// The scene of a run as it was run.
#[derive(FromPyObject, IntoPyObjectRef)]
enum RunScene {
    Known(Py<PyScene>),
    /// Why a pickle does not hold it.
    Refused(String),
}

/// What a run is; as an object of Python a dict.
#[derive(FromPyObject, IntoPyObjectRef)]
#[pyo3(from_item_all)]
struct Kept {
    scene: RunScene,
    /// The folder of its files, without where it is.
    name: String,
    columns: Vec<Column>,
    onsets: Py<PyDict>,
    /// What `summary.json` holds, and the same as Python has it.
    record: String,
    summary: Py<PyAny>,
    /// The lines of the closing table.
    closing: Vec<String>,
    motion: Option<Motion>,
}

/// What is told of a run, from its summary.
#[derive(Deserialize)]
struct Told {
    title: String,
    status: String,
    t: f64,
    warnings: Vec<String>,
    notes: Vec<String>,
}

impl PyRun {
    pub fn new(
        py: Python,
        snapshot: Snapshot,
        name: String,
        channels: &[Channel],
        memory: Memory,
        report: &Report,
    ) -> PyResult<PyRun> {
        let record = summary(&snapshot.scene, report).map_err(|error| output_error(&error))?;
        let columns = channels.iter().zip(memory.columns);
        let columns = columns.map(|(channel, values)| Column {
            name: channel.name.clone(),
            unit: channel.unit.to_owned(),
            values: PyArray1::from_vec(py, values).unbind(),
        });
        let motion = memory.motion.map(|(layout, numbers)| {
            let numbers = PyArray1::from_vec(py, numbers);
            (layout.names().len(), numbers.unbind())
        });
        let run = PyRun::blank();
        run.fill(
            py,
            Kept {
                scene: RunScene::Known(Py::new(py, PyScene::new(snapshot))?),
                name,
                columns: columns.collect(),
                onsets: onsets(py, &memory.contacts)?.unbind(),
                summary: from_json(py, &record)?.unbind(),
                record: String::from_utf8(record)?,
                closing: closing_table(report),
                motion,
            },
        )?;
        Ok(run)
    }

    /// A run that receives its content later: what it holds may refer to it.
    pub fn blank() -> PyRun {
        PyRun {
            kept: OnceLock::new(),
        }
    }

    /// Gives a blank run its content, whose arrays become read-only.
    fn fill(&self, py: Python, kept: Kept) -> PyResult<()> {
        for array in kept.arrays(py) {
            array.call_method1("setflags", (false,))?;
        }
        let filled = self.kept.set(kept);
        filled.map_err(|_| raise::<PyRuntimeError>("the run has a content already"))
    }

    fn kept(&self) -> PyResult<&Kept> {
        let kept = self.kept.get();
        kept.ok_or_else(|| raise::<PyRuntimeError>("the run has no content"))
    }
}

impl Kept {
    /// What is told of the run.
    ///
    /// # Errors
    /// A summary that is not one.
    fn told(&self) -> PyResult<Told> {
        serde_json::from_str(&self.record).map_err(raise::<PyValueError>)
    }

    /// As a dict without what cannot be pickled.
    fn pickled<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let state = self.into_pyobject(py)?;
        if let RunScene::Known(scene) = &self.scene
            && let Err(error) = scene.get().check(py)
        {
            // not an interrupt
            if !error.is_instance_of::<PyException>(py) {
                return Err(error);
            }
            state.set_item("scene", error.value(py).str()?)?;
        }
        Ok(state)
    }

    /// All arrays.
    fn arrays<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyAny>> {
        let columns = self.columns.iter().map(|column| &column.values);
        let motion = self.motion.iter().map(|(_, numbers)| numbers);
        let numbers = columns.chain(motion);
        let numbers = numbers.map(|array| array.bind(py).clone().into_any());
        let onsets = self.onsets.bind(py).values().into_iter();
        numbers.chain(onsets).collect()
    }

    fn column(&self, name: &str) -> PyResult<&Column> {
        let known = self.columns.iter().find(|column| column.name == name);
        known.ok_or_else(|| {
            let names = self.columns.iter().map(|column| column.name.as_str());
            let near = nearest(name, names).map_or_else(
                || "; `run.channels` names all".to_owned(),
                |near| format!("; did you mean {near:?}?"),
            );
            raise::<PyKeyError>(format!("no channel of this run is named {name:?}{near}"))
        })
    }

    /// The columns under the headings of `channels.csv`.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = PyDict::new(py);
        for Column { name, unit, values } in &self.columns {
            table.set_item(format!("{name} [{unit}]"), values)?;
        }
        Ok(table)
    }

    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for Column { name, unit, .. } in &self.columns {
            units.set_item(name, unit)?;
        }
        Ok(units)
    }

    /// The page of the run.
    fn page(&self, py: Python) -> PyResult<String> {
        let Some((width, motion)) = &self.motion else {
            let message = "the run has no motion to show: the scene says `output.motion = false`";
            return Err(raise::<PyValueError>(message));
        };
        let motion = motion.bind(py).try_readonly()?;
        let motion = motion.as_slice()?.chunks_exact((*width).max(1));
        let mut channels = Vec::new();
        for Column { name, unit, values } in &self.columns {
            let values = values.bind(py).try_readonly()?;
            let values = values.as_slice()?;
            channels.push(StoredChannel {
                name: name.clone(),
                unit: unit.clone(),
                values: values[..values.len().min(motion.len())].to_vec(),
            });
        }
        let motion = motion.take(channels[0].values.len());
        let motion = motion.map(<[f64]>::to_vec).collect();
        let scene = match &self.scene {
            RunScene::Known(scene) => scene.get().now(py)?,
            RunScene::Refused(why) => {
                let message = format!("the run was pickled without its scene: {why}");
                return Err(raise::<PyValueError>(message));
            }
        };
        scene.evaluate(py, |scene| {
            let (name, scene, record) = (self.name.clone(), scene.clone(), self.record.as_bytes());
            let page =
                || StoredRun::kept(name, scene, record, channels, motion).map(|run| page(&[run]));
            py.detach(|| watching(page))
                .map_err(|error| raise::<PyValueError>(error.to_string()))
        })
    }
}

/// The columns of `onsets.csv`.
fn onsets<'py>(py: Python<'py>, contacts: &[Impact]) -> PyResult<Bound<'py, PyDict>> {
    let column = |value: fn(&Impact) -> f64| {
        let values = contacts.iter().map(value).collect();
        PyArray1::from_vec(py, values)
    };
    let joints = contacts.iter().map(|contact| contact.joint.as_str());
    let joints = PyList::new(py, joints.collect::<Vec<_>>())?;
    let joints = py.import("numpy")?.call_method1("array", (joints, "str"))?;
    let table = PyDict::new(py);
    table.set_item("t", column(|c| c.t))?;
    table.set_item("joint", joints)?;
    table.set_item("impact_velocity", column(|c| c.impact_velocity))?;
    table.set_item("delta", column(|c| c.delta))?;
    table.set_item("angle", column(|c| c.angle))?;
    table.set_item("deepest_penetration", column(|c| c.deepest_penetration))?;
    table.set_item("largest_force", column(|c| c.largest_force))?;
    table.set_item("end", column(|c| c.end.unwrap_or(f64::NAN)))?;
    let exit_velocity = column(|c| c.exit_velocity.unwrap_or(f64::NAN));
    table.set_item("exit_velocity", exit_velocity)?;
    Ok(table)
}

#[pymethods]
impl PyRun {
    /// The channel `name` over time.
    ///
    /// Raises KeyError for an unknown name, with the nearest known one.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.kept()?.column(name)?.values.bind(py).clone())
    }

    fn __contains__(&self, name: &Bound<PyAny>) -> PyResult<bool> {
        let kept = self.kept()?;
        let name = name.extract::<String>();
        Ok(name.is_ok_and(|name| kept.column(&name).is_ok()))
    }

    /// The number of channels.
    fn __len__(&self) -> PyResult<usize> {
        Ok(self.kept()?.columns.len())
    }

    /// The names of the channels.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.channels()?)?.try_iter()
    }

    fn __repr__(&self, py: Python) -> PyResult<String> {
        let kept = self.kept()?;
        let told = kept.told()?;
        Ok(format!(
            "<looselink.Run {:?}, {}: {} channels, {} rows to t = {} s>",
            told.title,
            told.status,
            kept.columns.len(),
            kept.columns[0].values.bind(py).len(),
            numbers::exact(told.t)
        ))
    }

    /// What `repr` says, and below it the closing table of `looselink run`: errors of driven bodies, forces, drives, contacts, energy.
    fn __str__(&self, py: Python) -> PyResult<String> {
        let kept = self.kept()?;
        let mut lines = vec![self.__repr__(py)?];
        lines.extend_from_slice(&kept.closing);
        let notes = kept.told()?.notes.into_iter();
        lines.extend(notes.map(|note| format!("note: {note}")));
        Ok(lines.join("\n"))
    }

    /// The names of the channels, the time "t" first.
    #[getter]
    fn channels(&self) -> PyResult<Vec<&str>> {
        let columns = self.kept()?.columns.iter();
        Ok(columns.map(|column| column.name.as_str()).collect())
    }

    /// The names of the channels, so that `dict(run)` works.
    fn keys(&self) -> PyResult<Vec<&str>> {
        self.channels()
    }

    /// The time of every row [s].
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.kept()?.columns[0].values.bind(py).clone())
    }

    /// The unit of every channel; "1" of a number without one.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.kept()?.units(py)
    }

    /// The contacts in the order in which they ended, as in onsets.csv: a dict of read-only arrays t [s], joint (str),
    /// impact_velocity [m/s], delta [m], angle [rad], deepest_penetration [m], largest_force [N], end [s] and exit_velocity
    /// [m/s]. The last two are NaN of a contact that is closed when the run ends.
    #[getter]
    fn onsets(&self, py: Python) -> PyResult<Py<PyDict>> {
        Ok(self.kept()?.onsets.clone_ref(py))
    }

    /// What summary.json says: title, overrides, status, counts of the work done, energy ledger, extremes, what the run came to
    /// (`closing`), warnings, notes.
    #[getter]
    fn summary(&self, py: Python) -> PyResult<Py<PyAny>> {
        Ok(self.kept()?.summary.clone_ref(py))
    }

    /// Which results are in doubt, why, and what to do, one line each.
    #[getter]
    fn warnings(&self) -> PyResult<Vec<String>> {
        Ok(self.kept()?.told()?.warnings)
    }

    /// Facts about the run that put no result in doubt, one line each: redundant constraints, large strains, counts of the solver.
    #[getter]
    fn notes(&self) -> PyResult<Vec<String>> {
        Ok(self.kept()?.told()?.notes)
    }

    /// "complete", "incomplete" (stopped) or "failed".
    #[getter]
    fn status(&self) -> PyResult<String> {
        Ok(self.kept()?.told()?.status)
    }

    /// The channels whose names match `pattern`, as a dict from names to arrays; `*` stands for any sequence of characters, as in
    /// `output.channels` of a scene.
    ///
    /// Raises KeyError where none matches.
    fn select<'py>(&self, py: Python<'py>, pattern: &str) -> PyResult<Bound<'py, PyDict>> {
        let kept = self.kept()?;
        let names = kept.columns.iter().map(|column| &*column.name);
        let selected = PyDict::new(py);
        for k in patterns::choose([pattern], names).names {
            let column = &kept.columns[k];
            selected.set_item(&column.name, &column.values)?;
        }
        if selected.is_empty() {
            kept.column(pattern)?;
        }
        Ok(selected)
    }

    /// The channels as a pandas.DataFrame without a copy. Its columns are called "name [unit]", as in channels.csv;
    /// `.attrs["units"]` has the units by name.
    ///
    /// Raises ImportError without pandas (`pip install looselink[pandas]`).
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let kept = self.kept()?;
        let options = PyDict::new(py);
        options.set_item("copy", false)?;
        let pandas = py.import("pandas")?;
        let frame = pandas.call_method("DataFrame", (kept.table(py)?,), Some(&options))?;
        let attributes = frame.getattr("attrs")?;
        attributes.set_item("title", kept.told()?.title)?;
        attributes.set_item("units", kept.units(py)?)?;
        Ok(frame)
    }

    /// The channels as a polars.DataFrame. Its columns are called "name [unit]", as in channels.csv.
    ///
    /// Raises ImportError without Polars (`pip install looselink[polars]`).
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("polars")?
            .call_method1("DataFrame", (self.kept()?.table(py)?,))
    }

    /// The run as a page in which the mechanism moves, as `looselink view` writes it. In a notebook it is shown with this `height`
    /// [pixels].
    ///
    /// Raises ValueError where the run has no motion, because the scene says `output.motion = false`, or no row yet.
    #[pyo3(signature = (height=600))]
    fn view(&self, py: Python, height: u32) -> PyResult<PyView> {
        let page = self.kept()?.page(py)?;
        Ok(PyView { page, height })
    }

    /// A copy, which has the same arrays, onsets and summary.
    fn __copy__(&self, py: Python) -> PyResult<PyRun> {
        let copy = PyRun::blank();
        copy.fill(py, self.kept()?.into_pyobject(py)?.extract()?)?;
        Ok(copy)
    }

    /// A copy with copies of all that it holds.
    fn __deepcopy__<'py>(
        slf: &Bound<'py, Self>,
        memo: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyRun>> {
        let py = slf.py();
        let kept = slf.get().kept()?.into_pyobject(py)?;
        let copy = Bound::new(py, PyRun::blank())?;
        remember(slf, &copy, memo)?;
        copy.get().fill(py, deep_copy(&kept, memo)?.extract()?)?;
        Ok(copy)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Pickled<'py, Bound<'py, PyDict>>> {
        pickled(py, "_blank_run", self.kept()?.pickled(py)?)
    }

    fn __setstate__(&self, state: &Bound<PyAny>) -> PyResult<()> {
        self.fill(state.py(), state.extract()?)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        let Some(kept) = self.kept.get() else {
            return Ok(());
        };
        if let RunScene::Known(scene) = &kept.scene {
            visit.call(scene)?;
        }
        visit.call(&kept.onsets)?;
        visit.call(&kept.summary)
    }
}
