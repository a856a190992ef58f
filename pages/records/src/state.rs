//! Whether a record is of the present sources.

use crate::digest::{Digests, Tree};
use crate::notes;
use crate::registry::{CampaignRecord, RecordRegistry};
use miette::{IntoDiagnostic, Result, WrapErr};
use std::fs;
use std::path::{Path, PathBuf};

/// What a record is to the present sources.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum RecordState {
    /// Made from them.
    Current,
    /// Made from others: the files that have changed since then, have come or have gone.
    Outdated(Vec<String>),
    /// It carries no digests.
    Unknown,
}

/// A campaign under way. The digests are those of its start: sources that change while it runs outdate what it finds.
#[must_use = "a campaign that does not finish leaves the earlier digests"]
pub struct RunningCampaign {
    root: PathBuf,
    name: String,
    digests: Digests,
}

/// The root of the workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Where the digests of a record are kept.
fn path(root: &Path, name: &str) -> PathBuf {
    root.join(format!("pages/records/state/{name}.json"))
}

/// Digests of what a record depends on.
///
/// # Errors
/// A record that is not in the table, sources that are not there or cannot be read.
pub fn digests(root: &Path, name: &str) -> Result<Digests> {
    let registry = RecordRegistry::read(root)?;
    let sources = registry.sources(registry.record(name)?)?;
    Tree::new(root)
        .digests(&sources)
        .wrap_err_with(|| format!("sources of record {name}"))
}

impl RunningCampaign {
    /// Begins the campaign that makes a record.
    ///
    /// # Errors
    /// Those of [`digests`].
    pub fn begin(name: &str) -> Result<RunningCampaign> {
        RunningCampaign::begin_in(&root(), name)
    }

    /// The same below another root.
    ///
    /// # Errors
    /// Those of [`digests`].
    pub fn begin_in(root: &Path, name: &str) -> Result<RunningCampaign> {
        Ok(RunningCampaign {
            root: root.to_owned(),
            name: name.to_owned(),
            digests: digests(root, name)?,
        })
    }

    /// Keeps the digests with the record, which has been written, and brings the notes of all pages up to date. A run that
    /// has made only a part of the record anew does not call it.
    ///
    /// # Errors
    /// A file that cannot be written, a page without the place of its note.
    pub fn finish(self) -> Result<()> {
        let path = path(&self.root, &self.name);
        let text = serde_json::to_string_pretty(&self.digests).into_diagnostic()?;
        fs::create_dir_all(path.with_file_name("")).into_diagnostic()?;
        fs::write(&path, text + "\n")
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))?;
        notes::write_notes(&self.root)
    }
}

/// The state of a record.
///
/// # Errors
/// Sources that cannot be read, digests that are none.
pub fn state(
    registry: &RecordRegistry,
    tree: &Tree,
    root: &Path,
    name: &str,
) -> Result<RecordState> {
    let path = path(root, name);
    if !path.exists() {
        return Ok(RecordState::Unknown);
    }
    let text = fs::read_to_string(&path).into_diagnostic()?;
    let then: Digests = serde_json::from_str(&text)
        .into_diagnostic()
        .wrap_err_with(|| path.display().to_string())?;
    let sources = registry.sources(registry.record(name)?)?;
    let now = tree
        .digests(&sources)
        .wrap_err_with(|| format!("sources of record {name}"))?;
    let mut changed: Vec<String> = then
        .iter()
        .filter(|(file, digest)| now.get(*file) != Some(digest))
        .map(|(file, _)| file.clone())
        .collect();
    changed.extend(now.into_keys().filter(|file| !then.contains_key(file)));
    changed.sort();
    Ok(match changed.is_empty() {
        true => RecordState::Current,
        false => RecordState::Outdated(changed),
    })
}

/// Files that a line of the gate names; their number tells of the others.
const NAMED: usize = 6;

/// What the gate says of a record; nothing of one that is current.
pub fn reported(record: &CampaignRecord, state: &RecordState) -> Option<String> {
    let what = match state {
        RecordState::Current => return None,
        RecordState::Unknown => "an unknown earlier state".to_owned(),
        RecordState::Outdated(files) => {
            let mut named = files[..files.len().min(NAMED)].join(", ");
            if files.len() > NAMED {
                named += &format!(" and {} more files", files.len() - NAMED);
            }
            format!("an earlier state: {named} changed")
        }
    };
    let CampaignRecord {
        file, page, claim, ..
    } = record;
    Some(format!("{file} is of {what}; {page}, {claim}"))
}
