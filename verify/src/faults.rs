//! Seeded faults: deliberate mistakes, applied one at a time, that the comparison has to catch.

use ladder::seeded::root;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// A mistake in one place.
#[derive(Debug, Clone, Deserialize)]
pub struct Fault {
    /// What it does, in a few words.
    pub name: String,
    /// File, from the root of the workspace.
    pub file: String,
    /// Text that stands in the file once.
    pub find: String,
    /// What stands there instead.
    pub replace: String,
}

/// What became of a fault.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the fault.
    pub name: String,
    /// Tests that failed.
    pub caught_by: Vec<String>,
}

#[derive(Deserialize)]
struct List {
    fault: Vec<Fault>,
}

/// The list in `verify/faults.toml`.
///
/// # Errors
/// A list that cannot be read.
pub fn list() -> Result<Vec<Fault>> {
    let text = read(&root().join("verify/faults.toml"))?;
    Ok(toml::from_str::<List>(&text).into_diagnostic()?.fault)
}

/// What the last run of all faults left in `verify/faults.json`.
///
/// # Errors
/// A file that cannot be read.
pub fn outcomes() -> Result<Vec<Outcome>> {
    let text = read(&root().join("verify/faults.json"))?;
    serde_json::from_str(&text).into_diagnostic()
}

fn read(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path).into_diagnostic();
    text.wrap_err_with(|| format!("cannot read {}", path.display()))
}

impl Fault {
    /// True for a mistake in the reference.
    pub fn is_in_reference(&self) -> bool {
        self.file.starts_with("reference-cpp/")
    }

    /// The text of the file below `tree` with the mistake in it.
    ///
    /// # Errors
    /// When the place is not there exactly once.
    pub fn applied(&self, tree: &Path) -> Result<String> {
        let text = read(&tree.join(&self.file))?;
        match text.matches(&self.find).count() {
            1 => Ok(text.replacen(&self.find, &self.replace, 1)),
            n => Err(miette!(
                "fault `{}`: its place occurs {n} times in {}",
                self.name,
                self.file
            )),
        }
    }
}
