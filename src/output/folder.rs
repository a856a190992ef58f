//! A folder for files that belong together: a result that is whole or not there.

use super::earlier::{self, naming};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Why results could not be stored.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder holds a result already.
    #[error("`{}` holds a result already (`{file}`)", folder.display())]
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// A file of the result.
        file: String,
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
    /// Names of the files of a result. The first of them closes it and comes last: without that there is none.
    files: Vec<String>,
    replaces: bool,
}

impl Folder {
    /// Looks at `path` without changing anything; with `replaces` what stands there of `files` may be replaced. The first of
    /// the files closes a result and is written last.
    ///
    /// # Errors
    /// A result that may not be replaced, or a path that is not a folder.
    pub fn new(
        path: &Path,
        files: &[impl AsRef<str>],
        replaces: bool,
    ) -> Result<Folder, OutputError> {
        let folder = Folder {
            path: path.to_owned(),
            files: files.iter().map(|file| file.as_ref().to_owned()).collect(),
            replaces,
        };
        folder.refuse_occupied()?;
        Ok(folder)
    }

    /// Creates the folder and sees that files can be written there, before there is much to lose.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn prepare(&self) -> Result<(), OutputError> {
        self.make()?;
        let probe = self.path.join(".probe.tmp");
        fs::write(&probe, "probe").map_err(|e| naming(&probe, e))?;
        Ok(fs::remove_file(&probe).map_err(|e| naming(&probe, e))?)
    }

    /// Writes a result that is made in one piece: the texts of its files, in their order.
    ///
    /// # Errors
    /// When a file cannot be written, or a result has come in the meantime.
    pub fn write(&self, texts: &[Vec<u8>]) -> Result<(), OutputError> {
        self.refuse_occupied()?;
        if self.replaces {
            self.set_aside(self.path.join(&self.files[0]).exists())?;
        }
        for (name, bytes) in self.files.iter().zip(texts).rev() {
            self.replace(name, bytes)?;
        }
        if self.replaces {
            self.forget()?;
        }
        Ok(())
    }

    /// Where it is.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The names of its files.
    pub(super) fn files(&self) -> &[String] {
        &self.files
    }

    /// True where an earlier result may be replaced.
    pub(super) fn replaces(&self) -> bool {
        self.replaces
    }

    /// Creates the folder.
    pub(super) fn make(&self) -> io::Result<()> {
        fs::create_dir_all(&self.path).map_err(|e| naming(&self.path, e))
    }

    /// Sets the earlier result aside; `whole` where it was complete.
    pub(super) fn set_aside(&self, whole: bool) -> io::Result<()> {
        earlier::set_aside(&self.path, &self.files, whole)
    }

    /// Deletes the earlier result.
    pub(super) fn forget(&self) -> io::Result<()> {
        earlier::forget(&self.path, &self.files)
    }

    /// Puts a whole file in its place at once: a reader sees the old one or the new one, never a part.
    pub(super) fn replace(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        let temporary = self.path.join(format!(".{name}.tmp"));
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
        let path = self.path.join(name);
        Ok(fs::rename(&temporary, &path).map_err(|e| naming(&path, e))?)
    }

    /// Refuses a path that is no folder, a folder with a result unless it may be replaced, and what is no file.
    fn refuse_occupied(&self) -> Result<(), OutputError> {
        let is_there = |path: &Path| fs::symlink_metadata(path).is_ok();
        if is_there(&self.path) && !self.path.is_dir() {
            return Err(OutputError::NotADirectory(self.path.clone()));
        }
        for file in &self.files {
            let path = self.path.join(file);
            if !is_there(&path) {
                continue;
            }
            if !self.replaces {
                return Err(OutputError::Occupied {
                    folder: self.path.clone(),
                    file: file.clone(),
                });
            }
            if !path.is_file() {
                return Err(OutputError::NotAFile(path));
            }
        }
        Ok(())
    }
}

/// A value as the text of a file.
///
/// # Errors
/// A value that JSON does not have.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, OutputError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(io::Error::from)?;
    bytes.push(b'\n');
    Ok(bytes)
}
