//! A folder that a program has claimed for a result.

use crate::digest::Digest;
use crate::error::{OutputError, naming};
use crate::lock::{Lock, Sharing, is_at};
use crate::manifest::{MANIFEST, Manifest};
use crate::open;
use crate::replaced::{self, PREVIOUS};
use crate::temporary::{place, remove_left_folders, remove_leftovers};
use same_file::Handle;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// A kind of result.
#[derive(Debug, Clone)]
pub struct Kind {
    /// What a folder holds, in words: "a run".
    pub name: &'static str,
    /// Names that its files can have. The first of them closes a result, is JSON and comes last: without that there is none.
    pub files: Vec<String>,
    /// Keys of the closing file, by which the result of an earlier version is known: that has no manifest.
    pub keys: &'static [&'static str],
}

impl Kind {
    /// The file that closes a result, where there is one of this kind in a folder.
    fn closing(&self, folder: &Path) -> Option<serde_json::Value> {
        let bytes = fs::read(folder.join(&self.files[0])).ok()?;
        let value: serde_json::Value = serde_json::from_slice(&bytes).ok()?;
        let is_known = self.keys.iter().all(|key| value.get(key).is_some());
        is_known.then_some(value)
    }

    /// True where a folder holds a result that came to its end.
    pub(crate) fn is_whole(&self, folder: &Path) -> bool {
        let closing = self.closing(folder);
        closing.is_some_and(|closing| closing.get("status").is_none_or(|s| s == "complete"))
    }

    /// What a folder holds of the program: by its manifest or, of an earlier version, which wrote none, by the closing file.
    pub(crate) fn held(&self, folder: &Path, mut manifest: Manifest) -> Manifest {
        if manifest.kind.is_none() && self.closing(folder).is_some() {
            let present = self
                .files
                .iter()
                .filter(|file| is_there(&folder.join(file)));
            manifest.files = present.map(|file| (file.clone(), None)).collect();
        }
        manifest
    }
}

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
    manifest: Option<PathBuf>,
    /// Innermost first.
    folders: Vec<PathBuf>,
}

impl Undo {
    /// Takes it away again, while nobody else can claim it.
    fn undo(&self) {
        let is_empty = |path: &&PathBuf| fs::metadata(path).is_ok_and(|file| file.len() == 0);
        if let Some(manifest) = self.manifest.as_ref().filter(is_empty) {
            let _ = fs::remove_file(manifest);
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
    pub replaces: bool,
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
        let folder = Folder::locked(path, kind, replaces, Sharing::Alone)?;
        folder.refuse_occupied()?;
        remove_leftovers(path);
        remove_left_folders(path);
        Ok(folder)
    }

    /// Locks a folder that several programs share, each with files of its own besides those of the kind; it is created. See
    /// [`Folder::adopt`].
    ///
    /// # Errors
    /// A program has the folder for itself; it holds something else, or files of others that have the names of its files.
    pub fn share(path: &Path, kind: Kind) -> Result<Folder, OutputError> {
        let folder = Folder::locked(path, kind, false, Sharing::Together)?;
        folder.refuse_another_kind()?;
        folder.refuse_foreign(&folder.kind.files)?;
        remove_leftovers(path);
        Ok(folder)
    }

    /// Locks a folder whose result is to be continued.
    ///
    /// # Errors
    /// Another program writes to it, or it holds something else. None without a manifest.
    pub fn reopen(path: &Path, kind: Kind) -> Result<Option<Folder>, OutputError> {
        let lock = match Lock::take(path, Sharing::Alone, false) {
            Err(OutputError::Io(e)) if e.kind() == ErrorKind::NotADirectory => None,
            lock => lock?,
        };
        let Some(lock) = lock else {
            return Ok(None);
        };
        let folder = Folder::of(path, kind, true, Undo::default(), lock)?;
        folder.refuse_another_kind()?;
        remove_leftovers(path);
        Ok(Some(folder))
    }

    fn locked(
        path: &Path,
        kind: Kind,
        replaces: bool,
        sharing: Sharing,
    ) -> Result<Folder, OutputError> {
        if is_there(path) && !path.is_dir() {
            return Err(OutputError::NotADirectory(path.to_owned()));
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
        let lock = lock.and_then(|()| Lock::take(path, sharing, true));
        let lock = lock.inspect_err(|_| undo.undo())?;
        let lock = lock.expect("it was to be created");
        undo.manifest = lock.is_new.then(|| lock.path().to_owned());
        Folder::of(path, kind, replaces, undo, lock)
    }

    fn of(
        path: &Path,
        kind: Kind,
        replaces: bool,
        undo: Undo,
        mut lock: Lock,
    ) -> Result<Folder, OutputError> {
        let manifest = Manifest::read(lock.file()).map_err(naming(lock.path()))?;
        Ok(Folder {
            path: path.to_owned(),
            manifest: kind.held(path, manifest),
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

    fn refuse_another_kind(&self) -> Result<(), OutputError> {
        match &self.manifest.kind {
            Some(held) if held != self.kind.name => Err(OutputError::OfAnotherKind {
                folder: self.path.clone(),
                held: held.clone(),
            }),
            None if self.manifest.is_foreign => {
                Err(OutputError::Foreign(self.lock.path().to_owned()))
            }
            _ => Ok(()),
        }
    }

    /// Refuses files that are there and somebody else's.
    fn refuse_foreign(&self, files: &[String]) -> Result<(), OutputError> {
        let foreign = |file: &&String| !self.owns(file) && is_there(&self.path.join(file));
        match files.iter().find(foreign) {
            Some(file) => Err(OutputError::Foreign(self.path.join(file))),
            None => Ok(()),
        }
    }

    /// Refuses a folder with a result unless it may be replaced, what is somebody else's, and what is no file.
    fn refuse_occupied(&self) -> Result<(), OutputError> {
        self.refuse_another_kind()?;
        let listed = self.manifest.files.keys();
        for file in self.kind.files.iter().chain(listed) {
            let path = self.path.join(file);
            if !is_there(&path) {
                continue;
            }
            if !self.owns(file) {
                return Err(OutputError::Foreign(path));
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
        match self.replaces {
            true => replaced::refuse_foreign(&self.path, &self.kind),
            false => Ok(()),
        }
    }

    /// Begins a result with these files: an earlier one is set aside.
    ///
    /// # Errors
    /// When a file cannot be written, moved or deleted.
    pub fn begin(&mut self, files: impl IntoIterator<Item = String>) -> Result<(), OutputError> {
        if self.replaces {
            replaced::set_aside(&self.path, &self.kind, &self.manifest)?;
        }
        self.clear(files)
    }

    /// Deletes the files of the program and begins a result with others.
    ///
    /// # Errors
    /// When a file cannot be deleted or written.
    pub fn clear(&mut self, files: impl IntoIterator<Item = String>) -> Result<(), OutputError> {
        self.refuse_moved()?;
        if self.manifest.kind.is_none() {
            // an earlier version wrote no manifest: what a kill leaves of its files is to be known as well
            self.list(self.manifest.files.clone())?;
        }
        replaced::delete(&self.path, &self.kind, &self.manifest)?;
        let (file, path) = self.lock.file_and_path();
        file.set_len(0).map_err(naming(path))?;
        self.manifest = Manifest::default();
        self.list(files.into_iter().map(|file| (file, None)))
    }

    /// Makes files the program's: each is there as the program's already, or not there.
    ///
    /// # Errors
    /// A file of somebody else; a manifest that cannot be written.
    pub fn adopt(&mut self, files: &[String]) -> Result<(), OutputError> {
        self.refuse_foreign(files)?;
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

    /// Deletes the result that this one has replaced.
    ///
    /// # Errors
    /// When it cannot be deleted.
    pub fn forget(&self) -> Result<(), OutputError> {
        match self.replaces {
            true => {
                // the new result is on the disk, with the names of its files
                sync_names(&self.path)?;
                Ok(replaced::discard(&self.path, &self.kind)?)
            }
            false => Ok(()),
        }
    }

    /// Refuses to write to a folder that is not the one that was locked.
    fn refuse_moved(&self) -> Result<(), OutputError> {
        match self.lock.is_in_place() {
            true => Ok(()),
            false => Err(OutputError::Changed {
                path: self.path.clone(),
                how: "was moved, replaced or deleted while the program wrote to it",
            }),
        }
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

/// Puts files into a folder beside those that are there, such as pictures of a result: each is there as the program's already, or
/// not there. Several programs may do so at the same time. Where the file that closes a result is among them and changes, it is
/// away until all others are in their place, and others of the kind that are the program's are deleted.
///
/// # Errors
/// A file of somebody else; a file that cannot be written.
pub fn add(
    folder: &Path,
    kind: &Kind,
    files: &[(&str, impl AsRef<[u8]>)],
) -> Result<(), OutputError> {
    let path = folder.join(MANIFEST);
    let mut options = OpenOptions::new();
    let mut file = open(&path, options.read(true).append(true).create(true))?;
    let manifest = Manifest::read(&mut file).map_err(naming(&path))?;
    let is_new = manifest.kind.is_none();
    let mut manifest = kind.held(folder, manifest);
    let foreign = |name: &str| !manifest.files.contains_key(name) && is_there(&folder.join(name));
    if let Some((name, _)) = files.iter().find(|(name, _)| foreign(name)) {
        return Err(OutputError::Foreign(folder.join(name)));
    }
    let closing = folder.join(&kind.files[0]);
    let closes = files.iter().find(|(name, _)| *name == kind.files[0]);
    let changes = |(_, bytes): &&(&str, _)| {
        let bytes: &[u8] = AsRef::as_ref(bytes);
        fs::read(&closing).is_ok_and(|old| old != bytes)
    };
    if closes.is_some_and(|file| changes(&file)) {
        let given = |name: &&String| files.iter().any(|(given, _)| given == name);
        let stale = kind.files.iter().filter(|name| !given(name));
        let stale = stale.filter(|name| manifest.files.contains_key(*name));
        let stale = stale.map(|name| folder.join(name));
        std::iter::once(closing.clone())
            .chain(stale)
            .try_for_each(|path| remove(&path))?;
    }
    let earlier = manifest.files.keys().filter(|_| is_new).cloned();
    let mut new: Vec<String> = earlier.collect();
    let unlisted = files.iter().map(|(name, _)| (*name).to_owned());
    new.extend(unlisted.filter(|name| !manifest.files.contains_key(name)));
    if is_new || !new.is_empty() {
        let new = new.into_iter().map(|name| (name, None));
        let added = manifest.add(&mut file, kind.name, new);
        added.map_err(naming(&path))?;
    }
    remove_leftovers(folder);
    for (name, bytes) in files {
        place(&folder.join(name), bytes.as_ref())?;
    }
    Ok(())
}

/// Refuses a file that is written row by row and is no longer what the program wrote: another one, or with other bytes.
///
/// # Errors
/// [`OutputError::Changed`], or a file that cannot be read.
pub fn refuse_changed(path: &Path, file: &File, digest: Digest) -> Result<(), OutputError> {
    let changed = |how| {
        Err(OutputError::Changed {
            path: path.to_owned(),
            how,
        })
    };
    let own = file.try_clone().and_then(Handle::from_file);
    if !is_at(&own.map_err(naming(path))?, path) {
        return changed("was moved, replaced or deleted while the program wrote to it");
    }
    let read = File::open(path).and_then(|file| Digest::read(file, u64::MAX));
    match read.map_err(naming(path))? == digest {
        true => Ok(()),
        false => changed("was changed while the program wrote to it"),
    }
}

/// Deletes a file that may not be there.
pub(crate) fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(naming(path)(e)),
        _ => Ok(()),
    }
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
