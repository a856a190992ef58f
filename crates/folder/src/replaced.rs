//! The result that another one replaces: it stands aside until that is whole.

use crate::claim::{is_there, remove};
use crate::error::{OutputError, naming, naming_read};
use crate::kind::Kind;
use crate::manifest::{MANIFEST, Manifest};
use crate::temporary::{left_folders, temporary_folder};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::Path;

pub(crate) const PREVIOUS: &str = "previous-result";

/// Refuses to replace what stands aside and is not all of the program.
pub(crate) fn refuse_foreign(folder: &Path, kind: &Kind) -> Result<(), OutputError> {
    let path = folder.join(PREVIOUS);
    let Ok(metadata) = fs::symlink_metadata(&path) else {
        return Ok(());
    };
    if !metadata.is_dir() {
        return Err(OutputError::NotADirectory(path));
    }
    let held = kind.held(&path)?;
    for entry in fs::read_dir(&path).map_err(naming_read(&path))? {
        let name = entry.map_err(naming_read(&path))?.file_name();
        let is_listed = |name: &str| name == MANIFEST || held.files.contains_key(name);
        if !name.to_str().is_some_and(is_listed) {
            return Err(OutputError::Foreign(path.join(name)));
        }
    }
    Ok(())
}

/// Sets a result aside. What stands aside already gives way to a whole result only: a run that was killed does not push out the
/// result that it was to replace.
pub(crate) fn set_aside(folder: &Path, kind: &Kind, held: &Manifest) -> io::Result<()> {
    let previous = folder.join(PREVIOUS);
    let present = held.files.iter();
    let present = present.filter(|(file, _)| is_there(&folder.join(file)));
    let present: BTreeMap<_, _> = present
        .map(|(file, digest)| (file.clone(), *digest))
        .collect();
    if present.is_empty() || (previous.exists() && !kind.is_whole(folder)) {
        return Ok(());
    }
    let temporary = temporary_folder(folder)?;
    let fill = || {
        // what is left of it after a kill is known by the manifest
        let path = temporary.join(MANIFEST);
        fs::write(&path, Manifest::bytes(kind.name, &present)?).map_err(naming(&path))?;
        let mut files = present.keys();
        files.try_for_each(|file| link(&folder.join(file), &temporary.join(file)))
    };
    fill().inspect_err(|_| drop(empty(&temporary, kind)))?;
    discard(folder, kind)?;
    fs::rename(&temporary, &previous).map_err(naming(&previous))
}

/// Deletes what killed programs have left of results that they set aside.
pub(crate) fn remove_left_folders(folder: &Path, kind: &Kind) {
    for path in left_folders(folder) {
        // what cannot be deleted does no harm
        let _ = match is_there(&path.join(MANIFEST)) {
            true => empty(&path, kind),
            false => fs::remove_dir(&path),
        };
    }
}

/// Deletes the files of the program in a folder, first the one without which there is no result.
pub(crate) fn delete(folder: &Path, kind: &Kind, held: &Manifest) -> io::Result<()> {
    let closing = kind.files[..1].iter();
    let closing = closing.filter(|file| held.files.contains_key(*file));
    let mut files = closing.chain(held.files.keys());
    files.try_for_each(|file| remove(&folder.join(file)))
}

/// Deletes what stands aside where a result has replaced it that is now whole.
pub(crate) fn forget(folder: &Path, kind: &Kind, held: &Manifest) -> io::Result<()> {
    if !held.replaces {
        return Ok(());
    }
    // the new result is on the disk, with the names of its files
    sync_names(folder)?;
    discard(folder, kind)
}

/// Deletes what stands aside. What is not the program's stays.
fn discard(folder: &Path, kind: &Kind) -> io::Result<()> {
    let path = folder.join(PREVIOUS);
    match path.exists() {
        true => empty(&path, kind),
        false => Ok(()),
    }
}

/// Deletes the files of the program in a folder, and the folder where nothing else is in it.
fn empty(path: &Path, kind: &Kind) -> io::Result<()> {
    let held = kind.held(path)?;
    delete(path, kind, &held)?;
    if !held.is_foreign {
        remove(&path.join(MANIFEST))?;
    }
    match fs::remove_dir(path) {
        // another program may have deleted it
        Err(e) if ![ErrorKind::DirectoryNotEmpty, ErrorKind::NotFound].contains(&e.kind()) => {
            Err(naming(path)(e))
        }
        _ => Ok(()),
    }
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

/// Sees that the names in a folder are on the disk.
fn sync_names(folder: &Path) -> io::Result<()> {
    match cfg!(unix) {
        true => File::open(folder)
            .and_then(|folder| folder.sync_all())
            .map_err(naming(folder)),
        false => Ok(()),
    }
}
