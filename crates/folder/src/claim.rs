//! A folder that a program has claimed for a result.

use crate::digest::Digest;
use crate::error::{OutputError, naming, naming_read};
use crate::kind::Kind;
use crate::lock::{Lock, Sharing, is_at, turn};
use crate::manifest::{MANIFEST, Manifest};
use crate::open;
use crate::replaced::{self, PREVIOUS, remove_left_folders};
use crate::temporary::{place, remove_leftovers};
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// True of whatever has this path, also of a link to nothing.
pub(crate) fn is_there(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Where the earlier result of `folder` stands aside, if it does.
pub fn earlier_result(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(PREVIOUS)).filter(|aside| aside.exists())
}

/// What a claim has brought into being, as long as nothing is written.
#[derive(Debug, Default)]
struct Undo {
    /// With its length.
    manifest: Option<(PathBuf, u64)>,
    /// Innermost first.
    folders: Vec<PathBuf>,
}

impl Undo {
    /// Takes it away again, while nobody else can claim it.
    fn undo(&self) {
        if let Some((path, length)) = &self.manifest
            && fs::metadata(path).is_ok_and(|file| file.len() == *length)
        {
            let _ = fs::remove_file(path);
        }
        for folder in &self.folders {
            // what has come into it since stays
            let _ = fs::remove_dir(folder);
        }
    }
}

/// A folder that is locked for a result.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    kind: Kind,
    /// True where an earlier result may be replaced.
    replaces: bool,
    manifest: Manifest,
    undo: Undo,
    lock: Lock,
}

impl Folder {
    /// Locks a folder for a result; it is created. With `replaces` an earlier result of the same kind may be replaced. Nothing that
    /// is there is changed before [`Folder::begin`], and a folder that is given up before is as it was.
    ///
    /// # Errors
    /// Another program writes to it; a result that may not be replaced, or files of others that have the names of its files.
    pub fn claim(path: &Path, kind: Kind, replaces: bool) -> Result<Folder, OutputError> {
        let refuse =
            |kind: &Kind, manifest: &Manifest| refuse_occupied(path, kind, manifest, replaces);
        let folder = Folder::locked(path, kind, replaces, Sharing::Alone, refuse)?;
        remove_leftovers(path);
        remove_left_folders(path, &folder.kind);
        Ok(folder)
    }

    /// Locks a folder that several programs share, each with files of its own besides those of the kind; it is created. See
    /// [`Folder::adopt`].
    ///
    /// # Errors
    /// A program has the folder for itself; it holds something else, or files of others that have the names of its files.
    pub fn share(path: &Path, kind: Kind) -> Result<Folder, OutputError> {
        let refuse = |kind: &Kind, manifest: &Manifest| {
            refuse_another_kind(path, kind, manifest)?;
            refuse_foreign(path, manifest, &kind.files)
        };
        let folder = Folder::locked(path, kind, false, Sharing::Together, refuse)?;
        remove_leftovers(path);
        Ok(folder)
    }

    /// Locks a folder whose result is to be continued.
    ///
    /// # Errors
    /// Another program writes to it, or it holds something else. None without a manifest.
    pub fn reopen(path: &Path, kind: Kind) -> Result<Option<Folder>, OutputError> {
        let lock = match Lock::take(path, Sharing::Alone, None) {
            Err(OutputError::Io(e)) if e.kind() == ErrorKind::NotADirectory => None,
            lock => lock?,
        };
        let Some(lock) = lock else {
            return Ok(None);
        };
        let folder = Folder::of(path, kind, true, Undo::default(), lock)?;
        refuse_another_kind(path, &folder.kind, &folder.manifest)?;
        remove_leftovers(path);
        Ok(Some(folder))
    }

    /// Locks a folder unless what it holds is refused.
    fn locked(
        path: &Path,
        kind: Kind,
        replaces: bool,
        sharing: Sharing,
        refuse: impl Fn(&Kind, &Manifest) -> Result<(), OutputError>,
    ) -> Result<Folder, OutputError> {
        if is_there(path) && !path.is_dir() {
            return Err(OutputError::NotADirectory(path.to_owned()));
        }
        let mut new = Vec::new();
        if !is_there(&path.join(MANIFEST)) {
            // what is to be refused anyhow is refused before a lock comes into being
            let earlier = kind.held(path)?;
            refuse(&kind, &earlier)?;
            new = Manifest::bytes(kind.name, &earlier.files)?;
        }
        let missing = path
            .ancestors()
            .take_while(|p| *p != Path::new("") && !p.exists());
        let mut undo = Undo {
            manifest: None,
            folders: missing.map(Path::to_owned).collect(),
        };
        let made = fs::create_dir_all(path).map_err(naming(path));
        let lock = made.map_err(OutputError::from);
        let lock = lock.and_then(|()| Lock::take(path, sharing, Some(&new)));
        let lock = lock.inspect_err(|_| undo.undo())?;
        let lock = lock.expect("it was to be created");
        undo.manifest = lock.created.map(|length| (lock.path().to_owned(), length));
        // what is listed and what is there belong together
        let _turn = turn(path);
        let folder = Folder::of(path, kind, replaces, undo, lock)?;
        refuse(&folder.kind, &folder.manifest)?;
        Ok(folder)
    }

    fn of(
        path: &Path,
        kind: Kind,
        replaces: bool,
        undo: Undo,
        mut lock: Lock,
    ) -> Result<Folder, OutputError> {
        let manifest = Manifest::read(lock.file()).map_err(naming_read(lock.path()))?;
        Ok(Folder {
            path: path.to_owned(),
            manifest,
            kind,
            replaces,
            undo,
            lock,
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// True of a file that is the program's.
    pub fn owns(&self, file: &str) -> bool {
        self.manifest.files.contains_key(file)
    }

    /// Begins a result with these files: an earlier one is set aside.
    ///
    /// # Errors
    /// When a file cannot be written, moved or deleted.
    pub fn begin(&mut self, files: impl IntoIterator<Item = String>) -> Result<(), OutputError> {
        self.refuse_moved()?;
        let _turn = turn(&self.path);
        // files that have joined the earlier result since the claim go with it
        let (file, path) = self.lock.file_and_path();
        self.manifest = Manifest::read(file).map_err(naming_read(path))?;
        if self.replaces {
            replaced::set_aside(&self.path, &self.kind, &self.manifest)?;
        }
        replaced::delete(&self.path, &self.kind, &self.manifest)?;
        let (file, path) = self.lock.file_and_path();
        file.set_len(0).map_err(naming(path))?;
        self.manifest = Manifest {
            replaces: self.replaces,
            ..Manifest::default()
        };
        self.list(files.into_iter().map(|file| (file, None)))
    }

    /// Makes files the program's: each is there as the program's already, or not there.
    ///
    /// # Errors
    /// A file of somebody else; a manifest that cannot be written.
    pub fn adopt(&mut self, files: &[String]) -> Result<(), OutputError> {
        refuse_foreign(&self.path, &self.manifest, files)?;
        let new = files.iter().filter(|file| !self.owns(file));
        let new: Vec<_> = new.map(|file| (file.clone(), None)).collect();
        self.list(new)
    }

    /// Says in the manifest what files there are, and with which digests.
    ///
    /// # Errors
    /// When the manifest cannot be written.
    pub fn list(
        &mut self,
        files: impl IntoIterator<Item = (String, Option<Digest>)>,
    ) -> Result<(), OutputError> {
        let (file, path) = self.lock.file_and_path();
        let there = Manifest::read(file).map_err(naming_read(path))?;
        let is_there = |file| there.files.contains_key(file);
        let is_emptied = self.manifest.kind.is_some() && there.kind != self.manifest.kind;
        if is_emptied || !self.manifest.files.keys().all(is_there) {
            return Err(changed(path, EDITED));
        }
        let added = self.manifest.add(file, self.kind.name, files);
        self.undo = Undo::default();
        Ok(added.and_then(|()| file.sync_all()).map_err(naming(path))?)
    }

    /// Creates a file of the result.
    ///
    /// # Errors
    /// When it cannot be created, or is there.
    pub fn create(&self, file: &str) -> Result<File, OutputError> {
        self.refuse_moved()?;
        let path = self.path.join(file);
        let created = open(&path, OpenOptions::new().write(true).create_new(true));
        created.map_err(|e| match e.kind() {
            ErrorKind::AlreadyExists => OutputError::Foreign(path),
            _ => e.into(),
        })
    }

    /// Puts a file of the result in its place: see [`crate::replace`].
    ///
    /// # Errors
    /// When it cannot be written, or the folder is no longer in its place.
    pub fn replace(&self, file: &str, bytes: &[u8]) -> Result<(), OutputError> {
        self.refuse_moved()?;
        let _turn = turn(&self.path);
        Ok(place(&self.path.join(file), bytes)?)
    }

    /// Writes a result that is made in one piece: the texts of its files, in their order. The last files may be missing from it.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(mut self, texts: &[Vec<u8>]) -> Result<(), OutputError> {
        let files: Vec<String> = self.kind.files.iter().take(texts.len()).cloned().collect();
        self.begin(files.iter().cloned())?;
        for (file, bytes) in files.iter().zip(texts).rev() {
            self.list([(file.clone(), Some(Digest::of(bytes)))])?;
            self.replace(file, bytes)?;
        }
        self.forget()
    }

    /// Deletes a file of the result.
    ///
    /// # Errors
    /// When it cannot be deleted.
    pub fn remove(&self, file: &str) -> Result<(), OutputError> {
        self.refuse_moved()?;
        Ok(remove(&self.path.join(file))?)
    }

    /// Deletes the result that this one has replaced, as this one is whole.
    ///
    /// # Errors
    /// When it cannot be deleted.
    pub fn forget(&self) -> Result<(), OutputError> {
        Ok(replaced::forget(&self.path, &self.kind, &self.manifest)?)
    }

    /// Refuses a folder that is not the one that was locked.
    ///
    /// # Errors
    /// [`OutputError::Changed`] of the manifest.
    pub fn refuse_moved(&self) -> Result<(), OutputError> {
        match self.lock.is_in_place()? {
            true => Ok(()),
            false => Err(changed(self.lock.path(), MOVED)),
        }
    }
}

/// What somebody else has done to a file while the program wrote to it.
const MOVED: &str = "was moved, replaced or deleted while the program wrote the result";
const EDITED: &str = "was changed while the program wrote the result";

fn changed(path: &Path, how: &str) -> OutputError {
    OutputError::Changed {
        path: path.to_owned(),
        how: how.to_owned(),
    }
}

/// Refuses a manifest that is none, or of a folder that holds something else.
pub(crate) fn refuse_another_kind(
    path: &Path,
    kind: &Kind,
    manifest: &Manifest,
) -> Result<(), OutputError> {
    match &manifest.kind {
        None if manifest.is_foreign => Err(OutputError::NoManifest(path.join(MANIFEST))),
        Some(held) if held != kind.name => Err(OutputError::OfAnotherKind {
            folder: path.to_owned(),
            held: held.clone(),
        }),
        _ => Ok(()),
    }
}

/// Refuses files that are there and somebody else's.
pub(crate) fn refuse_foreign(
    path: &Path,
    manifest: &Manifest,
    files: &[String],
) -> Result<(), OutputError> {
    let foreign =
        |file: &&String| !manifest.files.contains_key(*file) && is_there(&path.join(file));
    match files.iter().find(foreign) {
        Some(file) => Err(OutputError::Foreign(path.join(file))),
        None => Ok(()),
    }
}

/// Refuses a folder with a result unless it may be replaced, what is somebody else's, and what is no file.
fn refuse_occupied(
    folder: &Path,
    kind: &Kind,
    manifest: &Manifest,
    replaces: bool,
) -> Result<(), OutputError> {
    refuse_another_kind(folder, kind, manifest)?;
    for file in kind.files.iter().chain(manifest.files.keys()) {
        let path = folder.join(file);
        if !is_there(&path) {
            continue;
        }
        if !manifest.files.contains_key(file) {
            return Err(OutputError::Foreign(path));
        }
        if !replaces {
            return Err(OutputError::Occupied {
                folder: folder.to_owned(),
                file: file.clone(),
            });
        }
        if !path.is_file() {
            return Err(OutputError::NotAFile(path));
        }
    }
    match replaces {
        true => replaced::refuse_foreign(folder, kind),
        false => Ok(()),
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // others may share the folder by now
        if self.lock.is_alone() {
            self.undo.undo();
        }
    }
}

/// Refuses an open file that is no longer at its path.
///
/// # Errors
/// [`OutputError::Changed`], or a file that cannot be found.
pub fn refuse_moved(path: &Path, file: &File) -> Result<(), OutputError> {
    match is_at(file, path)? {
        true => Ok(()),
        false => Err(changed(path, MOVED)),
    }
}

/// Refuses a file that is no longer what the program wrote: not there, with other bytes or, where it is still open, another one. Its
/// first bytes count, as many as `counts` says.
///
/// # Errors
/// [`OutputError::Changed`], or a file that cannot be read.
pub fn refuse_changed(
    path: &Path,
    file: Option<&File>,
    digest: Digest,
    counts: u64,
) -> Result<(), OutputError> {
    file.map_or(Ok(()), |file| refuse_moved(path, file))?;
    if !path.is_file() {
        return Err(changed(path, MOVED));
    }
    let read = File::open(path).and_then(|file| Digest::read(file, counts));
    match read.map_err(naming_read(path))? == digest {
        true => Ok(()),
        false => Err(changed(path, EDITED)),
    }
}

/// Deletes a file that may not be there.
pub(crate) fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(naming(path)(e)),
        _ => Ok(()),
    }
}
