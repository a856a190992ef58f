//! The checkpoint of a run on disk: a line of JSON that says what it belongs to, then the bytes from which the run goes on.

use super::folder::{Folder, OutputError};
use super::timing::Elapsed;
use super::{Header, SCENE};
use crate::registry::Registry;
use crate::scene::{Scene, SceneError};
use crate::simulate::Simulation;
use numbers::hexadecimal;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Its file, which a complete result does not have.
pub(super) const CHECKPOINT: &str = "checkpoint.bin";
/// Digits of a program's SHA-256 in a message.
const DIGITS: usize = 12;

#[derive(Debug, Serialize, Deserialize)]
struct CheckpointHeader {
    /// Time reached \[s\].
    t: f64,
    #[serde(flatten)]
    run: Header,
    /// SHA-256 of the program.
    program: String,
    /// True where the run may replace an earlier result.
    replaces: bool,
    /// Bytes of every table that belong to it; later ones are cut.
    tables: BTreeMap<String, u64>,
    #[serde(flatten)]
    elapsed: Elapsed,
    /// SHA-256 of the bytes after this line.
    sha256: String,
}

/// A checkpoint that was read, of a run that was interrupted.
#[derive(Debug)]
pub struct StoredCheckpoint {
    /// The folder of the run.
    folder: PathBuf,
    header: CheckpointHeader,
    bytes: Vec<u8>,
}

/// Why a run is not resumed that needs it no longer.
const COMPLETE: &str = "it is complete";

fn refused(folder: &Path, why: String) -> OutputError {
    OutputError::NotResumable {
        folder: folder.to_owned(),
        why,
    }
}

/// SHA-256 of this program. On Linux it can be read after its file has been replaced, by a build for example.
pub(super) fn program() -> io::Result<String> {
    let path = match cfg!(target_os = "linux") {
        true => PathBuf::from("/proc/self/exe"),
        false => std::env::current_exe()?,
    };
    let bytes = fs::read(&path).map_err(|e| {
        let message = format!("cannot read the program `{}`: {e}", path.display());
        io::Error::new(e.kind(), message)
    })?;
    Ok(sha256(&bytes))
}

fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Writes a checkpoint at time `t`; `tables` are the sizes of the tables on disk.
pub(super) fn write(
    folder: &Folder,
    t: f64,
    run: &Header,
    program: &str,
    tables: BTreeMap<String, u64>,
    elapsed: Elapsed,
    bytes: &[u8],
) -> Result<(), OutputError> {
    let header = CheckpointHeader {
        t,
        run: run.clone(),
        program: program.to_owned(),
        replaces: folder.replaces,
        tables,
        elapsed,
        sha256: sha256(bytes),
    };
    let mut text = serde_json::to_vec(&header).map_err(io::Error::from)?;
    text.push(b'\n');
    text.extend(bytes);
    folder.replace(CHECKPOINT, &text)
}

impl StoredCheckpoint {
    /// The checkpoint of the run whose result is in a folder.
    ///
    /// # Errors
    /// [`OutputError::NotResumable`] when there is none, or a damaged one; [`OutputError::Busy`] while the run writes there.
    pub fn read(folder: &Folder) -> Result<StoredCheckpoint, OutputError> {
        let refused = |why: &str| refused(&folder.path, why.to_owned());
        match super::status(&folder.path).as_deref() {
            None => return Err(refused("it has no `summary.json`, so there is no run")),
            Some("complete") => return Err(refused(COMPLETE)),
            Some(_) => super::refuse_busy(folder)?,
        }
        let file = fs::read(folder.path.join(CHECKPOINT)).map_err(|e| match e.kind() {
            ErrorKind::NotFound => refused(
                "it was stopped before its first checkpoint, or is a static analysis, which has none; run the scene again with --force",
            ),
            _ => refused(&format!("`{CHECKPOINT}` cannot be read: {e}")),
        })?;
        let damaged = || refused(&format!("`{CHECKPOINT}` is damaged"));
        let end = file.iter().position(|byte| *byte == b'\n');
        let (line, bytes) = file.split_at(end.ok_or_else(damaged)?);
        let header: CheckpointHeader = serde_json::from_slice(line).map_err(|_| damaged())?;
        let bytes = bytes[1..].to_vec();
        match header.sha256 == sha256(&bytes) {
            true => Ok(StoredCheckpoint {
                folder: folder.path.clone(),
                header,
                bytes,
            }),
            false => Err(damaged()),
        }
    }

    /// Refuses a run that has come to its end since.
    pub(super) fn still_stands(&self) -> Result<(), OutputError> {
        match super::status(&self.folder).as_deref() {
            Some("complete") => Err(self.refused(COMPLETE.to_owned())),
            _ => Ok(()),
        }
    }

    /// The error of a run that cannot be resumed.
    pub(super) fn refused(&self, why: String) -> OutputError {
        refused(&self.folder, why)
    }

    /// The scene of the run, as it is in the folder.
    ///
    /// # Errors
    /// A scene that cannot be read.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, SceneError> {
        let scene = self.folder.join(SCENE);
        Scene::load_with(registry, &scene, &self.header.run.overrides)
    }

    /// Refuses a scene and a program that are not those of the run.
    pub(super) fn check(&self, run: &Header, program: &str) -> Result<(), OutputError> {
        let was = &self.header;
        let named = |version: &str, program: &str| {
            let digits = program.get(..DIGITS).unwrap_or_default();
            format!("looselink {version} with SHA-256 {digits}...")
        };
        let why = if was.run.scene_hash != run.scene_hash {
            let scene = self.folder.join(SCENE);
            format!("`{}` has been changed since it began", scene.display())
        } else if was.program != program {
            let (was, is) = (
                named(&was.run.version, &was.program),
                named(&run.version, program),
            );
            format!("it was begun by another program ({was}; this is {is})")
        } else {
            return Ok(());
        };
        Err(self.refused(why))
    }

    /// Brings a simulation to where the run was.
    pub(super) fn restore(&self, simulation: &mut Simulation) -> Result<(), OutputError> {
        let restored = simulation.restore(self.bytes.clone());
        restored.map_err(|misfit| self.refused(misfit.to_string()))
    }

    /// True where the run may replace an earlier result.
    pub(super) fn replaces(&self) -> bool {
        self.header.replaces
    }

    /// Time reached \[s\].
    pub fn t(&self) -> f64 {
        self.header.t
    }

    /// Time that the run has taken.
    pub(super) fn elapsed(&self) -> Elapsed {
        self.header.elapsed
    }

    /// Bytes of a table that belong to the checkpoint.
    pub(super) fn size(&self, table: &str) -> u64 {
        let size = self.header.tables.get(table);
        // a table that it does not know of has lost its rows
        size.copied().unwrap_or(u64::MAX)
    }
}
