//! Files that take their place at once.

use crate::error::{OutputError, naming};
use crate::open_to_read;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// How names of temporary files begin and end.
const PREFIX: &str = ".looselink-";
const SUFFIX: &str = ".tmp";
/// Random letters and digits between.
const RANDOM: usize = 6;

/// Puts a whole file in its place at once: a reader sees the old one or the new one, never a part. A link to a file is
/// replaced, not followed.
///
/// # Errors
/// A pipe, a device or a folder in its place; when it cannot be written. The message names the file.
pub fn replace(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
        return Err(OutputError::NotAFile(path.to_owned()));
    }
    remove_leftovers(parent(path));
    Ok(place(path, bytes)?)
}

/// As [`replace`], in a folder whose leftovers are removed already.
pub(crate) fn place(path: &Path, bytes: &[u8]) -> io::Result<()> {
    Temporary::new(path, bytes)?.name(path)
}

/// A file that has all its bytes, on the disk, and no name yet.
#[derive(Debug)]
pub(crate) struct Temporary(NamedTempFile);

impl Temporary {
    /// In the folder of the file that it will be.
    pub fn new(path: &Path, bytes: &[u8]) -> io::Result<Temporary> {
        write(parent(path), bytes).map_err(naming(path))
    }

    /// Gives it a name in its folder.
    pub fn name(self, path: &Path) -> io::Result<()> {
        // locked until it has its name
        let (_file, temporary) = self.0.into_parts();
        fs::rename(&temporary, path).map_err(naming(path))?;
        temporary.keep()?;
        Ok(())
    }

    /// The same where nothing has that name.
    pub fn name_new(self, path: &Path) -> io::Result<()> {
        let named = self.0.persist_noclobber(path);
        named.map_err(|e| naming(path)(e.error)).map(drop)
    }
}

fn write(folder: &Path, bytes: &[u8]) -> io::Result<Temporary> {
    let mut temporary = temporary(folder)?;
    temporary.as_file_mut().write_all(bytes)?;
    // on the disk before the name points at it
    temporary.as_file().sync_all()?;
    Ok(Temporary(temporary))
}

/// The folder of a file.
fn parent(path: &Path) -> &Path {
    let parent = path.parent().filter(|parent| parent.as_os_str() != "");
    parent.unwrap_or(Path::new("."))
}

/// A file with a name that nothing else has, locked as long as it is open.
fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    loop {
        let create = |path: &Path| File::create_new(path);
        let file = builder().make_in(folder, create)?;
        // until it is locked it looks like a leftover, and may be removed as such; a file system without locks has no leftovers that
        // could be told from files in use
        let is_taken = matches!(file.as_file().try_lock(), Err(TryLockError::WouldBlock));
        if !is_taken && file.path().exists() {
            return Ok(file);
        }
    }
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM);
    builder
}

/// A folder with a name that nothing else has.
pub(crate) fn temporary_folder(folder: &Path) -> io::Result<PathBuf> {
    let made = builder().make_in(folder, |path| fs::create_dir(path));
    let kept = made.and_then(|made| Ok(made.into_temp_path().keep()?));
    kept.map_err(naming(folder))
}

/// Removes the temporary files in a folder that no program has open. What cannot be removed does no harm.
pub(crate) fn remove_leftovers(folder: &Path) {
    for path in named_like_temporaries(folder, fs::FileType::is_file) {
        let Ok(file) = open_to_read(&path) else {
            continue;
        };
        // locked until it is removed
        if file.try_lock().is_ok() {
            let _ = fs::remove_file(path);
        }
    }
}

/// The temporary folders of a folder.
pub(crate) fn left_folders(folder: &Path) -> impl Iterator<Item = PathBuf> {
    named_like_temporaries(folder, fs::FileType::is_dir)
}

fn named_like_temporaries(
    folder: &Path,
    kind: fn(&fs::FileType) -> bool,
) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let named = entries.filter(move |entry| {
        let name = entry.file_name();
        let random = name.to_str().and_then(|name| name.strip_prefix(PREFIX));
        let random = random.and_then(|name| name.strip_suffix(SUFFIX));
        random.is_some_and(|random| {
            random.len() == RANDOM && random.bytes().all(|b| b.is_ascii_alphanumeric())
        }) && entry.file_type().is_ok_and(|found| kind(&found))
    });
    named.map(|entry| entry.path())
}
