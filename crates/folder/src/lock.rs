//! The lock of a folder: that of its manifest.

use crate::error::{OutputError, naming};
use crate::temporary::Temporary;
use crate::{MANIFEST, open};
use same_file::Handle;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Who else may hold the lock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sharing {
    /// Nobody.
    Alone,
    /// Those who share it too.
    Together,
}

/// A manifest that is open and locked.
#[derive(Debug)]
pub(crate) struct Lock {
    path: PathBuf,
    file: File,
    /// Where there was no manifest: how long the new one was at first.
    pub created: Option<u64>,
}

impl Lock {
    /// Locks a folder that is there. Without a manifest one of these bytes comes into being, or there is no lock.
    pub fn take(
        folder: &Path,
        sharing: Sharing,
        new: Option<&[u8]>,
    ) -> Result<Option<Lock>, OutputError> {
        let path = folder.join(MANIFEST);
        loop {
            let Some((file, created)) = opened(&path, new)? else {
                return Ok(None);
            };
            let locked = match sharing {
                Sharing::Alone => file.try_lock(),
                Sharing::Together => file.try_lock_shared(),
            };
            match locked {
                Err(TryLockError::WouldBlock) => return Err(OutputError::Busy(folder.to_owned())),
                Err(TryLockError::Error(e)) if !has_no_locks(&e) => {
                    return Err(naming(&path)(e).into());
                }
                _ => {}
            }
            let path = path.clone();
            let lock = Lock {
                path,
                file,
                created,
            };
            // between the two steps another program may have given the folder up
            if lock.is_in_place()? {
                return Ok(Some(lock));
            }
        }
    }

    /// False where the manifest, and perhaps its folder, has been moved, replaced or deleted.
    pub fn is_in_place(&self) -> io::Result<bool> {
        is_at(&self.file, &self.path)
    }

    /// The manifest, opened for reading and for additions at its end.
    pub fn file(&mut self) -> &mut File {
        &mut self.file
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn file_and_path(&mut self) -> (&mut File, &Path) {
        (&mut self.file, &self.path)
    }

    /// True where nobody else holds the lock; then nobody can take it.
    pub fn is_alone(&self) -> bool {
        self.file.try_lock().is_ok()
    }
}

/// Waits for the turn of this program to change which files a folder has; it ends when what is returned is closed. Whoever holds the lock
/// of the manifest begins and closes results in its turn, others add files to them. Where a system does not lock folders, there are no
/// turns.
pub(crate) fn turn(folder: &Path) -> Option<File> {
    let folder = File::open(folder).ok()?;
    folder.lock().ok().map(|()| folder)
}

/// True of an open file that stands at a path itself, not behind a link there.
pub(crate) fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    let named = |e| naming(path)(e);
    match fs::symlink_metadata(path) {
        Ok(there) if there.is_file() => {}
        Err(e) if !matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Err(named(e));
        }
        _ => return Ok(false),
    }
    let own = file
        .try_clone()
        .and_then(Handle::from_file)
        .map_err(named)?;
    match Handle::from_path(path) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
        there => Ok(there.map_err(named)? == own),
    }
}

/// A manifest and, where it came into being, its length. One that is not empty is whole at once, as nothing says later whether an empty
/// one was new.
pub(crate) fn opened(path: &Path, new: Option<&[u8]>) -> io::Result<Option<(File, Option<u64>)>> {
    let mut options = OpenOptions::new();
    options.read(true).append(true);
    loop {
        match open(path, &mut options) {
            Ok(file) => return Ok(Some((file, None))),
            Err(e) if e.kind() != ErrorKind::NotFound => return Err(e),
            Err(_) => {}
        }
        let Some(bytes) = new else {
            return Ok(None);
        };
        let created = match bytes {
            [] => open(path, options.clone().create_new(true)),
            _ => Temporary::new(path, bytes)
                .and_then(|temporary| temporary.name_new(path))
                .and_then(|()| open(path, &mut options)),
        };
        match created {
            Ok(file) => return Ok(Some((file, Some(bytes.len() as u64)))),
            // another program was faster
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e),
        }
    }
}

/// File systems without locks, as some that are shared over a network.
fn has_no_locks(error: &io::Error) -> bool {
    #[cfg(unix)]
    if let Some(code) = error.raw_os_error() {
        return [libc::ENOTSUP, libc::EOPNOTSUPP, libc::ENOSYS, libc::ENOLCK].contains(&code);
    }
    error.kind() == ErrorKind::Unsupported
}
