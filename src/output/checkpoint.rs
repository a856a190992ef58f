//! The checkpoint of a run on disk: a line with the SHA-256 of all that follows, a line of JSON that says what it belongs to, then
//! the bytes from which the run goes on.

use super::timing::Elapsed;
use super::{Header, SCENE, SUMMARY};
use crate::registry::Registry;
use crate::scene::{Scene, SceneError};
use crate::simulate::Simulation;
use folder::{Digest, Folder, Kind, OutputError};
use numbers::hexadecimal;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

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
    /// The rows of every table that belong to it; later ones are cut.
    tables: BTreeMap<String, Digest>,
    #[serde(flatten)]
    elapsed: Elapsed,
}

/// A checkpoint that was read, of a run that was interrupted.
#[derive(Debug)]
pub struct StoredCheckpoint {
    /// The folder of the run.
    folder: Folder,
    header: CheckpointHeader,
    bytes: Vec<u8>,
}

/// Why a run of an earlier version is not resumed.
const EARLIER: &str = "`checkpoint.bin` is of an earlier version of the program";
/// Why a run is not resumed that is not known to be the program's.
const UNLISTED: &str = "it has no `manifest.jsonl`, which lists the files of the program";
/// Why a run is not resumed from some bytes.
const DAMAGED: &str = "`checkpoint.bin` is damaged";

fn refused(folder: &Path, why: String) -> OutputError {
    OutputError::NotResumable {
        folder: folder.to_owned(),
        why,
    }
}

/// The file of this program, where it is none of its own but, for example, a library that Python has loaded.
static PROGRAM: OnceLock<PathBuf> = OnceLock::new();

/// Says where the file of this program is, unless that is known already.
pub fn program_is(path: PathBuf) {
    let _ = PROGRAM.set(path);
}

/// SHA-256 of this program. On Linux it can be read after its file has been replaced, by a build for example.
///
/// # Errors
/// When it cannot be read.
pub fn program() -> io::Result<String> {
    static READ: OnceLock<String> = OnceLock::new();
    if let Some(read) = READ.get() {
        return Ok(read.clone());
    }
    let path = match PROGRAM.get() {
        Some(path) => path.clone(),
        None if cfg!(target_os = "linux") => PathBuf::from("/proc/self/exe"),
        None => std::env::current_exe()?,
    };
    let bytes = fs::read(&path).map_err(|e| {
        let message = format!("cannot read the program `{}`: {e}", path.display());
        io::Error::new(e.kind(), message)
    })?;
    Ok(READ.get_or_init(|| sha256(&bytes)).clone())
}

fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// Writes a checkpoint at time `t`; `tables` are the rows on disk.
pub(super) fn write(
    folder: &Folder,
    t: f64,
    run: &Header,
    program: &str,
    tables: BTreeMap<String, Digest>,
    elapsed: Elapsed,
    bytes: &[u8],
) -> Result<(), OutputError> {
    let header = CheckpointHeader {
        t,
        run: run.clone(),
        program: program.to_owned(),
        tables,
        elapsed,
    };
    let mut text = serde_json::to_vec(&header).map_err(io::Error::from)?;
    text.push(b'\n');
    text.extend(bytes);
    let digest = sha256(&text);
    folder.replace(CHECKPOINT, &[digest.as_bytes(), b"\n", &text].concat())
}

impl StoredCheckpoint {
    /// The checkpoint of the run whose result is in a folder, which is locked. `kind` is that of the run.
    ///
    /// # Errors
    /// [`OutputError::NotResumable`] when there is none, or a damaged one; [`OutputError::Busy`] while the run writes there.
    pub fn read(path: &Path, kind: Kind) -> Result<StoredCheckpoint, OutputError> {
        let refused = |why: &str| refused(path, why.to_owned());
        let folder = Folder::reopen(path, kind)?;
        match super::status(path).as_deref() {
            None if path.join(SUMMARY).exists() => {
                return Err(refused("its `summary.json` is damaged"));
            }
            None => return Err(refused("it has no `summary.json`, so there is no run")),
            Some("complete") => return Err(refused("it is complete")),
            Some(_) => {}
        }
        let file = folder::read(&path.join(CHECKPOINT)).map_err(|e| match e.kind() {
            ErrorKind::NotFound => refused(
                "it was stopped before its first checkpoint, or is a static analysis, which has none",
            ),
            _ => refused(&format!("`{CHECKPOINT}` cannot be read: {e}")),
        })?;
        let (header, bytes) = parsed(&file).map_err(refused)?;
        let folder = folder.ok_or_else(|| refused(UNLISTED))?;
        Ok(StoredCheckpoint {
            folder,
            header,
            bytes,
        })
    }

    /// True where a run can be resumed, as far as its checkpoint says.
    pub fn is_in(path: &Path) -> bool {
        let checkpoint = folder::read(&path.join(CHECKPOINT));
        super::status(path).is_some_and(|status| status != "complete")
            && checkpoint.is_ok_and(|file| parsed(&file).is_ok())
    }

    /// The folder of the run.
    pub(super) fn folder(&self) -> &Folder {
        &self.folder
    }

    /// The folder of the run, to write to.
    pub(super) fn into_folder(self) -> Folder {
        self.folder
    }

    /// The error of a run that cannot be resumed.
    pub(super) fn refused(&self, why: String) -> OutputError {
        refused(self.folder.path(), why)
    }

    /// The scene of the run, as it is in the folder.
    ///
    /// # Errors
    /// A scene that cannot be read.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, SceneError> {
        let scene = self.folder.path().join(SCENE);
        // the file may have been replaced by any other
        let scene = Scene::load_with(registry, &scene, &self.header.run.overrides);
        scene.map_err(SceneError::without_contents)
    }

    /// Refuses a scene and a program that are not those of the run.
    pub(super) fn check(&self, run: &Header, program: &str) -> Result<(), OutputError> {
        let was = &self.header;
        let named = |version: &str, program: &str| {
            let digits = program.get(..DIGITS).unwrap_or_default();
            format!("looselink {version} with SHA-256 {digits}...")
        };
        let why = if was.run.scene_hash != run.scene_hash {
            let scene = self.folder.path().join(SCENE);
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

    /// Time reached \[s\].
    pub fn t(&self) -> f64 {
        self.header.t
    }

    /// Time that the run has taken.
    pub(super) fn elapsed(&self) -> Elapsed {
        self.header.elapsed
    }

    /// The rows of a table that belong to the checkpoint.
    pub(super) fn rows(&self, table: &str) -> Digest {
        let rows = self.header.tables.get(table);
        // a table that it does not know of has lost its rows
        rows.copied().unwrap_or(Digest {
            bytes: u64::MAX,
            crc32: 0,
        })
    }
}

/// What a checkpoint belongs to, and the bytes from which its run is continued.
fn parsed(file: &[u8]) -> Result<(CheckpointHeader, Vec<u8>), &'static str> {
    // one of an earlier version begins with what it belongs to
    if file.starts_with(b"{") {
        return Err(EARLIER);
    }
    let lines = file.splitn(3, |byte| *byte == b'\n');
    let [digest, line, bytes] = lines.collect::<Vec<_>>()[..] else {
        return Err(DAMAGED);
    };
    let followed = &file[digest.len() + 1..];
    let header: CheckpointHeader = serde_json::from_slice(line).map_err(|_| DAMAGED)?;
    match sha256(followed).as_bytes() == digest {
        true => Ok((header, bytes.to_vec())),
        false => Err(DAMAGED),
    }
}
