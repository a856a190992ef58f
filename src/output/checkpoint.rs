//! The checkpoint of a run on disk: a line of JSON that says what it belongs to, then the bytes from which the run goes on.

use super::folder::{Folder, OutputError};
use super::timing::Elapsed;
use super::{SCENE, SUMMARY};
use crate::checkpoint::Misfit;
use crate::registry::Registry;
use crate::scene::{Scene, SceneError};
use crate::simulate::Simulation;
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

/// What a checkpoint belongs to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Origin {
    version: String,
    /// SHA-256 of the program.
    program: String,
    scene_hash: String,
    overrides: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct CheckpointHeader {
    /// Time reached \[s\].
    t: f64,
    #[serde(flatten)]
    origin: Origin,
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

impl Origin {
    /// That of a run of a scene by this program.
    pub(super) fn of(scene: &Scene) -> io::Result<Origin> {
        Ok(Origin {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            program: sha256(&fs::read(std::env::current_exe()?)?),
            scene_hash: scene.hash(),
            overrides: scene.overrides().map(str::to_owned).collect(),
        })
    }
}

fn sha256(bytes: &[u8]) -> String {
    let digits = Sha256::digest(bytes);
    digits.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes a checkpoint at time `t`; `tables` are the sizes of the tables on disk.
pub(super) fn write(
    folder: &Folder,
    t: f64,
    origin: &Origin,
    tables: BTreeMap<String, u64>,
    elapsed: Elapsed,
    bytes: &[u8],
) -> Result<(), OutputError> {
    let header = CheckpointHeader {
        t,
        origin: origin.clone(),
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
    /// The checkpoint of the run whose result is in `folder`.
    ///
    /// # Errors
    /// [`OutputError::NotResumable`] when there is none, or none that this program can go on from.
    pub fn read(folder: &Path) -> Result<StoredCheckpoint, OutputError> {
        let refuse = |why: String| {
            Err(OutputError::NotResumable {
                folder: folder.to_owned(),
                why,
            })
        };
        match super::status(folder).as_deref() {
            None => return refuse(format!("it has no `{SUMMARY}`, so there is no run")),
            Some("complete") => return refuse("it is complete".to_owned()),
            Some("failed") => return refuse("it could not go on by itself".to_owned()),
            Some(_) => {}
        }
        let file = match fs::read(folder.join(CHECKPOINT)) {
            Ok(file) => file,
            Err(e) if e.kind() == ErrorKind::NotFound => {
                let why = "it was stopped before its first checkpoint, or is a static analysis, which has none; run the scene again with --force";
                return refuse(why.to_owned());
            }
            Err(e) => return refuse(format!("`{CHECKPOINT}` cannot be read: {e}")),
        };
        let mut parts = file.splitn(2, |byte| *byte == b'\n');
        let header = parts
            .next()
            .and_then(|line| serde_json::from_slice(line).ok());
        let header: Option<CheckpointHeader> = header;
        let (Some(header), Some(bytes)) = (header, parts.next()) else {
            return refuse(format!("`{CHECKPOINT}` is damaged"));
        };
        if header.sha256 != sha256(bytes) {
            return refuse(format!("`{CHECKPOINT}` is damaged"));
        }
        Ok(StoredCheckpoint {
            folder: folder.to_owned(),
            bytes: bytes.to_vec(),
            header,
        })
    }

    /// The scene of the run, as it is in the folder.
    ///
    /// # Errors
    /// A scene that cannot be read.
    pub fn scene(&self, registry: &Registry) -> Result<Scene, SceneError> {
        let scene = self.folder.join(SCENE);
        Scene::load_with(registry, &scene, &self.header.origin.overrides)
    }

    /// Refuses a scene and a program that are not those of the run.
    pub(super) fn check(&self, origin: &Origin) -> Result<(), OutputError> {
        let was = &self.header.origin;
        let program = |origin: &Origin| {
            let digits = origin.program.get(..DIGITS).unwrap_or_default();
            format!("looselink {} with SHA-256 {digits}...", origin.version)
        };
        let why = if was.scene_hash != origin.scene_hash {
            let scene = self.folder.join(SCENE);
            format!("`{}` has been changed since it began", scene.display())
        } else if was.program != origin.program {
            let (was, is) = (program(was), program(origin));
            format!("it was begun by another program ({was}; this is {is})")
        } else {
            return Ok(());
        };
        Err(OutputError::NotResumable {
            folder: self.folder.clone(),
            why,
        })
    }

    /// Brings a simulation to where the run was.
    pub(super) fn restore(self, simulation: &mut Simulation) -> Result<(), OutputError> {
        let misfit = |why: Misfit| OutputError::NotResumable {
            folder: self.folder,
            why: why.to_string(),
        };
        simulation.restore(self.bytes).map_err(misfit)
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
