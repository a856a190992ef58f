//! A result of `looselink run`, read back.

use super::moved::bounds;
use super::reading::{ViewError, of_one_run, read};
use indexmap::IndexMap;
use looselink::modes::NaturalMode;
use looselink::record::MotionLayout;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use numbers::exact;
use serde::Deserialize;
use std::f64::consts::TAU;
use std::io;
use std::path::Path;
use std::rc::Rc;
use texts::csv::text_of;

/// A result.
#[derive(Debug)]
pub struct StoredResult {
    /// The folder, without where it is.
    pub name: String,
    /// What was simulated.
    pub scene: Scene,
    /// Status, warnings and overrides.
    pub summary: StoredSummary,
    /// Time of every row \[s\].
    pub times: Vec<f64>,
    /// The other channels, column by column.
    pub channels: Vec<StoredChannel>,
}

/// A result with its mechanism and its motion.
#[derive(Debug)]
pub struct StoredRun {
    /// Scene, summary and channels.
    pub result: StoredResult,
    /// The compiled mechanism.
    pub simulation: Rc<Simulation>,
    /// What stands in a row of motion.
    pub layout: MotionLayout,
    /// Rows of motion.
    pub motion: Vec<Vec<f64>>,
}

/// A channel of a result.
#[derive(Debug)]
pub struct StoredChannel {
    /// Its name.
    pub name: String,
    /// Its unit; 1 where it has none.
    pub unit: String,
    /// Its value at every row.
    pub values: Vec<f64>,
}

/// What the viewer needs of `summary.json`.
#[derive(Debug, Deserialize)]
pub struct StoredSummary {
    scene_hash: String,
    /// `path=value` changes of the scene.
    pub overrides: Vec<String>,
    /// `complete`, `incomplete` or `failed`.
    pub status: String,
    /// Why, for a run that could not go on.
    pub error: Option<String>,
    /// What the run warned of.
    #[serde(default)]
    pub warnings: Vec<String>,
}

impl StoredSummary {
    /// True of a run that nobody killed and that is not under way.
    fn has_ended(&self) -> bool {
        self.status != "incomplete"
    }

    /// Reads the scene of the result in a folder, and what was kept of the run beside its rows.
    ///
    /// # Errors
    /// A folder without a result, and files that do not belong together.
    pub fn load(folder: &Path) -> Result<(Scene, StoredSummary), ViewError> {
        let summary = read(folder, "summary.json", false)?;
        let summary: StoredSummary = serde_json::from_slice(&summary).map_err(|e| {
            damaged(
                &folder.join("summary.json"),
                &not_read(&e, "the summary of a run"),
            )
        })?;
        read(folder, "scene.toml", false)?;
        let scene = Scene::load(&folder.join("scene.toml"), &summary.overrides)?;
        if scene.hash() != summary.scene_hash {
            let message = "it is not the scene of the run that wrote `summary.json`";
            return Err(damaged(&folder.join("scene.toml"), message));
        }
        Ok((scene, summary))
    }
}

impl StoredResult {
    /// Reads the result in a folder. Of a run that was stopped or is under way the rows so far are read.
    ///
    /// # Errors
    /// A folder without a result, and files that do not belong together.
    pub fn load(folder: &Path) -> Result<StoredResult, ViewError> {
        of_one_run(folder, || StoredResult::load_once(folder))
    }

    fn load_once(folder: &Path) -> Result<StoredResult, ViewError> {
        let (scene, summary) = StoredSummary::load(folder)?;
        let format = scene.output.format;
        let table = format.file("channels");
        let bytes = read(folder, &table, summary.has_ended())?;
        let mut channels = columns(&folder.join(&table), &bytes, format.name)?;
        let times = channels.remove(0).values;
        if times.is_empty() {
            return Err(without_rows(folder, &summary));
        }
        let place = folder.canonicalize();
        let name = place.iter().filter_map(|place| place.file_name()).next();
        Ok(StoredResult {
            name: name.map_or(String::new(), |name| name.to_string_lossy().into_owned()),
            scene,
            summary,
            times,
            channels,
        })
    }

    /// The method and what its steps follow.
    pub fn method(&self) -> String {
        self.scene.integrator.description()
    }
}

impl StoredRun {
    /// Reads the result in a folder with its motion.
    ///
    /// # Errors
    /// As [`StoredResult::load`], and a result without its motion.
    pub fn load(folder: &Path) -> Result<StoredRun, ViewError> {
        let (result, names, motion) = of_one_run(folder, || {
            let mut result = StoredResult::load_once(folder)?;
            if !result.scene.output.motion {
                return Err(ViewError::Result(format!(
                    "`{}` has no motion to show: the scene says `output.motion = false`",
                    folder.display()
                )));
            }
            let bytes = read(folder, "motion.bin", result.summary.has_ended())?;
            let (names, mut motion) = rows(&folder.join("motion.bin"), &bytes)?;
            // of a run under way one table can be some rows ahead of the other
            let count = motion.len().min(result.times.len());
            if count == 0 && !result.summary.has_ended() {
                return Err(without_rows(folder, &result.summary));
            }
            motion.truncate(count);
            result.times.truncate(count);
            for channel in &mut result.channels {
                channel.values.truncate(count);
            }
            Ok((result, names, motion))
        })?;
        let simulation = Simulation::new(&result.scene)?;
        let layout = MotionLayout::new(simulation.model());
        if names != layout.names() {
            let message =
                "its columns are not those of the scene; another version of the program wrote it";
            return Err(damaged(&folder.join("motion.bin"), message));
        }
        if motion.is_empty() {
            return Err(without_rows(folder, &result.summary));
        }
        Ok(StoredRun {
            result,
            simulation: Rc::new(simulation),
            layout,
            motion,
        })
    }

    /// A run that a program has kept in memory, as [`StoredRun::load`] reads it from a folder called `name`: its summary, as
    /// [`looselink::output::summary`] gives it, its channels, first the time, and its rows of motion, as many as rows of channels.
    ///
    /// # Errors
    /// A scene that does not compile, a run without a row, and rows of the motion of another scene.
    pub fn kept(
        name: String,
        scene: Scene,
        summary: &[u8],
        mut channels: Vec<StoredChannel>,
        motion: Vec<Vec<f64>>,
    ) -> Result<StoredRun, ViewError> {
        let simulation = Simulation::new(&scene)?;
        let times = channels.remove(0).values;
        if times.is_empty() {
            return Err(ViewError::Result("the run holds no row yet".to_owned()));
        }
        let layout = MotionLayout::new(simulation.model());
        if motion.iter().any(|row| row.len() != layout.names().len()) {
            let message = "the rows of the motion are not those of the scene";
            return Err(ViewError::Result(message.to_owned()));
        }
        let result = StoredResult {
            name,
            scene,
            summary: serde_json::from_slice(summary).map_err(io::Error::from)?,
            times,
            channels,
        };
        Ok(StoredRun {
            result,
            layout,
            simulation: Rc::new(simulation),
            motion,
        })
    }
}

/// Rows of a period in which a mode swings, and periods.
const PERIOD: usize = 48;
const PERIODS: usize = 4;
/// Largest distance by which a mode that swings moves a point, relative to the size of the mechanism.
const AMPLITUDE: f64 = 0.05;

impl StoredRun {
    /// A mode that swings about the pose that a simulation has reached, and the pose at rest. Loose joints are drawn as they are
    /// in the pose.
    pub fn swinging(
        scene: &Scene,
        title: String,
        about: &Rc<Simulation>,
        mode: &NaturalMode,
    ) -> [StoredRun; 2] {
        let pose = || StoredRun::pose(scene.clone(), about.clone());
        let (mut run, mut rest) = (pose(), pose());
        let at_rest = rest.motion[0].clone();
        let [least_x, least_y, greatest_x, greatest_y] = bounds(&rest);
        let amplitude = AMPLITUDE * (greatest_x - least_x).max(greatest_y - least_y);
        let moved = |k: usize| {
            let part = amplitude * (TAU * k as f64 / PERIOD as f64).cos();
            let mut at = about.state().clone();
            let shape = at.q.iter_mut().zip(&mode.shape);
            shape.for_each(|(q, x)| *q += part * x);
            let mut row = Vec::new();
            rest.layout.measure(about.model(), &at, &mut row);
            for first in rest.layout.loose() {
                row[first..first + 4].copy_from_slice(&at_rest[first..first + 4]);
            }
            row
        };
        run.result.scene.title = title;
        let rows = PERIODS * PERIOD;
        let time = |k: usize| k as f64 / PERIOD as f64 / mode.frequency;
        run.result.times = (0..=rows).map(time).collect();
        run.motion = (0..=rows).map(moved).collect();
        rest.result.times.push(time(rows));
        rest.motion.push(at_rest);
        [run, rest]
    }

    /// The pose that a simulation has reached, as a run of one row.
    fn pose(scene: Scene, simulation: Rc<Simulation>) -> StoredRun {
        let (model, at) = (simulation.model(), simulation.state());
        let layout = MotionLayout::new(model);
        let mut row = Vec::new();
        layout.measure(model, at, &mut row);
        let result = StoredResult {
            name: format!("pose at t = {} s", exact(at.t)),
            summary: StoredSummary {
                scene_hash: scene.hash(),
                overrides: scene.overrides().map(str::to_owned).collect(),
                status: "complete".to_owned(),
                error: None,
                warnings: Vec::new(),
            },
            scene,
            times: vec![0.0],
            channels: Vec::new(),
        };
        StoredRun {
            result,
            simulation,
            layout,
            motion: vec![row],
        }
    }
}

fn without_rows(folder: &Path, summary: &StoredSummary) -> ViewError {
    let name = folder.display();
    ViewError::Result(match summary.has_ended() {
        true => format!("the run in `{name}` ended before its first row"),
        false => format!("`{name}` holds no row yet"),
    })
}

fn damaged(path: &Path, message: &str) -> ViewError {
    ViewError::Result(format!("`{}`: {message}", path.display()))
}

/// Where JSON is not what it should be. What it is stays unsaid: any file may stand in the place of one of a result.
fn not_read(error: &serde_json::Error, wanted: &str) -> String {
    format!(
        "line {}, column {}: it is not {wanted}",
        error.line(),
        error.column()
    )
}

/// What precedes the rows of `motion.bin`.
#[derive(Deserialize)]
struct MotionHeader {
    columns: Vec<String>,
}

/// The names of the columns of `motion.bin`, and its whole rows.
fn rows(path: &Path, bytes: &[u8]) -> Result<(Vec<String>, Vec<Vec<f64>>), ViewError> {
    let end = bytes.iter().position(|b| *b == b'\n');
    let header = end.and_then(|end| serde_json::from_slice(&bytes[..end]).ok());
    let (Some(end), Some(MotionHeader { columns })) = (end, header) else {
        return Err(damaged(path, "its first line does not name its columns"));
    };
    if columns.is_empty() {
        return Err(damaged(path, "it has no columns"));
    }
    let rows = bytes[end + 1..].chunks_exact(8 * columns.len());
    let number = |b: &[u8]| f64::from_le_bytes(std::array::from_fn(|i| b[i]));
    let rows = rows.map(|row| row.chunks_exact(8).map(number).collect());
    let rows = rows.collect();
    Ok((columns, rows))
}

/// The whole rows of a table of channels, column by column; the first is the time.
fn columns(path: &Path, bytes: &[u8], format: &str) -> Result<Vec<StoredChannel>, ViewError> {
    // a row is whole when it ends with a line feed
    let whole = bytes
        .iter()
        .rposition(|b| *b == b'\n')
        .map_or(0, |end| end + 1);
    let read = match format {
        "csv" => read_csv(&bytes[..whole]),
        "json_lines" => read_json_lines(&bytes[..whole]),
        other => Err(format!("tables of the format {other:?} cannot be read")),
    };
    let channels = read.map_err(|message| damaged(path, &message))?;
    match channels.first() {
        None => Err(damaged(path, "it holds no row yet")),
        Some(first) if first.name != "t" => {
            Err(damaged(path, "its first column is not the time `t [s]`"))
        }
        Some(_) => Ok(channels),
    }
}

fn channel(heading: &str) -> StoredChannel {
    let (name, unit) = heading.split_once(" [").unwrap_or((heading, "1]"));
    StoredChannel {
        name: name.to_owned(),
        unit: unit.trim_end_matches(']').to_owned(),
        values: Vec::new(),
    }
}

fn read_csv(bytes: &[u8]) -> Result<Vec<StoredChannel>, String> {
    let mut reader = csv::Reader::from_reader(bytes);
    let headings = reader.headers().map_err(|e| e.to_string())?;
    let mut channels: Vec<_> = headings.iter().map(text_of).map(channel).collect();
    for row in reader.deserialize() {
        let row: Vec<f64> = row.map_err(|e: csv::Error| e.to_string())?;
        for (channel, value) in channels.iter_mut().zip(row) {
            channel.values.push(value);
        }
    }
    Ok(channels)
}

fn read_json_lines(bytes: &[u8]) -> Result<Vec<StoredChannel>, String> {
    let mut channels: Vec<StoredChannel> = Vec::new();
    for row in serde_json::Deserializer::from_slice(bytes).into_iter() {
        let row: IndexMap<String, f64> = row.map_err(|e| not_read(&e, "a row of numbers"))?;
        if channels.is_empty() {
            channels = row.keys().map(|heading| channel(heading)).collect();
        }
        for (channel, value) in channels.iter_mut().zip(row.into_values()) {
            channel.values.push(value);
        }
    }
    Ok(channels)
}
