//! Files that stand beside those of a result, such as its page.

use crate::claim::{refuse_foreign, remove};
use crate::digest::Digest;
use crate::error::{OutputError, naming};
use crate::kind::Kind;
use crate::manifest::{MANIFEST, Manifest};
use crate::temporary::{Temporary, remove_leftovers};
use crate::{open, read};
use std::fs::OpenOptions;
use std::io;
use std::path::Path;

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
    let names: Vec<String> = files.iter().map(|(name, _)| (*name).to_owned()).collect();
    let known = Manifest::of(folder)?.unwrap_or_default();
    refuse_foreign(folder, &kind.held(folder, known), &names)?;
    remove_leftovers(folder);
    // what finds no room, or no right to write, is refused before anything changes
    let ready = files
        .iter()
        .map(|(_, bytes)| Temporary::new(folder, bytes.as_ref()));
    let ready = ready.collect::<io::Result<Vec<_>>>()?;
    let path = folder.join(MANIFEST);
    let mut options = OpenOptions::new();
    let mut file = open(&path, options.read(true).append(true).create(true))?;
    let manifest = Manifest::read(&mut file).map_err(naming(&path))?;
    let is_new = manifest.kind.is_none();
    let mut manifest = kind.held(folder, manifest);
    refuse_foreign(folder, &manifest, &names)?;
    let closing = folder.join(&kind.files[0]);
    let closes = files.iter().find(|(name, _)| *name == kind.files[0]);
    let changes = |(_, bytes): &&(&str, _)| {
        let bytes: &[u8] = AsRef::as_ref(bytes);
        read(&closing).is_ok_and(|old| old != bytes)
    };
    if closes.is_some_and(|file| changes(&file)) {
        let stale = kind.files.iter().filter(|name| !names.contains(name));
        let stale = stale.filter(|name| manifest.files.contains_key(*name));
        let stale = stale.map(|name| folder.join(name));
        std::iter::once(closing.clone())
            .chain(stale)
            .try_for_each(|path| remove(&path))?;
    }
    let mut new = Vec::new();
    for name in manifest.files.keys().filter(|_| is_new) {
        // from now on a change of what an earlier version wrote is known, too
        let bytes = read(&folder.join(name)).map_err(naming(&folder.join(name)))?;
        new.push((name.clone(), Some(Digest::of(&bytes))));
    }
    let unlisted = names
        .iter()
        .filter(|name| !manifest.files.contains_key(*name));
    new.extend(unlisted.map(|name| (name.clone(), None)));
    if is_new || !new.is_empty() {
        let added = manifest.add(&mut file, kind.name, new);
        added.map_err(naming(&path))?;
    }
    for ((name, _), temporary) in files.iter().zip(ready) {
        temporary.name(&folder.join(name))?;
    }
    Ok(())
}
