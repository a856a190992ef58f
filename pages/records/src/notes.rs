//! What a page says of the state of its records.
//!
//! Beside each claim stands a pair of comments, `<!-- record: name -->` and `<!-- /record -->`, and between them, when the
//! record is not of the present sources, a note that says so.

use crate::digest::Tree;
use crate::registry::{CampaignRecord, RecordRegistry};
use crate::state::{RecordState, reported, state};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

const OPENS: &str = "<!-- record: ";
const CLOSES: &str = "<!-- /record -->\n";

/// The place of a note, for the program that writes the page; the note comes with
/// [`RunningCampaign::finish`](crate::RunningCampaign::finish) or [`write_notes`].
pub fn place(name: &str) -> String {
    format!("{OPENS}{name} -->\n{CLOSES}")
}

/// Files that a note names; of more of them it names the folders.
const NAMED: usize = 4;

/// The lines between the comments.
fn note(record: &CampaignRecord, state: &RecordState) -> String {
    let CampaignRecord { claim, command, .. } = record;
    let what = match state {
        RecordState::Current => return String::new(),
        RecordState::Unknown => "**Recorded with an unknown earlier state of the code.** No digest of the sources was kept."
            .to_owned(),
        RecordState::Outdated(files) => {
            let named: BTreeSet<&str> = match files.len() <= NAMED {
                true => files.iter().map(String::as_str).collect(),
                false => files.iter().map(|file| folder(file)).collect(),
            };
            let named: Vec<String> = named.iter().map(|name| format!("`{name}`")).collect();
            format!(
                "**Recorded with an earlier state of the code.** Changed since then: {}.",
                named.join(", ")
            )
        }
    };
    format!("> {what} This concerns {claim}; `{command}` records it again.\n")
}

fn folder(file: &str) -> &str {
    file.rsplit_once('/').map_or(file, |(folder, _)| folder)
}

/// The notes of a page by the names of their records.
fn read<'p>(page: &str, text: &'p str) -> Result<Vec<(&'p str, &'p str)>> {
    let mut found = Vec::new();
    for part in text.split(OPENS).skip(1) {
        let (name, rest) = part
            .split_once(" -->\n")
            .ok_or_else(|| miette!("{page}: a record without a name"))?;
        let (note, _) = rest
            .split_once(CLOSES)
            .ok_or_else(|| miette!("{page}: the note of record {name} has no end"))?;
        found.push((name, note));
    }
    Ok(found)
}

/// The page with other notes.
fn replaced(page: &str, text: &str, notes: &BTreeMap<&str, String>) -> Result<String> {
    let mut out = text.to_owned();
    for (name, old) in read(page, text)? {
        if let Some(new) = notes.get(name) {
            let whole = |note: &str| format!("{OPENS}{name} -->\n{note}{CLOSES}");
            out = out.replace(&whole(old), &whole(new));
        }
    }
    Ok(out)
}

/// What is to be said.
struct Present {
    registry: RecordRegistry,
    states: BTreeMap<String, RecordState>,
}

impl Present {
    fn of(root: &Path) -> Result<Present> {
        let registry = RecordRegistry::read(root)?;
        let tree = Tree::new(root);
        let mut states = BTreeMap::new();
        for name in registry.records.keys() {
            states.insert(name.clone(), state(&registry, &tree, root, name)?);
        }
        Ok(Present { registry, states })
    }

    /// The notes by page.
    fn notes(&self) -> BTreeMap<&str, BTreeMap<&str, String>> {
        let mut pages: BTreeMap<&str, BTreeMap<&str, String>> = BTreeMap::new();
        for (name, record) in &self.registry.records {
            let notes = pages.entry(&record.page).or_default();
            notes.insert(name, note(record, &self.states[name]));
        }
        pages
    }
}

fn open(root: &Path, page: &str) -> Result<String> {
    let text = fs::read_to_string(root.join(page)).into_diagnostic();
    text.wrap_err_with(|| format!("cannot read {page}"))
}

/// Brings the notes of all pages up to date.
///
/// # Errors
/// A page that cannot be read or written.
pub fn write_notes(root: &Path) -> Result<()> {
    let present = Present::of(root)?;
    for (page, notes) in present.notes() {
        let text = open(root, page)?;
        let new = replaced(page, &text, &notes)?;
        if new != text {
            fs::write(root.join(page), new)
                .into_diagnostic()
                .wrap_err_with(|| format!("cannot write {page}"))?;
        }
    }
    Ok(())
}

/// What the gate finds.
#[derive(Debug, Default)]
pub struct Findings {
    /// A line for each record that is not of the present sources. It is no failure.
    pub outdated: Vec<String>,
    /// Pages that do not say so, or say so without reason.
    pub failures: Vec<String>,
}

/// Compares the notes of all pages with the states of their records.
///
/// # Errors
/// A page or a source that cannot be read.
pub fn check(root: &Path) -> Result<Findings> {
    let present = Present::of(root)?;
    let mut findings = Findings::default();
    for (name, record) in &present.registry.records {
        findings
            .outdated
            .extend(reported(record, &present.states[name]));
    }
    for (page, mut notes) in present.notes() {
        let text = open(root, page)?;
        for (name, said) in read(page, &text)? {
            let failure = match notes.remove(name) {
                None => format!("{page} has a note of record {name} too many"),
                Some(note) if note == said => continue,
                Some(note) if note.is_empty() => {
                    format!("{page} says that record {name} is of an earlier state; it is current")
                }
                Some(_) => format!("{page} does not say of which state record {name} is"),
            };
            findings.failures.push(failure);
        }
        for name in notes.keys() {
            findings
                .failures
                .push(format!("{page} has no place for the note of record {name}"));
        }
    }
    Ok(findings)
}
