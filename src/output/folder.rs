//! A folder for files that belong together: a result that is whole or not there.
//!
//! An earlier result is linked, all of its files or none, into the folder `previous-result` before it is taken out of its place,
//! and deleted when the new one is whole. Whatever ends the program, one of the two places holds a whole result.

use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

const PREVIOUS: &str = "previous-result";
const TEMPORARY: &str = ".previous-result.tmp";

/// Where the earlier result of `folder` stands aside, if it does.
pub fn earlier_result(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(PREVIOUS)).filter(|aside| aside.exists())
}

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
    /// A run that cannot be resumed.
    #[error("cannot resume the run in `{}`: {why}", folder.display())]
    NotResumable {
        /// The folder.
        folder: PathBuf,
        /// Why not.
        why: String,
    },
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
    /// Where it is.
    pub(super) path: PathBuf,
    /// Names of the files of a result. The first of them closes it and comes last: without that there is none.
    pub(super) files: Vec<String>,
    /// True where an earlier result may be replaced.
    pub(super) replaces: bool,
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
        fs::write(&probe, "probe").map_err(naming(&probe))?;
        Ok(fs::remove_file(&probe).map_err(naming(&probe))?)
    }

    /// Writes a result that is made in one piece: the texts of its files, in their order. The last files may be missing from it.
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

    /// Creates the folder.
    pub(super) fn make(&self) -> io::Result<()> {
        fs::create_dir_all(&self.path).map_err(naming(&self.path))
    }

    /// Sets the earlier result aside. What stands aside already gives way to a `whole` result only: a run that was killed does
    /// not push out the result that it was to replace.
    pub(super) fn set_aside(&self, whole: bool) -> io::Result<()> {
        let [aside, temporary] = [PREVIOUS, TEMPORARY].map(|name| self.path.join(name));
        let is_there = |file: &&String| self.path.join(file).exists();
        let present: Vec<_> = self.files.iter().filter(is_there).collect();
        if !present.is_empty() && (whole || !aside.exists()) {
            self.discard(&temporary)?;
            fs::create_dir(&temporary).map_err(naming(&temporary))?;
            for file in present {
                link(&self.path.join(file), &temporary.join(file))?;
            }
            self.discard(&aside)?;
            fs::rename(&temporary, &aside).map_err(naming(&aside))?;
        }
        let mut files = self.files.iter();
        files.try_for_each(|file| remove(&self.path.join(file)))
    }

    /// Deletes what was set aside.
    pub(super) fn forget(&self) -> io::Result<()> {
        self.discard(&self.path.join(PREVIOUS))
    }

    /// Deletes a file, and what an interrupted [`replace`] has left of it.
    pub(super) fn remove(&self, name: &str) -> io::Result<()> {
        let path = self.path.join(name);
        remove(&temporary(&path))?;
        remove(&path)
    }

    fn discard(&self, aside: &Path) -> io::Result<()> {
        if !aside.exists() {
            return Ok(());
        }
        let mut files = self.files.iter();
        files.try_for_each(|file| remove(&aside.join(file)))?;
        fs::remove_dir(aside).map_err(naming(aside))
    }

    /// See [`replace`].
    pub(super) fn replace(&self, name: &str, bytes: &[u8]) -> Result<(), OutputError> {
        replace(&self.path.join(name), bytes)
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

/// Puts a whole file in its place at once: a reader sees the old one or the new one, never a part.
///
/// # Errors
/// When it cannot be written; the message names the file.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let temporary = temporary(path);
    let write = || -> io::Result<()> {
        let mut file = File::create(&temporary)?;
        file.write_all(bytes)?;
        // On disk before the name points at it.
        file.sync_all()
    };
    let written = write().map_err(naming(&temporary));
    let placed = written.and_then(|()| fs::rename(&temporary, path).map_err(naming(path)));
    Ok(placed.inspect_err(|_| {
        // What is left of it is of no use, and the first error is the one to report.
        let _ = fs::remove_file(&temporary);
    })?)
}

/// Where a file is written before it takes its place.
fn temporary(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().display();
    path.with_file_name(format!(".{name}.tmp"))
}

/// A second name for a file or, where there are none, a copy; of a link what it points at, which may be relative.
fn link(from: &Path, to: &Path) -> io::Result<()> {
    let linked = match fs::symlink_metadata(from) {
        Ok(file) if file.is_file() => fs::hard_link(from, to),
        _ => Err(ErrorKind::Unsupported.into()),
    };
    let copied = linked.or_else(|_| fs::copy(from, to).map(drop));
    copied.map_err(naming(to))
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(naming(path)(e)),
        _ => Ok(()),
    }
}

/// Makes an error of the system say which file it is about.
pub fn naming(path: &Path) -> impl FnOnce(io::Error) -> io::Error {
    move |error| {
        let message = format!("cannot write `{}`: {error}", path.display());
        io::Error::new(error.kind(), message)
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
