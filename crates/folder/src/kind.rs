//! What a folder can hold, and how a result is known that has no manifest.

use crate::claim::is_there;
use crate::digest::Digest;
use crate::manifest::Manifest;
use crate::read;
use std::fs::File;
use std::io;
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
fn earlier_kind(folder: &Path) -> Option<&'static str> {
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
        // that of a sweep counts the runs by status
        let status = |closing: serde_json::Value| closing["status"].as_str().map(str::to_owned);
        closing.is_some_and(|closing| status(closing).is_none_or(|status| status == "complete"))
    }

    /// What a folder holds of the program: what its manifest lists. Without a manifest it is the result of an earlier version, known by
    /// the file that closes it. A manifest that lists nothing is no sign of an earlier version, which had none.
    pub(crate) fn held(&self, folder: &Path) -> io::Result<Manifest> {
        if let Some(manifest) = Manifest::of(folder)? {
            return Ok(manifest);
        }
        let kind = earlier_kind(folder);
        let mut files = self.files.clone();
        files.retain(|file| kind == Some(self.name) && is_there(&folder.join(file)));
        // from now on a change of them is known, too
        let digest = |file: &String| {
            let path = Some(folder.join(file)).filter(|path| path.is_file())?;
            Digest::read(File::open(path).ok()?, u64::MAX).ok()
        };
        let files = files.into_iter().map(|file| {
            let digest = digest(&file);
            (file, digest)
        });
        Ok(Manifest {
            kind: kind.map(str::to_owned),
            files: files.collect(),
            ..Manifest::default()
        })
    }
}
