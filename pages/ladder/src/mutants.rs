//! What mutation testing found: the record that `mutate` writes, and why no test detects each survivor.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::ops::AddAssign;
use std::path::{Path, PathBuf};

/// What mutants are drawn from.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub enum Scope {
    /// The folders of the formulas.
    Kernels,
    /// All of the solver, with its command line.
    Solver,
}

impl Scope {
    /// All of them.
    pub const ALL: [Scope; 2] = [Scope::Kernels, Scope::Solver];

    /// Name of the record.
    pub fn name(self) -> &'static str {
        match self {
            Scope::Kernels => "mutation",
            Scope::Solver => "mutation-solver",
        }
    }

    /// File of the record.
    pub fn path(self) -> PathBuf {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        folder.join(format!("{}.json", self.name()))
    }

    /// How many mutants are drawn.
    pub fn count(self) -> usize {
        match self {
            Scope::Kernels => 500,
            Scope::Solver => 250,
        }
    }

    /// Title of the section with the record.
    pub fn title(self) -> &'static str {
        match self {
            Scope::Kernels => "Mutants of the kernels",
            Scope::Solver => "Mutants of the whole solver",
        }
    }

    /// Where its mutants are and which tests run.
    pub fn describe(self) -> &'static str {
        match self {
            Scope::Kernels => {
                "in the kernels (`src/link`, `src/contact`, `src/constraint`, `src/force`, `src/stepper`), with the tests of \
                 [tests/kernels.rs](tests/kernels.rs)"
            }
            Scope::Solver => {
                "in all of `src`, the studies and the command line, with all tests of these three packages and of \
                 `stability`"
            }
        }
    }

    /// Arguments that choose the files.
    pub fn files(self) -> &'static [&'static str] {
        match self {
            Scope::Kernels => &[
                "--package=looselink",
                "--file=src/link/**",
                "--file=src/contact/**",
                "--file=src/constraint/**",
                "--file=src/force/**",
                "--file=src/stepper/**",
            ],
            Scope::Solver => &[
                "--package=looselink",
                "--package=looselink-cli",
                "--package=studies",
                "--file=src/**",
                "--file=crates/cli/src/**",
                "--file=crates/studies/src/**",
            ],
        }
    }

    /// Arguments that choose the tests.
    pub fn tests(self) -> &'static [&'static str] {
        match self {
            Scope::Kernels => &["--cargo-arg=--test=kernels"],
            Scope::Solver => &["--test-package=looselink,looselink-cli,studies,stability"],
        }
    }
}

/// A mutation run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MutationRecord {
    /// Seed of the draw.
    pub seed: u64,
    /// Number of mutants from which those of this record were drawn.
    pub possible: usize,
    /// Version of cargo-mutants.
    pub tool: String,
    /// Counts by source file.
    pub files: BTreeMap<String, MutantCounts>,
    /// Mutants that no test noticed, as cargo-mutants names them.
    pub survivors: Vec<String>,
}

/// What became of the mutants of a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MutantCounts {
    /// A test failed.
    pub caught: usize,
    /// The tests did not end.
    pub timeout: usize,
    /// No test noticed.
    pub survived: usize,
    /// Did not compile.
    pub unviable: usize,
}

impl AddAssign for MutantCounts {
    fn add_assign(&mut self, more: MutantCounts) {
        self.caught += more.caught;
        self.timeout += more.timeout;
        self.survived += more.survived;
        self.unviable += more.unviable;
    }
}

impl MutantCounts {
    /// Mutants that compiled.
    pub fn viable(self) -> usize {
        self.caught + self.timeout + self.survived
    }
}

impl MutationRecord {
    /// The record of the last run.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(scope: Scope) -> Result<MutationRecord> {
        let path = scope.path();
        let text = fs::read_to_string(&path)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", path.display()))?;
        serde_json::from_str(&text).into_diagnostic()
    }

    /// The records of all scopes.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_all() -> Result<Vec<(Scope, MutationRecord)>> {
        let record = |scope: Scope| Ok((scope, MutationRecord::read(scope)?));
        Scope::ALL.into_iter().map(record).collect()
    }

    /// Counts by the folder or file below `src`.
    pub fn folders(&self) -> BTreeMap<String, MutantCounts> {
        let mut folders = BTreeMap::new();
        for (file, counts) in &self.files {
            let folder: Vec<&str> = file.split('/').take(2).collect();
            *folders.entry(folder.join("/")).or_default() += *counts;
        }
        folders
    }

    /// All files together.
    pub fn total(&self) -> MutantCounts {
        let mut total = MutantCounts::default();
        self.files.values().for_each(|counts| total += *counts);
        total
    }

    /// This record after the survivors `tried` were tested again, with `again` as the result.
    pub fn revised(mut self, tried: &[String], again: MutationRecord) -> MutationRecord {
        for (file, fresh) in &again.files {
            let counts = self.files.entry(file.clone()).or_default();
            counts.caught += fresh.caught;
            counts.timeout += fresh.timeout;
            counts.survived -= fresh.caught + fresh.timeout;
        }
        self.survivors.retain(|name| !tried.contains(name));
        self.survivors.extend(again.survivors);
        self.survivors.sort();
        self
    }

    /// Share of the viable mutants that a test noticed.
    pub fn caught(&self) -> f64 {
        let total = self.total();
        (total.caught + total.timeout) as f64 / total.viable() as f64
    }
}

/// Why no test detects each survivor, by its name.
///
/// # Errors
/// A file that cannot be read.
pub fn reasons() -> Result<BTreeMap<String, String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("survivors.toml");
    let text = fs::read_to_string(&path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    toml::from_str(&text).into_diagnostic()
}

#[cfg(test)]
mod tests {
    use super::{MutantCounts, MutationRecord};

    #[test]
    fn survivors_that_are_caught_at_last_are_counted_as_caught() {
        let record = |caught, survived, survivors: &[&str]| {
            let counts = MutantCounts {
                caught,
                survived,
                ..MutantCounts::default()
            };
            MutationRecord {
                seed: 4,
                possible: 9,
                tool: String::new(),
                files: [("a".to_owned(), counts)].into(),
                survivors: survivors.iter().map(|s| (*s).to_owned()).collect(),
            }
        };
        // z has a reason and is not tried again
        let tried = ["x", "y"].map(str::to_owned);
        let revised = record(5, 3, &["x", "y", "z"]).revised(&tried, record(1, 1, &["y"]));
        assert_eq!(revised, record(6, 2, &["y", "z"]));
        assert_eq!(revised.caught(), 6.0 / 8.0);
    }
}
