//! The earlier result of a folder while another one replaces it.
//!
//! It is linked, all of its files or none, into the folder `previous-result` before it is taken out of its place, and
//! deleted when the new one is whole. Whatever ends the program, one of the two places holds a whole result.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

const PREVIOUS: &str = "previous-result";
const TEMPORARY: &str = ".previous-result.tmp";

/// Where the earlier result of `folder` stands aside, if it does.
pub fn earlier_result(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(PREVIOUS)).filter(|aside| aside.exists())
}

/// Sets `files` of `folder` aside, of which the first closes a result. What stands aside already gives way to a `whole`
/// result only: a run that was killed does not push out the result that it was to replace.
pub(super) fn set_aside(folder: &Path, files: &[String], whole: bool) -> io::Result<()> {
    let [aside, temporary] = [PREVIOUS, TEMPORARY].map(|name| folder.join(name));
    let present = || {
        let is_there = |file: &&String| folder.join(file).exists();
        files.iter().filter(is_there)
    };
    if present().next().is_some() && (whole || !aside.exists()) {
        discard(&temporary, files)?;
        fs::create_dir(&temporary).map_err(|e| naming(&temporary, e))?;
        for file in present() {
            link(&folder.join(file), &temporary.join(file))?;
        }
        discard(&aside, files)?;
        fs::rename(&temporary, &aside).map_err(|e| naming(&aside, e))?;
    }
    files.iter().try_for_each(|file| remove(&folder.join(file)))
}

/// Deletes what was set aside.
pub(super) fn forget(folder: &Path, files: &[String]) -> io::Result<()> {
    discard(&folder.join(PREVIOUS), files)
}

fn discard(aside: &Path, files: &[String]) -> io::Result<()> {
    if !aside.exists() {
        return Ok(());
    }
    for file in files {
        remove(&aside.join(file))?;
    }
    fs::remove_dir(aside).map_err(|e| naming(aside, e))
}

/// A second name for a file or, where there are none, a copy; of a link what it points at, which may be relative.
fn link(from: &Path, to: &Path) -> io::Result<()> {
    let linked = match fs::symlink_metadata(from) {
        Ok(file) if file.is_file() => fs::hard_link(from, to),
        _ => Err(ErrorKind::Unsupported.into()),
    };
    linked
        .or_else(|_| fs::copy(from, to).map(drop))
        .map_err(|e| naming(to, e))
}

fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(naming(path, e)),
        _ => Ok(()),
    }
}

/// An error of the system that says which file it is about.
pub(super) fn naming(path: &Path, error: io::Error) -> io::Error {
    io::Error::new(
        error.kind(),
        format!("cannot write `{}`: {error}", path.display()),
    )
}
