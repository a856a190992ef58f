//! Files that stand beside those of a result, such as its page.

use crate::claim::{refuse_another_kind, refuse_foreign, remove};
use crate::error::{OutputError, naming, naming_read};
use crate::kind::Kind;
use crate::lock::{opened, turn};
use crate::manifest::{MANIFEST, Manifest};
use crate::read;
use crate::replaced::forget;
use crate::temporary::{Temporary, remove_leftovers};
use std::io;
use std::path::Path;

/// As [`add_to`], whatever the folder holds.
///
/// # Errors
/// As [`add_to`].
pub fn add(
    folder: &Path,
    kind: &Kind,
    files: &[(&str, impl AsRef<[u8]>)],
) -> Result<(), OutputError> {
    add_to(folder, kind, files, || true).map(drop)
}

/// Puts files into a folder beside those that are there, such as pictures of a result: each is there as the program's already, or
/// not there. Several programs may do so at the same time. Where the file that closes a result is among them and changes, it is
/// away until all others are in their place, and others of the kind that are the program's are deleted. The result is whole then: one
/// that it has replaced is deleted. False where the files have become those of another result, and nothing is changed: `is_current` says
/// so while no result begins or ends.
///
/// # Errors
/// A file of somebody else; a file that cannot be written.
pub fn add_to(
    folder: &Path,
    kind: &Kind,
    files: &[(&str, impl AsRef<[u8]>)],
    is_current: impl Fn() -> bool,
) -> Result<bool, OutputError> {
    let names: Vec<String> = files.iter().map(|(name, _)| (*name).to_owned()).collect();
    let refuse = |held: &Manifest| {
        refuse_another_kind(folder, kind, held)?;
        refuse_foreign(folder, held, &names)
    };
    let _turn = turn(folder);
    if !is_current() {
        return Ok(false);
    }
    let held = kind.held(folder)?;
    refuse(&held)?;
    remove_leftovers(folder);
    // what finds no room, or no right to write, is refused before anything changes
    let ready = files
        .iter()
        .map(|(name, bytes)| Temporary::new(&folder.join(name), bytes.as_ref()));
    let ready = ready.collect::<io::Result<Vec<_>>>()?;
    let path = folder.join(MANIFEST);
    let new = Manifest::bytes(kind.name, &held.files)?;
    let (mut file, _) = opened(&path, Some(&new))?.expect("it was to be created");
    let mut manifest = Manifest::read(&mut file).map_err(naming_read(&path))?;
    refuse(&manifest)?;
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
    // those that are not listed, or with a digest that will no longer be theirs
    let new = |name: &&String| manifest.files.get(*name).is_none_or(Option::is_some);
    let new = names.iter().filter(new).map(|name| (name.clone(), None));
    let new: Vec<_> = new.collect();
    if !new.is_empty() {
        let added = manifest.add(&mut file, kind.name, new);
        added.map_err(naming(&path))?;
    }
    for ((name, _), temporary) in files.iter().zip(ready) {
        temporary.name(&folder.join(name))?;
    }
    if closes.is_some() {
        forget(folder, kind, &manifest)?;
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::add;
    use crate::{Folder, Kind};

    /// A page that joins a result after another one has claimed its folder goes with that result.
    #[test]
    fn what_joins_a_result_goes_with_it() {
        let kind = || Kind {
            name: "a run",
            files: ["summary.json", "view.html"].map(str::to_owned).to_vec(),
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        for round in 0..3 {
            let mut claimed = Folder::claim(path, kind(), true).unwrap();
            if round > 0 {
                add(path, &kind(), &[("view.html", "a page")]).unwrap();
            }
            claimed.begin(["summary.json".to_owned()]).unwrap();
            assert!(!path.join("view.html").exists(), "round {round}");
            claimed.replace("summary.json", b"{}").unwrap();
        }
    }
}
