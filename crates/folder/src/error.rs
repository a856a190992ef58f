//! Why results could not be stored.

use std::io;
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
    /// The folder holds something else of the program.
    #[error("`{}` holds {held} already", folder.display())]
    OfAnotherKind {
        /// The folder.
        folder: PathBuf,
        /// What it holds: see [`crate::Kind`].
        held: String,
    },
    /// A file has the name of one of the result, and is somebody else's.
    #[error("`{}` is not a file of this program; move it, or choose another folder", .0.display())]
    Foreign(PathBuf),
    /// The file of the manifest is somebody else's, or its first line is lost.
    #[error(
        "`{}` is not a file of this program, or its first line is damaged; move it, or choose another folder",
        .0.display()
    )]
    NoManifest(PathBuf),
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
    /// Another program writes to the folder.
    #[error("another looselink is writing to `{}`", .0.display())]
    Busy(PathBuf),
    /// A file is not as the program left it.
    #[error("`{}` {how}", path.display())]
    Changed {
        /// The file.
        path: PathBuf,
        /// What has become of it.
        how: String,
    },
    /// The system refused; the message names the file.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// Makes an error of the system say which file could not be written.
pub fn naming(path: &Path) -> impl FnOnce(io::Error) -> io::Error {
    move |error| failed("write", path, &error)
}

/// Makes an error of the system say which file could not be read.
pub fn naming_read(path: &Path) -> impl FnOnce(io::Error) -> io::Error {
    move |error| failed("read", path, &error)
}

pub(crate) fn failed(verb: &str, path: &Path, error: &io::Error) -> io::Error {
    let message = format!("cannot {verb} `{}`: {error}", path.display());
    io::Error::new(error.kind(), message)
}
