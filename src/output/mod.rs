//! A run on disk: channels and onsets as they come, and what describes them.
//!
//! | file | content |
//! |---|---|
//! | `channels.*` | one row an output interval, `name [unit]` above each column |
//! | `onsets.*` | one row a contact, when it opens; last those that are closed at the end, without end and exit velocity |
//! | `scene.toml` | the scene as it was read; overrides are in the summary |
//! | `summary.json` | status, counters, energy ledger, extremes, warnings |
//! | `timing.json` | wall and processor time, machine, date |
//!
//! Only `timing.json` differs when a run is repeated. `summary.json` says `incomplete` from the first rows to the last, so
//! that a run that was killed is not taken for a finished one; without a summary there is no result. A kill or a full disk
//! may cut the last row: a row is whole when it ends with a line feed.
//!
//! A result that is replaced stands in `previous-result` inside the folder until the new one is complete.

mod folder;
mod table_file;
mod timing;

use crate::scene::Scene;
use crate::simulate::{Channel, ContactEvent, Report, Status};
use crate::table::{Cell, Format};
pub use folder::{Folder, OutputError, earlier_result, json};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::Path;
use table_file::TableFile;
use timing::Stopwatch;
pub use timing::machine;

const CHANNELS: &str = "channels";
const ONSETS: &str = "onsets";
const SCENE: &str = "scene.toml";
const SUMMARY: &str = "summary.json";
/// The file of what differs when a run is repeated.
pub const TIMING: &str = "timing.json";
/// The columns of the table of onsets.
const CONTACT: [&str; 8] = [
    "t [s]",
    "joint",
    "impact_velocity [m/s]",
    "delta [m]",
    "angle [rad]",
    "deepest_penetration [m]",
    "end [s]",
    "exit_velocity [m/s]",
];

/// The files that a result can have, with tables in any of some formats; first the summary, which closes it.
pub fn files(formats: &[&'static Format]) -> Vec<String> {
    let tables = [CHANNELS, ONSETS].into_iter();
    let tables = tables.flat_map(|table| formats.iter().map(move |format| format.file(table)));
    let others = [SCENE, TIMING].map(str::to_owned);
    let summary = std::iter::once(SUMMARY.to_owned());
    summary.chain(tables).chain(others).collect()
}

/// A result being written.
#[derive(Debug)]
pub struct Results {
    folder: Folder,
    header: Header,
    channels: TableFile,
    onsets: TableFile,
    /// A row of channels.
    cells: Vec<Cell<'static>>,
    stopwatch: Stopwatch,
}

/// What is known of a run before it starts.
#[derive(Debug, Serialize)]
struct Header {
    title: String,
    scene_hash: String,
    overrides: Vec<String>,
    version: &'static str,
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
}

impl Results {
    /// Starts a result; files that are not part of one are left alone.
    ///
    /// # Errors
    /// When the folder or a file cannot be written, or another run writes to it.
    pub fn begin(
        folder: Folder,
        scene: &Scene,
        channels: &[Channel],
    ) -> Result<Results, OutputError> {
        folder.make()?;
        if folder.replaces {
            refuse_busy(&folder)?;
            folder.set_aside(is_complete(&folder.path))?;
        }
        let header = Header {
            title: scene.title.clone(),
            scene_hash: scene.hash(),
            overrides: scene.overrides().map(str::to_owned).collect(),
            version: env!("CARGO_PKG_VERSION"),
        };
        let names = channels.iter().map(|c| format!("{} [{}]", c.name, c.unit));
        // First of all and never over another: of two runs that start together one fails.
        let format = scene.output.format;
        let table = |name| folder.path.join(format.file(name));
        let channels = TableFile::create(table(CHANNELS), format, names);
        let channels = channels.map_err(|e| match e.kind() {
            io::ErrorKind::AlreadyExists => OutputError::Occupied {
                folder: folder.path.clone(),
                file: format.file(CHANNELS),
            },
            _ => e.into(),
        })?;
        let pending = BTreeMap::from([("status", Status::Incomplete)]);
        write_summary(&folder, &header, pending)?;
        folder.replace(SCENE, scene.text().as_bytes())?;
        let onsets = TableFile::create(table(ONSETS), format, CONTACT.map(str::to_owned))?;
        Ok(Results {
            folder,
            header,
            channels,
            onsets,
            cells: Vec::new(),
            stopwatch: Stopwatch::start(),
        })
    }

    /// Appends a row of channels.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.cells.clear();
        self.cells.extend(values.iter().copied().map(Cell::Number));
        self.channels.row(&self.cells)
    }

    /// Appends a contact; what a contact without an end does not have stays empty.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        let ContactEvent {
            onset,
            deepest_penetration,
            end,
        } = contact;
        let [t, exit_velocity] = match end {
            Some(end) => [end.t, end.exit_velocity].map(Cell::Number),
            None => [Cell::Empty; 2],
        };
        self.onsets.row(&[
            Cell::Number(onset.t),
            Cell::Word(onset.joint),
            Cell::Number(onset.impact_velocity),
            Cell::Number(onset.delta),
            Cell::Number(onset.angle),
            Cell::Number(*deepest_penetration),
            t,
            exit_velocity,
        ])
    }

    /// Hands everything so far to the system, for readers of a running simulation.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn flush(&mut self) -> io::Result<()> {
        self.channels.flush()?;
        self.onsets.flush()
    }

    /// Ends the result: the rest of the rows, the timing, and last the summary. A result that a complete one has replaced is
    /// deleted then.
    ///
    /// # Errors
    /// When something cannot be stored; the summary then goes on saying `incomplete`.
    pub fn finish(mut self, report: &Report) -> Result<(), OutputError> {
        self.channels.close()?;
        self.onsets.close()?;
        let timing = self.stopwatch.stop(report.t);
        self.folder.replace(TIMING, &json(&timing)?)?;
        let warnings = report.warnings();
        write_summary(&self.folder, &self.header, Ended { report, warnings })?;
        if self.folder.replaces && report.status == Status::Complete {
            self.folder.forget()?;
        }
        Ok(())
    }
}

/// True where a run has reached its end.
fn is_complete(folder: &Path) -> bool {
    let summary = fs::read(folder.join(SUMMARY)).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    summary["status"] == "complete"
}

/// Refuses a folder to which a run writes: it holds its channels locked.
fn refuse_busy(folder: &Folder) -> Result<(), OutputError> {
    let mut files = folder.files.iter();
    let busy = files.any(|name| {
        let locked = || File::open(folder.path.join(name)).map(|file| file.try_lock());
        name.starts_with(CHANNELS) && matches!(locked(), Ok(Err(TryLockError::WouldBlock)))
    });
    match busy {
        true => Err(OutputError::Busy(folder.path.clone())),
        false => Ok(()),
    }
}

fn write_summary(
    folder: &Folder,
    header: &Header,
    report: impl Serialize,
) -> Result<(), OutputError> {
    folder.replace(SUMMARY, &json(&Summary { header, report })?)
}
