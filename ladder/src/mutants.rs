//! What mutation testing found: the record that `mutate` writes, and the reasons why survivors live.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A mutation run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Seed of the draw.
    pub seed: u64,
    /// Mutants there are.
    pub possible: usize,
    /// Version of cargo-mutants.
    pub tool: String,
    /// Counts by source file.
    pub files: BTreeMap<String, Counts>,
    /// Mutants that no test noticed, as cargo-mutants names them.
    pub survivors: Vec<String>,
}

/// What became of the mutants of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// A test failed.
    pub caught: usize,
    /// The tests did not end.
    pub timeout: usize,
    /// No test noticed.
    pub survived: usize,
    /// Did not compile.
    pub unviable: usize,
}

impl Counts {
    /// Mutants that compiled.
    pub fn viable(self) -> usize {
        self.caught + self.timeout + self.survived
    }
}

/// The files of the record and of the reasons.
pub fn paths() -> [PathBuf; 2] {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    ["mutants.json", "survivors.toml"].map(|f| folder.join(f))
}

impl Record {
    /// The record of the last run.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read() -> Result<Record> {
        let [path, _] = paths();
        let text = fs::read_to_string(&path)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", path.display()))?;
        serde_json::from_str(&text).into_diagnostic()
    }

    /// All files together.
    pub fn total(&self) -> Counts {
        let add = |a: Counts, b: &Counts| Counts {
            caught: a.caught + b.caught,
            timeout: a.timeout + b.timeout,
            survived: a.survived + b.survived,
            unviable: a.unviable + b.unviable,
        };
        self.files.values().fold(Counts::default(), add)
    }

    /// This record with its survivors tried again, as `again` tells.
    pub fn revised(mut self, again: Record) -> Record {
        for (file, fresh) in &again.files {
            let counts = self.files.entry(file.clone()).or_default();
            counts.caught += fresh.caught;
            counts.timeout += fresh.timeout;
            counts.survived = fresh.survived;
        }
        self.survivors = again.survivors;
        self
    }

    /// Share of the viable mutants that a test noticed.
    pub fn caught(&self) -> f64 {
        let total = self.total();
        (total.caught + total.timeout) as f64 / total.viable() as f64
    }
}

/// Why each survivor lives, by its name.
///
/// # Errors
/// A file that cannot be read.
pub fn reasons() -> Result<BTreeMap<String, String>> {
    let [_, path] = paths();
    let text = fs::read_to_string(&path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    toml::from_str(&text).into_diagnostic()
}

#[cfg(test)]
mod tests {
    use super::{Counts, Record};

    #[test]
    fn survivors_that_are_caught_at_last_are_counted_as_caught() {
        let record = |caught, survived, survivors: &[&str]| {
            let counts = Counts {
                caught,
                survived,
                ..Counts::default()
            };
            Record {
                seed: 4,
                possible: 9,
                tool: String::new(),
                files: [("a".to_owned(), counts)].into(),
                survivors: survivors.iter().map(|s| (*s).to_owned()).collect(),
            }
        };
        let revised = record(5, 3, &["x", "y", "z"]).revised(record(2, 1, &["y"]));
        assert_eq!(revised, record(7, 1, &["y"]));
        assert_eq!(revised.caught(), 7.0 / 8.0);
    }
}
