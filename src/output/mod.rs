//! A run on disk: channels and onsets as they come, and what describes them.
//!
//! | file | content |
//! |---|---|
//! | `channels.*` | one row an output interval, `name [unit]` above each column |
//! | `motion.bin` | where all bodies are, one row an output interval: see [`MotionLayout`] |
//! | `onsets.*` | one row a contact, when it opens; last those that are closed at the end, without end and exit velocity |
//! | `scene.toml` | the scene as it was read; overrides are in the summary |
//! | `summary.json` | status, counters, energy ledger, extremes, warnings |
//! | `timing.json` | wall and processor time, machine, date |
//! | `checkpoint.bin` | what an interrupted run goes on from; a complete result has none |
//! | `manifest.jsonl` | the files of the result and, of those that are written to their end, size and CRC-32: see [`mod@folder`] |
//!
//! Only `timing.json` differs when a run is repeated. `summary.json` says `incomplete` from the first rows to the last, so
//! that a run that was killed is not taken for a finished one; without a summary there is no result. A kill or a full disk
//! may cut the last row: a row is whole when it ends with a line feed. Rows that somebody else has changed while the run wrote
//! them end in an error, not in a complete result.
//!
//! A result that is replaced stands in `previous-result` inside the folder until the new one is complete.

mod checkpoint;
mod table_file;
mod timing;

use crate::model::Model;
use crate::record::MotionLayout;
use crate::scene::Scene;
use crate::simulate::{ContactEvent, Report, Simulation, Status};
use crate::system::State;
use crate::table::{Cell, Format, float64};
use checkpoint::CHECKPOINT;
pub use checkpoint::{StoredCheckpoint, program, program_is};
pub use folder;
use folder::{Digest, Folder, Kind, OutputError, json, refuse_changed};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use table_file::TableFile;
pub use timing::machine;
use timing::{Elapsed, Stopwatch};

const CHANNELS: &str = "channels";
const ONSETS: &str = "onsets";
const MOTION: &str = "motion";
const SCENE: &str = "scene.toml";
const SUMMARY: &str = "summary.json";
/// The file of what differs when a run is repeated.
pub const TIMING: &str = "timing.json";
/// The columns of the table of onsets.
const CONTACT: [&str; 9] = [
    "t [s]",
    "joint",
    "impact_velocity [m/s]",
    "delta [m]",
    "angle [rad]",
    "deepest_penetration [m]",
    "largest_force [N]",
    "end [s]",
    "exit_velocity [m/s]",
];

/// A run as a kind of result, with tables in any of some formats; `more` are files that are put beside it.
pub fn kind(formats: &[&'static Format], more: &[&str]) -> Kind {
    let tables = [CHANNELS, ONSETS].into_iter();
    let tables = tables.flat_map(|table| formats.iter().map(move |format| format.file(table)));
    let mut files = vec![SUMMARY.to_owned()];
    files.extend(tables);
    files.extend([
        float64::FORMAT.file(MOTION),
        SCENE.to_owned(),
        TIMING.to_owned(),
        CHECKPOINT.to_owned(),
    ]);
    files.extend(more.iter().map(|file| (*file).to_owned()));
    Kind {
        name: "a run",
        files,
    }
}

/// The files of the run of a scene, the summary last.
fn files(scene: &Scene) -> Vec<String> {
    let format = scene.output.format;
    let mut files = vec![format.file(CHANNELS), format.file(ONSETS)];
    files.extend(scene.output.motion.then(|| float64::FORMAT.file(MOTION)));
    files.extend([SCENE, TIMING, CHECKPOINT, SUMMARY].map(str::to_owned));
    files
}

/// A result being written.
#[derive(Debug)]
pub struct Results {
    folder: Folder,
    header: Header,
    tables: Tables,
    /// That of the scene's file.
    scene: Digest,
    /// SHA-256 of the program, known from the first checkpoint on.
    program: Option<String>,
    /// A row of motion, and one of cells.
    values: Vec<f64>,
    cells: Vec<Cell<'static>>,
    stopwatch: Stopwatch,
}

/// The files with rows.
#[derive(Debug)]
struct Tables {
    channels: TableFile,
    onsets: TableFile,
    motion: Option<(MotionLayout, TableFile)>,
}

impl Tables {
    /// Opens each by `open`, first the channels.
    fn new(
        scene: &Scene,
        simulation: &Simulation,
        open: impl Fn(&str, &'static Format, Vec<String>) -> Result<TableFile, OutputError>,
    ) -> Result<Tables, OutputError> {
        let open =
            |table, format: &'static Format, columns| open(&format.file(table), format, columns);
        let format = scene.output.format;
        let channels = simulation.channels().iter();
        let channels = channels.map(|c| format!("{} [{}]", c.name, c.unit));
        let channels = open(CHANNELS, format, channels.collect())?;
        let onsets = CONTACT.map(str::to_owned).to_vec();
        let onsets = open(ONSETS, format, onsets)?;
        let motion = scene.output.motion.then(|| {
            let layout = MotionLayout::new(simulation.model());
            let table = open(MOTION, &float64::FORMAT, layout.names().to_vec())?;
            Ok::<_, OutputError>((layout, table))
        });
        Ok(Tables {
            channels,
            onsets,
            motion: motion.transpose()?,
        })
    }

    fn all(&mut self) -> impl Iterator<Item = &mut TableFile> {
        let motion = self.motion.iter_mut().map(|(_, table)| table);
        [&mut self.channels, &mut self.onsets]
            .into_iter()
            .chain(motion)
    }
}

/// What is known of a run before it starts.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Header {
    title: String,
    scene_hash: String,
    overrides: Vec<String>,
    version: String,
}

impl Header {
    /// That of a run of a scene by this program.
    fn new(scene: &Scene) -> Header {
        Header {
            title: scene.title.clone(),
            scene_hash: scene.hash(),
            overrides: scene.overrides().map(str::to_owned).collect(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

#[derive(Serialize)]
struct Summary<'a, R> {
    #[serde(flatten)]
    header: &'a Header,
    #[serde(flatten)]
    report: R,
}

#[derive(Serialize)]
struct Ended<'a> {
    #[serde(flatten)]
    report: &'a Report,
    warnings: Vec<String>,
    notes: Vec<String>,
}

impl Ended<'_> {
    fn new(report: &Report) -> Ended<'_> {
        Ended {
            report,
            warnings: report.warnings(),
            notes: report.notes(),
        }
    }
}

/// The summary of a run that has ended, as `summary.json` holds it.
///
/// # Errors
/// A number that JSON cannot hold.
pub fn summary(scene: &Scene, report: &Report) -> Result<Vec<u8>, OutputError> {
    let header = &Header::new(scene);
    let report = Ended::new(report);
    json(&Summary { header, report })
}

impl Results {
    /// Starts a result in a folder that was claimed for a [`kind`] of it; files that are not part of one are left alone.
    ///
    /// # Errors
    /// When the folder or a file cannot be written.
    pub fn begin(
        mut folder: Folder,
        scene: &Scene,
        simulation: &Simulation,
    ) -> Result<Results, OutputError> {
        folder.begin(files(scene))?;
        let tables = Tables::new(scene, simulation, |name, format, columns| {
            TableFile::create(&folder, name, format, columns)
        })?;
        let results = Results::new(folder, scene, tables, Elapsed::NONE)?;
        results.folder.replace(SCENE, scene.text().as_bytes())?;
        Ok(results)
    }

    /// Continues the result of a run that was interrupted: brings a fresh simulation of the scene to where the run was, and
    /// cuts what was written after its checkpoint.
    ///
    /// # Errors
    /// [`OutputError::NotResumable`] for another scene or another program, and for rows that were changed; the result is then
    /// as it was. As [`Results::begin`] later.
    pub fn resume(
        from: StoredCheckpoint,
        scene: &Scene,
        simulation: &mut Simulation,
    ) -> Result<Results, OutputError> {
        let program = program()?;
        from.check(&Header::new(scene), &program)?;
        let tables = Tables::new(scene, simulation, |name, format, columns| {
            TableFile::reopen(from.folder(), name, format, columns, from.rows(name))
        });
        let mut tables = tables.map_err(|e| from.refused(e.to_string()))?;
        from.restore(simulation)?;
        let elapsed = from.elapsed();
        let mut folder = from.into_folder();
        // readers take no digest of the rows so far for that of all
        folder.list(files(scene).into_iter().map(|file| (file, None)))?;
        tables.all().try_for_each(TableFile::cut)?;
        let mut results = Results::new(folder, scene, tables, elapsed)?;
        results.program = Some(program);
        Ok(results)
    }

    /// A result whose tables are open; its summary says that it is incomplete.
    fn new(
        folder: Folder,
        scene: &Scene,
        tables: Tables,
        elapsed: Elapsed,
    ) -> Result<Results, OutputError> {
        let header = Header::new(scene);
        let pending = BTreeMap::from([("status", Status::Incomplete)]);
        write_summary(&folder, &header, pending)?;
        Ok(Results {
            folder,
            header,
            tables,
            scene: Digest::of(scene.text().as_bytes()),
            program: None,
            values: Vec::new(),
            cells: Vec::new(),
            stopwatch: Stopwatch::start(elapsed),
        })
    }

    /// Stores a checkpoint at time `t`, with all rows so far.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn checkpoint(&mut self, t: f64, bytes: &[u8]) -> Result<(), OutputError> {
        let program = match &self.program {
            Some(program) => program,
            None => self.program.insert(program()?),
        };
        let rows = self.tables.all().map(|table| {
            let digest = table.sync()?;
            Ok::<_, io::Error>((table.name(), digest))
        });
        let rows = rows.collect::<Result<_, _>>()?;
        let elapsed = self.stopwatch.elapsed();
        let Results { folder, header, .. } = self;
        checkpoint::write(folder, t, header, program, rows, elapsed, bytes)
    }

    /// Appends a row of channels.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        write_numbers(&mut self.tables.channels, values, &mut self.cells)
    }

    /// Appends a row of the motion.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn state(&mut self, model: &Model, at: &State) -> io::Result<()> {
        let Some((layout, table)) = &mut self.tables.motion else {
            return Ok(());
        };
        self.values.clear();
        layout.measure(model, at, &mut self.values);
        write_numbers(table, &self.values, &mut self.cells)
    }

    /// Appends a contact; what a contact without an end does not have stays empty.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        let ContactEvent {
            onset,
            deepest_penetration,
            largest_force,
            end,
        } = contact;
        let [t, exit_velocity] = match end {
            Some(end) => [end.t, end.exit_velocity].map(Cell::Number),
            None => [Cell::Empty; 2],
        };
        self.tables.onsets.row(&[
            Cell::Number(onset.t),
            Cell::Word(onset.joint),
            Cell::Number(onset.impact_velocity),
            Cell::Number(onset.delta),
            Cell::Number(onset.angle),
            Cell::Number(*deepest_penetration),
            Cell::Number(*largest_force),
            t,
            exit_velocity,
        ])
    }

    /// Hands everything so far to the system, for readers of a running simulation.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn flush(&mut self) -> io::Result<()> {
        self.tables.all().try_for_each(TableFile::flush)
    }

    /// Ends the result: the rest of the rows, the timing, and last the summary. A result that a complete one has replaced is
    /// deleted then.
    ///
    /// # Errors
    /// When something cannot be stored: the summary then goes on saying `incomplete`. When somebody else has changed the rows or
    /// the scene: the summary then says `failed`, and why.
    pub fn finish(mut self, report: &Report) -> Result<(), OutputError> {
        let digests = self.tables.all().map(|table| {
            let digest = table.sync()?;
            Ok::<_, OutputError>((table.name(), Some(digest)))
        });
        let digests: Vec<_> = digests.collect::<Result<_, _>>()?;
        // readers refuse what is no longer what was written
        self.folder.list(digests)?;
        let timing = self.stopwatch.stop(report.t);
        self.folder.replace(TIMING, &json(&timing)?)?;
        let changed = self.refuse_changed();
        let mut report = report.clone();
        if let Err(error) = &changed {
            report.status = Status::Failed;
            report.error.get_or_insert(error.to_string());
        }
        write_summary(&self.folder, &self.header, Ended::new(&report))?;
        if report.status == Status::Complete {
            self.folder.remove(CHECKPOINT)?;
            self.folder.forget()?;
        }
        changed
    }

    /// Refuses rows and a scene that somebody else has changed, moved or deleted.
    fn refuse_changed(&mut self) -> Result<(), OutputError> {
        self.tables
            .all()
            .try_for_each(|table| table.refuse_changed())?;
        let scene = self.folder.path().join(SCENE);
        refuse_changed(&scene, None, self.scene, u64::MAX)
    }
}

fn write_numbers(
    table: &mut TableFile,
    values: &[f64],
    cells: &mut Vec<Cell<'static>>,
) -> io::Result<()> {
    cells.clear();
    cells.extend(values.iter().copied().map(Cell::Number));
    table.row(cells)
}

/// The status in the summary of a run; `None` without a summary.
fn status(folder: &Path) -> Option<String> {
    let summary = folder::read(&folder.join(SUMMARY)).ok()?;
    let summary: serde_json::Value = serde_json::from_slice(&summary).ok()?;
    summary["status"].as_str().map(str::to_owned)
}

fn write_summary(
    folder: &Folder,
    header: &Header,
    report: impl Serialize,
) -> Result<(), OutputError> {
    folder.replace(SUMMARY, &json(&Summary { header, report })?)
}
