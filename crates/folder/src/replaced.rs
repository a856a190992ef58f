//! The result that another one replaces: it stands aside until that is whole.

use crate::claim::{is_there, remove};
use crate::error::{OutputError, naming};
use crate::kind::Kind;
use crate::manifest::{MANIFEST, Manifest};
use crate::temporary::temporary_folder;
use std::fs;
use std::io::{self, Cursor, ErrorKind};
use std::path::Path;

pub(crate) const PREVIOUS: &str = "previous-result";

/// What stands aside.
fn aside(folder: &Path, kind: &Kind) -> io::Result<Manifest> {
    let aside = folder.join(PREVIOUS);
    let manifest = Manifest::of(&aside)?.unwrap_or_default();
    Ok(kind.held(&aside, manifest))
}

/// Refuses to replace what stands aside and is not all of the program.
pub(crate) fn refuse_foreign(folder: &Path, kind: &Kind) -> Result<(), OutputError> {
    let path = folder.join(PREVIOUS);
    let Ok(metadata) = fs::symlink_metadata(&path) else {
        return Ok(());
    };
    if !metadata.is_dir() {
        return Err(OutputError::NotADirectory(path));
    }
    let held = aside(folder, kind)?;
    for entry in fs::read_dir(&path).map_err(naming(&path))? {
        let name = entry.map_err(naming(&path))?.file_name();
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
    let present: Vec<_> = present
        .map(|(file, digest)| (file.clone(), *digest))
        .collect();
    if present.is_empty() || (previous.exists() && !kind.is_whole(folder)) {
        return Ok(());
    }
    let temporary = temporary_folder(folder)?;
    for (file, _) in &present {
        link(&folder.join(file), &temporary.join(file))?;
    }
    let mut manifest = Cursor::new(Vec::new());
    Manifest::default().add(&mut manifest, kind.name, present)?;
    let path = temporary.join(MANIFEST);
    fs::write(&path, manifest.into_inner()).map_err(naming(&path))?;
    discard(folder, kind)?;
    fs::rename(&temporary, &previous).map_err(naming(&previous))
}

/// Deletes the files of the program in a folder, first the one without which there is no result.
pub(crate) fn delete(folder: &Path, kind: &Kind, held: &Manifest) -> io::Result<()> {
    let closing = kind.files[..1].iter();
    let closing = closing.filter(|file| held.files.contains_key(*file));
    let mut files = closing.chain(held.files.keys());
    files.try_for_each(|file| remove(&folder.join(file)))
}

/// Deletes what stands aside. What is not the program's stays.
pub(crate) fn discard(folder: &Path, kind: &Kind) -> io::Result<()> {
    let path = folder.join(PREVIOUS);
    if !path.exists() {
        return Ok(());
    }
    delete(&path, kind, &aside(folder, kind)?)?;
    remove(&path.join(MANIFEST))?;
    match fs::remove_dir(&path) {
        Err(e) if e.kind() != ErrorKind::DirectoryNotEmpty => Err(naming(&path)(e)),
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
