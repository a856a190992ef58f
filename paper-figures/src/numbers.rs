//! Every number that is printed in a figure or a table, by name.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

/// Named numbers in SI units.
#[derive(Default)]
pub struct Numbers(Map<String, Value>);

impl Numbers {
    /// Keeps a number under a name and hands it back; a number that is not finite is kept as null.
    pub fn put(&mut self, name: impl Into<String>, value: f64) -> f64 {
        self.0.insert(name.into(), Value::from(value));
        value
    }

    /// Keeps anything else, such as the library's report of a run.
    pub fn put_value(&mut self, name: impl Into<String>, value: Value) {
        self.0.insert(name.into(), value);
    }

    /// Writes all of them as one JSON object.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(&self.0).into_diagnostic()?;
        fs::write(path, text + "\n")
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))
    }
}
