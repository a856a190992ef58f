//! The results of a run.

use super::callable::take_raised;
use super::errors::{output_error, raise};
use super::memory::Memory;
use super::scene::from_json;
use super::view::PyView;
use looselink::document::nearest;
use looselink::output::summary;
use looselink::scene::Scene;
use looselink::simulate::{Channel, Impact, Report};
use messages::closing_table;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyList};
use std::sync::Arc;
use view::{StoredChannel, StoredRun, page};
use wildmatch::WildMatchPattern;

/// The results of a run: a mapping from the names of channels to arrays over time.
///
/// `run["error.x"]` is a float64 array of shape (rows,) in the unit `run.units["error.x"]`. It holds the memory that the solver has
/// filled, without a copy, and is read-only; `.copy()` gives one that can be changed.
#[pyclass(module = "looselink", name = "Run", frozen, mapping)]
pub struct PyRun {
    scene: Arc<Scene>,
    /// The folder of its files, without where it is.
    name: String,
    channels: Vec<Channel>,
    columns: Vec<Py<PyArray1<f64>>>,
    onsets: Py<PyDict>,
    summary: Py<PyAny>,
    pub warnings: Vec<String>,
    notes: Vec<String>,
    report: Report,
    /// Numbers in a row of the motion, and the rows one after the other.
    motion: Option<(usize, Vec<f64>)>,
}

impl PyRun {
    pub fn new(
        py: Python,
        scene: Arc<Scene>,
        name: String,
        channels: Vec<Channel>,
        memory: Memory,
        report: Report,
    ) -> PyResult<PyRun> {
        let bytes = summary(&scene, &report).map_err(|error| output_error(&error))?;
        let columns = memory.columns.into_iter();
        let columns = columns.map(|column| read_only(PyArray1::from_vec(py, column)));
        Ok(PyRun {
            columns: columns.collect(),
            onsets: onsets(py, &memory.contacts)?.unbind(),
            summary: from_json(py, &bytes)?.unbind(),
            warnings: report.warnings(),
            notes: report.notes(),
            motion: memory
                .motion
                .map(|(layout, numbers)| (layout.names().len(), numbers)),
            scene,
            name,
            channels,
            report,
        })
    }

    fn column(&self, name: &str) -> PyResult<&Py<PyArray1<f64>>> {
        let names = self.channels.iter().map(|channel| channel.name.as_str());
        if let Some(place) = names.clone().position(|known| known == name) {
            return Ok(&self.columns[place]);
        }
        let near = nearest(name, names).map_or_else(
            || "; `run.channels` names all".to_owned(),
            |near| format!("; did you mean {near:?}?"),
        );
        let message = format!("no channel of this run is named {name:?}{near}");
        Err(raise::<PyKeyError>(message))
    }

    /// The columns under the headings of `channels.csv`.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = PyDict::new(py);
        for (channel, column) in self.channels.iter().zip(&self.columns) {
            table.set_item(format!("{} [{}]", channel.name, channel.unit), column)?;
        }
        Ok(table)
    }
}

fn read_only(array: Bound<'_, PyArray1<f64>>) -> Py<PyArray1<f64>> {
    array.readwrite().make_nonwriteable();
    array.unbind()
}

/// The columns of `onsets.csv`.
fn onsets<'py>(py: Python<'py>, contacts: &[Impact]) -> PyResult<Bound<'py, PyDict>> {
    let column = |value: fn(&Impact) -> f64| {
        let values = contacts.iter().map(value).collect();
        read_only(PyArray1::from_vec(py, values))
    };
    let joints = contacts.iter().map(|contact| contact.joint.as_str());
    let joints = PyList::new(py, joints.collect::<Vec<_>>())?;
    let joints = py.import("numpy")?.call_method1("array", (joints, "str"))?;
    joints.call_method1("setflags", (false,))?;
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
        Ok(self.column(name)?.bind(py).clone())
    }

    fn __contains__(&self, name: &Bound<PyAny>) -> bool {
        let name = name.extract::<String>();
        name.is_ok_and(|name| self.column(&name).is_ok())
    }

    /// The number of channels.
    fn __len__(&self) -> usize {
        self.channels.len()
    }

    /// The names of the channels.
    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        PyList::new(py, self.channels())?.try_iter()
    }

    fn __repr__(&self, py: Python) -> String {
        let rows = self.columns[0].bind(py).len().unwrap_or_default();
        format!(
            "<looselink.Run {:?}, {}: {} channels, {rows} rows to t = {} s>",
            self.scene.title,
            self.status(),
            self.channels.len(),
            numbers::exact(self.report.t)
        )
    }

    /// What `repr` says, and below it the closing table of `looselink run`: errors of driven bodies, forces, drives, contacts, energy.
    fn __str__(&self, py: Python) -> String {
        let mut lines = vec![self.__repr__(py)];
        lines.extend(closing_table(&self.report));
        lines.extend(self.notes.iter().map(|note| format!("note: {note}")));
        lines.join("\n")
    }

    /// The names of the channels, the time "t" first.
    #[getter]
    fn channels(&self) -> Vec<&str> {
        let names = self.channels.iter();
        names.map(|channel| channel.name.as_str()).collect()
    }

    /// The names of the channels, so that `dict(run)` works.
    fn keys(&self) -> Vec<&str> {
        self.channels()
    }

    /// The time of every row [s].
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.columns[0].bind(py).clone()
    }

    /// The unit of every channel; "1" of a number without one.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for channel in &self.channels {
            units.set_item(&channel.name, channel.unit)?;
        }
        Ok(units)
    }

    /// The contacts in the order in which they ended, as in onsets.csv: a dict of read-only arrays t [s], joint (str),
    /// impact_velocity [m/s], delta [m], angle [rad], deepest_penetration [m], largest_force [N], end [s] and exit_velocity
    /// [m/s]. The last two are NaN of a contact that is closed when the run ends.
    #[getter]
    fn onsets(&self, py: Python) -> Py<PyDict> {
        self.onsets.clone_ref(py)
    }

    /// What summary.json says: title, overrides, status, counts of the work done, energy ledger, extremes, what the run came to
    /// (`closing`), warnings, notes.
    #[getter]
    fn summary(&self, py: Python) -> Py<PyAny> {
        self.summary.clone_ref(py)
    }

    /// Which results are in doubt, why, and what to do, one line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Facts about the run that put no result in doubt, one line each: redundant constraints, large strains, counts of the solver.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// "complete", "incomplete" (stopped) or "failed".
    #[getter]
    fn status(&self) -> &'static str {
        self.report.status.name()
    }

    /// The channels whose names match `pattern`, as a dict from names to arrays; `*` stands for any sequence of characters, as in
    /// `output.channels` of a scene.
    ///
    /// Raises KeyError where none matches.
    fn select<'py>(&self, py: Python<'py>, pattern: &str) -> PyResult<Bound<'py, PyDict>> {
        let wanted = WildMatchPattern::<'*', '\0'>::new(pattern);
        let selected = PyDict::new(py);
        for (channel, column) in self.channels.iter().zip(&self.columns) {
            if wanted.matches(&channel.name) {
                selected.set_item(&channel.name, column)?;
            }
        }
        if selected.is_empty() {
            self.column(pattern)?;
        }
        Ok(selected)
    }

    /// The channels as a pandas.DataFrame without a copy. Its columns are called "name [unit]", as in channels.csv;
    /// `.attrs["units"]` has the units by name.
    ///
    /// Raises ImportError without pandas (`pip install looselink[pandas]`).
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let options = PyDict::new(py);
        options.set_item("copy", false)?;
        let pandas = py.import("pandas")?;
        let frame = pandas.call_method("DataFrame", (self.table(py)?,), Some(&options))?;
        let attributes = frame.getattr("attrs")?;
        attributes.set_item("title", &self.scene.title)?;
        attributes.set_item("units", self.units(py)?)?;
        Ok(frame)
    }

    /// The channels as a polars.DataFrame. Its columns are called "name [unit]", as in channels.csv.
    ///
    /// Raises ImportError without Polars (`pip install looselink[polars]`).
    fn to_polars<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("polars")?
            .call_method1("DataFrame", (self.table(py)?,))
    }

    /// The run as a page in which the mechanism moves, as `looselink view` writes it. In a notebook it is shown with this `height`
    /// [pixels].
    ///
    /// Raises ValueError where the run has no motion, because the scene says `output.motion = false`, or no row yet.
    #[pyo3(signature = (height=600))]
    fn view(&self, py: Python, height: u32) -> PyResult<PyView> {
        let Some((width, motion)) = &self.motion else {
            let message = "the run has no motion to show: the scene says `output.motion = false`";
            return Err(raise::<PyValueError>(message));
        };
        let mut channels = Vec::new();
        let rows = motion.len() / width;
        for (channel, column) in self.channels.iter().zip(&self.columns) {
            let column = column.bind(py).try_readonly()?;
            let values = column.as_slice()?;
            channels.push(StoredChannel {
                name: channel.name.clone(),
                unit: channel.unit.to_owned(),
                values: values[..values.len().min(rows)].to_vec(),
            });
        }
        let motion = motion.chunks_exact(*width).take(channels[0].values.len());
        let motion = motion.map(<[f64]>::to_vec).collect();
        let scene = Scene::clone(&self.scene);
        let summary = summary(&scene, &self.report).map_err(|error| output_error(&error))?;
        let kept = StoredRun::kept(self.name.clone(), scene, &summary, channels, motion);
        if let Some(raised) = take_raised() {
            return Err(raised);
        }
        let kept = kept.map_err(|error| raise::<PyValueError>(error.to_string()))?;
        Ok(PyView {
            page: page(&[kept]),
            height,
        })
    }
}
