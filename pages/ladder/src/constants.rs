//! The numbers of the element and of Bathe's scheme, changed one at a time: the record that `constants` writes.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::PathBuf;

/// What the property tests noticed.
#[derive(Serialize, Deserialize)]
pub struct ConstantsRecord {
    /// By which part of the largest number of its table each number was changed.
    pub change: f64,
    /// The property tests.
    pub tests: Vec<String>,
    /// Every number.
    pub numbers: Vec<Number>,
}

/// A number that was changed.
#[derive(Clone, Serialize, Deserialize)]
pub struct Number {
    /// The table that it stands in.
    pub table: String,
    /// The file of the table.
    pub file: String,
    /// Its place in the table, from one, row by row.
    pub place: usize,
    /// What the file has there.
    pub number: String,
    /// The tests that failed.
    pub caught_by: Vec<String>,
}

/// Where the record is.
pub fn path() -> PathBuf {
    records::root().join("pages/ladder/constants.json")
}

impl ConstantsRecord {
    /// Reads the record.
    ///
    /// # Errors
    /// When it is not there or not a record.
    pub fn load() -> Result<ConstantsRecord> {
        let text = fs::read_to_string(path()).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", path().display()))?;
        serde_json::from_str(&text).into_diagnostic()
    }
}
