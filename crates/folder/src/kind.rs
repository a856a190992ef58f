//! What a folder can hold, and how a result is known that has no manifest.

use crate::claim::is_there;
use crate::manifest::Manifest;
use crate::read;
use std::path::Path;

/// A kind of result.
#[derive(Debug, Clone)]
pub struct Kind {
    /// What a folder holds, in words: "a run".
    pub name: &'static str,
    /// Names that its files can have. The first of them closes a result, is JSON and comes last: without that there is none.
    pub files: Vec<String>,
}

/// Results of earlier versions, which wrote no manifest: what they are, the file that closed them, and keys by which it is known.
const EARLIER: [(&str, &str, &[&str]); 4] = [
    (
        "a run",
        "summary.json",
        &["scene_hash", "status", "version"],
    ),
    ("a sweep", "sweep.json", &["sweep", "runs", "version"]),
    ("an ablation", "ablation.json", &["variants", "units"]),
    (
        "a study of precision",
        "precision.json",
        &["runs", "reference_warnings"],
    ),
];

/// The result of an earlier version that is in a folder: what it is.
pub(crate) fn earlier_kind(folder: &Path) -> Option<&'static str> {
    let mut known = EARLIER.iter();
    let found = known.find(|(_, file, keys)| closing(folder, file, keys).is_some());
    found.map(|(name, ..)| *name)
}

/// The file that closes a result, where a folder has it with these keys.
fn closing(folder: &Path, file: &str, keys: &[&str]) -> Option<serde_json::Value> {
    let bytes = read(&folder.join(file)).ok()?;
    let value: serde_json::Value = serde_json::from_slice(&bytes).ok()?;
    keys.iter()
        .all(|key| value.get(key).is_some())
        .then_some(value)
}

impl Kind {
    /// True where a folder holds a result that came to its end.
    pub(crate) fn is_whole(&self, folder: &Path) -> bool {
        let closing = closing(folder, &self.files[0], &[]);
        closing.is_some_and(|closing| closing.get("status").is_none_or(|s| s == "complete"))
    }

    /// What a folder holds of the program: by its manifest or, of an earlier version, which wrote none, by the closing file.
    pub(crate) fn held(&self, folder: &Path, mut manifest: Manifest) -> Manifest {
        if manifest.kind.is_none() && earlier_kind(folder) == Some(self.name) {
            let present = self
                .files
                .iter()
                .filter(|file| is_there(&folder.join(file)));
            manifest.files = present.map(|file| (file.clone(), None)).collect();
        }
        manifest
    }
}
