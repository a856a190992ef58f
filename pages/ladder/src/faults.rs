//! Seeded faults: deliberate mistakes, applied one at a time, that the comparison has to catch. Variants: other forms of a
//! convention that both sides share, which must not change the results.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::root;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// A mistake or a variant in one place.
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
    /// Of a variant the tests that must still pass; a mistake has to be caught by any.
    #[serde(default)]
    pub tests: Vec<String>,
}

/// What became of a fault.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct FaultOutcome {
    /// Name of the fault.
    pub name: String,
    /// Tests that failed.
    pub caught_by: Vec<String>,
}

/// `verify/faults.toml`
#[derive(Deserialize)]
pub struct List {
    /// Mistakes.
    pub fault: Vec<Fault>,
    /// Variants, in the reference.
    pub variant: Vec<Fault>,
}

impl List {
    /// Mistakes, then variants.
    pub fn all(&self) -> impl Iterator<Item = &Fault> {
        self.fault.iter().chain(&self.variant)
    }
}

/// The list in `verify/faults.toml`.
pub fn list() -> Result<List> {
    let text = read(&root().join("verify/faults.toml"))?;
    toml::from_str(&text).into_diagnostic()
}

/// What the last run of all faults left in `verify/faults.json`.
pub fn outcomes() -> Result<Vec<FaultOutcome>> {
    let text = read(&root().join("verify/faults.json"))?;
    serde_json::from_str(&text).into_diagnostic()
}

/// Every fault and variant with what became of it; an error where one was not run.
pub fn judged() -> Result<Vec<(Fault, FaultOutcome)>> {
    let outcomes = outcomes()?;
    let pair = |fault: &Fault| {
        let outcome = outcomes.iter().find(|o| o.name == fault.name).cloned();
        let outcome = outcome.ok_or_else(|| miette!("fault `{}` has not been run", fault.name))?;
        Ok((fault.clone(), outcome))
    };
    list()?.all().map(pair).collect()
}

fn read(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path).into_diagnostic();
    text.wrap_err_with(|| format!("cannot read {}", path.display()))
}

impl Fault {
    /// True for what must not change the results.
    pub fn is_variant(&self) -> bool {
        !self.tests.is_empty()
    }

    /// True for a mistake in the reference.
    pub fn is_in_reference(&self) -> bool {
        self.file.starts_with("reference-cpp/")
    }

    /// The text of the file below `tree` with the mistake in it.
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
