//! The folder of a result: who writes to it, which of its files are the program's, and files that are whole or not there.
//!
//! `manifest.jsonl` lists the files of the program, and is locked by a program that writes to the folder. The lock is taken
//! before anything is looked at. A file that the manifest does not list is somebody else's: it is never replaced, extended or
//! deleted. A claim that is refused leaves the folder as it was.
//!
//! A file that is written in one piece is a temporary file with a name of its own until it is on the disk, then takes its place at
//! once. What a killed program leaves of it, the next one removes.
//!
//! An earlier result is linked, all of its files or none, into the folder `previous-result` before it is taken out of its place,
//! and deleted when the new one is whole. Whatever ends the program, one of the two places holds a whole result.

mod add;
mod claim;
mod digest;
mod error;
mod kind;
mod line;
mod lock;
mod manifest;
mod replaced;
mod temporary;

pub use add::{add, add_to};
pub use claim::{Folder, earlier_result, refuse_changed, refuse_moved};
pub use digest::{Digest, Digesting};
use error::failed;
pub use error::{OutputError, naming, naming_read};
pub use kind::Kind;
pub use line::{line_of, value_of};
pub use manifest::{MANIFEST, held, lists, verify};
pub use temporary::replace;

use serde::Serialize;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;

/// A value as the text of a file.
///
/// # Errors
/// A value that JSON does not have.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, OutputError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(io::Error::from)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Reads a whole file. A pipe or a device in its place is refused: it might never end.
///
/// # Errors
/// When it cannot be read.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    match fs::metadata(path)?.is_file() {
        true => fs::read(path),
        false => Err(no_file()),
    }
}

fn a_link() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, "it is a link")
}

fn no_file() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, "it is not a file")
}

/// Opens a file to read it, but not what a link points at.
///
/// # Errors
/// When it cannot be opened; the message names the file.
pub fn open_to_read(path: &Path) -> io::Result<File> {
    open_unlinked("read", path, OpenOptions::new().read(true))
}

/// Opens a file to write to it, but not what a link points at, nor a file that has a second name: whoever gave it that does not expect
/// it to change.
///
/// # Errors
/// When it cannot be opened; the message names the file.
pub fn open(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    let file = open_unlinked("write", path, options)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let names = file.metadata().map_err(naming(path))?.nlink();
        if names > 1 {
            let message = "it has a second name (a hard link), whose content would change too; \
                           copy the folder, or its files, instead";
            return Err(naming(path)(io::Error::new(
                io::ErrorKind::InvalidInput,
                message,
            )));
        }
    }
    Ok(file)
}

fn open_unlinked(verb: &str, path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file() && !found.is_symlink()) {
        return Err(failed(verb, path, &no_file()));
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(libc::O_NOFOLLOW);
    }
    if cfg!(not(unix)) && path.is_symlink() {
        return Err(failed(verb, path, &a_link()));
    }
    options.open(path).map_err(|error| {
        let error = match path.is_symlink() {
            true => a_link(),
            false => error,
        };
        failed(verb, path, &error)
    })
}
