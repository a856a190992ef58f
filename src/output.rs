//! A run on disk: channels and onsets as they come, and what describes them.
//!
//! | file | content |
//! |---|---|
//! | `channels.csv` | one row an output interval, `name [unit]` above each column |
//! | `onsets.csv` | one row a contact, when it opens; last those that are closed at the end, without end and exit velocity |
//! | `scene.toml` | the scene as it was read; overrides are in the summary |
//! | `summary.json` | status, counters, energy ledger, extremes, warnings |
//! | `timing.json` | wall and processor time, machine, date |
//!
//! Only `timing.json` differs when a run is repeated. `summary.json` says `incomplete` from the first rows to the last, so
//! that a run that was killed is not taken for a finished one; without a summary there is no result. A kill or a full disk
//! may cut the last row: a row is whole when it ends with a line feed.
//!
//! A result that is replaced stands in `previous-result` inside the folder until the new one is complete.

mod csv;
mod earlier;
mod timing;

use crate::scene::Scene;
use crate::simulate::{Channel, Contact, Report, Status};
use csv::CsvFile;
pub use earlier::earlier_result;
use serde::Serialize;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use timing::Stopwatch;
pub(crate) use timing::machine;

const CHANNELS: &str = "channels.csv";
const ONSETS: &str = "onsets.csv";
const SCENE: &str = "scene.toml";
const SUMMARY: &str = "summary.json";
pub(crate) const TIMING: &str = "timing.json";
/// The columns of `onsets.csv`.
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
/// The summary first, which closes a result.
const FILES: [&str; 5] = [SUMMARY, CHANNELS, ONSETS, SCENE, TIMING];

/// Why results could not be stored.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder holds a result already.
    #[error("`{}` holds a result already (`{file}`)", folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// A file of the result.
        file: &'static str,
    },
    /// The path of the folder is that of a file.
    #[error("`{}` is not a directory", .0.display())]
    NotADirectory(PathBuf),
    /// What stands in the place of a file of the result is none.
    #[error("`{}` is not a file", .0.display())]
    NotAFile(PathBuf),
    /// Another run writes to the folder.
    #[error("another run is writing to `{}`", .0.display())]
    Busy(PathBuf),
    /// The system refused; the message names the file.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// A folder that may receive a result.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    replace: bool,
}

/// A result being written.
#[derive(Debug)]
pub struct Results {
    folder: PathBuf,
    replaces: bool,
    header: Header,
    channels: CsvFile,
    onsets: CsvFile,
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
struct Pending {
    status: Status,
}

#[derive(Serialize)]
struct Ended<'a> {
    #[serde(flatten)]
    report: &'a Report,
    warnings: Vec<String>,
}

impl Folder {
    /// Looks at `path` without changing anything; with `replace` a result that stands there may be replaced.
    ///
    /// # Errors
    /// A result that may not be replaced, or a path that is not a folder.
    pub fn new(path: &Path, replace: bool) -> Result<Folder, OutputError> {
        refuse_occupied(path, &FILES, replace)?;
        Ok(Folder {
            path: path.to_owned(),
            replace,
        })
    }

    /// Starts a result; files that are not part of one are left alone.
    ///
    /// # Errors
    /// When the folder or a file cannot be written, or another run writes to it.
    pub fn begin(self, scene: &Scene, channels: &[Channel]) -> Result<Results, OutputError> {
        let folder = self.path;
        fs::create_dir_all(&folder).map_err(|e| naming(&folder, e))?;
        if self.replace {
            refuse_busy(&folder)?;
            earlier::set_aside(&folder, &FILES, is_complete(&folder))?;
        }
        let header = Header {
            title: scene.title.clone(),
            scene_hash: scene.hash(),
            overrides: scene.overrides().map(str::to_owned).collect(),
            version: env!("CARGO_PKG_VERSION"),
        };
        let names = channels.iter().map(|c| format!("{} [{}]", c.name, c.unit));
        // First of all and never over another: of two runs that start together one fails.
        let channels =
            CsvFile::create(folder.join(CHANNELS), names).map_err(|e| match e.kind() {
                io::ErrorKind::AlreadyExists => OutputError::Occupied {
                    folder: folder.clone(),
                    file: CHANNELS,
                },
                _ => e.into(),
            })?;
        let status = Status::Incomplete;
        write_summary(&folder, &header, Pending { status })?;
        replace(&folder, SCENE, scene.text().as_bytes())?;
        Ok(Results {
            header,
            replaces: self.replace,
            channels,
            onsets: CsvFile::create(folder.join(ONSETS), CONTACT.map(str::to_owned))?,
            folder,
            stopwatch: Stopwatch::start(),
        })
    }
}

impl Results {
    /// Appends a row of channels.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        values.iter().for_each(|value| self.channels.number(*value));
        self.channels.end_row()
    }

    /// Appends a contact; what a contact without an end does not have stays empty.
    ///
    /// # Errors
    /// When it cannot be stored; the message names the file.
    pub fn contact(&mut self, contact: &Contact) -> io::Result<()> {
        let Contact {
            onset,
            deepest_penetration,
            end,
        } = contact;
        self.onsets.number(onset.t);
        self.onsets.text(onset.joint);
        self.onsets.number(onset.impact_velocity);
        self.onsets.number(onset.delta);
        self.onsets.number(onset.angle);
        self.onsets.number(*deepest_penetration);
        match end {
            Some(end) => {
                self.onsets.number(end.t);
                self.onsets.number(end.exit_velocity);
            }
            None => (0..2).for_each(|_| self.onsets.text("")),
        }
        self.onsets.end_row()
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
        replace(&self.folder, TIMING, &json(&timing)?)?;
        let warnings = report.warnings();
        write_summary(&self.folder, &self.header, Ended { report, warnings })?;
        if self.replaces && report.status == Status::Complete {
            earlier::forget(&self.folder, &FILES)?;
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
fn refuse_busy(folder: &Path) -> Result<(), OutputError> {
    let locked = File::open(folder.join(CHANNELS)).map(|file| file.try_lock());
    match locked {
        Ok(Err(TryLockError::WouldBlock)) => Err(OutputError::Busy(folder.to_owned())),
        _ => Ok(()),
    }
}

/// Refuses a path that is no folder, a folder with one of `files` unless they may be replaced, and what is no file.
pub(crate) fn refuse_occupied(
    path: &Path,
    files: &[&'static str],
    replace: bool,
) -> Result<(), OutputError> {
    let is_there = |path: &Path| fs::symlink_metadata(path).is_ok();
    if is_there(path) && !path.is_dir() {
        return Err(OutputError::NotADirectory(path.to_owned()));
    }
    for file in files.iter().filter(|file| is_there(&path.join(file))) {
        if !replace {
            return Err(OutputError::Occupied {
                folder: path.to_owned(),
                file,
            });
        }
        if !path.join(file).is_file() {
            return Err(OutputError::NotAFile(path.join(file)));
        }
    }
    Ok(())
}

/// Creates a folder and sees that files can be written there, before there is much to lose.
pub(crate) fn prepare(folder: &Path) -> Result<(), OutputError> {
    let probe = folder.join(".probe.tmp");
    fs::create_dir_all(folder).map_err(|e| naming(folder, e))?;
    fs::write(&probe, "probe").map_err(|e| naming(&probe, e))?;
    Ok(fs::remove_file(&probe).map_err(|e| naming(&probe, e))?)
}

/// Writes a result that is made in one piece. The first of the files closes it and comes last: without that there is none.
pub(crate) fn write_result(
    folder: &Path,
    files: &[(&'static str, Vec<u8>)],
    replaces: bool,
) -> Result<(), OutputError> {
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    // what was not there when the work began may have come meanwhile
    refuse_occupied(folder, &names, replaces)?;
    if replaces {
        earlier::set_aside(folder, &names, folder.join(names[0]).exists())?;
    }
    for (name, bytes) in files.iter().rev() {
        replace(folder, name, bytes)?;
    }
    if replaces {
        earlier::forget(folder, &names)?;
    }
    Ok(())
}

fn write_summary(
    folder: &Path,
    header: &Header,
    report: impl Serialize,
) -> Result<(), OutputError> {
    replace(folder, SUMMARY, &json(&Summary { header, report })?)
}

/// A value as the text of a file.
pub(crate) fn json(value: &impl Serialize) -> Result<Vec<u8>, OutputError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(io::Error::from)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Puts a whole file in its place at once: a reader sees the old one or the new one, never a part.
pub(crate) fn replace(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
    let temporary = folder.join(format!(".{name}.tmp"));
    let write = || -> io::Result<()> {
        let mut file = File::create(&temporary)?;
        file.write_all(bytes)?;
        // On disk before the name points at it.
        file.sync_all()
    };
    write().map_err(|e| {
        // What is left of it is of no use, and the first error is the one to report.
        let _ = fs::remove_file(&temporary);
        naming(&temporary, e)
    })?;
    let path = folder.join(name);
    Ok(fs::rename(&temporary, &path).map_err(|e| naming(&path, e))?)
}

/// An error of the system that says which file it is about.
pub(crate) fn naming(path: &Path, error: io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("cannot write `{}`: {error}", path.display()),
    )
}
