//! Seeded faults: deliberate mistakes, applied one at a time, that the comparison has to catch. Variants: other forms of a
//! convention that both sides share, which must not change the results.

use crate::campaign::results;
use crate::worktree;
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use records::{Journal, root};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Tests that take seconds, and those that take a minute and are asked only when the first catch nothing.
const STAGES: [&[&str]; 2] = [
    &[
        "parts",
        "every_channel",
        "motion_of_case_1",
        "motion_of_scene_everything",
    ],
    &["impacts", "one_element"],
];

/// A mistake or a variant in one place.
#[derive(Debug, Clone, Serialize, Deserialize)]
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
    /// What was changed.
    pub fault: Fault,
    /// Tests that failed.
    pub caught_by: Vec<String>,
}

/// `verify/faults.toml`
#[derive(Deserialize)]
struct List {
    fault: Vec<Fault>,
    variant: Vec<Fault>,
}

/// The faults and variants in `verify/faults.toml`.
///
/// # Errors
/// A file that cannot be read.
pub fn list() -> Result<Vec<Fault>> {
    let text = read(&root().join("verify/faults.toml"))?;
    let List { fault, variant } = toml::from_str(&text).into_diagnostic()?;
    Ok([fault, variant].concat())
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
    ///
    /// # Errors
    /// A file that cannot be read or in which the place does not stand exactly once.
    pub fn applied(&self, tree: &Path) -> Result<String> {
        let text = read(&tree.join(&self.file))?;
        let places = text.matches(&self.find).count();
        let (name, file) = (&self.name, &self.file);
        ensure!(
            places == 1,
            "fault `{name}`: its place occurs {places} times in {file}"
        );
        Ok(text.replacen(&self.find, &self.replace, 1))
    }
}

impl FaultOutcome {
    /// True of a mistake that a test noticed, and of a variant that none did.
    pub fn is_right(&self) -> bool {
        self.caught_by.is_empty() == self.fault.is_variant()
    }
}

/// Applies every fault and variant to a copy of the workspace, one at a time, and asks the tests.
///
/// # Errors
/// Tests that fail without a fault; a fault that is not caught; a variant that changes results.
pub fn measure(journal: &Journal) -> Result<Value> {
    let tree = worktree::copy("faults")?;
    let faults = list()?;
    let of_variants = faults.iter().flat_map(|fault| &fault.tests);
    let filters = STAGES.concat().into_iter();
    for filter in filters
        .chain(of_variants.map(String::as_str))
        .collect::<BTreeSet<&str>>()
    {
        let sound = || Ok(failing(&tree, &[filter])?.join(", "));
        let failed = journal.item(&format!("{filter}, without a fault"), sound)?;
        ensure!(
            failed.is_empty(),
            "without a fault these tests fail: {failed}"
        );
    }
    let seed = |fault: Fault| journal.item(&fault.name.clone(), || seed(&tree, fault));
    let outcomes = faults.into_iter().map(seed).collect::<Result<Vec<_>>>()?;
    let wrong = outcomes.iter().filter(|o| !o.is_right());
    let wrong: Vec<&str> = wrong.map(|o| o.fault.name.as_str()).collect();
    ensure!(
        wrong.is_empty(),
        "not caught, or variants that change results: {}",
        wrong.join("; ")
    );
    results(outcomes)
}

/// Puts a fault in, asks the tests, takes it out.
fn seed(tree: &Path, fault: Fault) -> Result<FaultOutcome> {
    let path = tree.join(&fault.file);
    let sound = read(&path)?;
    fs::write(&path, fault.applied(tree)?).into_diagnostic()?;
    let own: Vec<&str> = fault.tests.iter().map(String::as_str).collect();
    let stages = match fault.is_variant() {
        true => vec![&own[..]],
        false => STAGES.to_vec(),
    };
    let mut asked = stages.into_iter().map(|filters| failing(tree, filters));
    // the first stage in which a test fails, or in which the tests do not run
    let caught = asked.find(|failed| !matches!(failed, Ok(none) if none.is_empty()));
    fs::write(&path, sound).into_diagnostic()?;
    let caught_by = caught.unwrap_or(Ok(Vec::new()));
    let caught_by = caught_by.wrap_err_with(|| fault.name.clone())?;
    Ok(FaultOutcome { fault, caught_by })
}

/// Names of the tests of the comparison that fail, of those whose names have one of the filters.
///
/// # Errors
/// Tests that do not compile or do not run; filters that none has.
fn failing(tree: &Path, filters: &[&str]) -> Result<Vec<String>> {
    // many builds, short tests: little optimisation
    let output = Command::new(env!("CARGO"))
        .args(["test", "--quiet", "--profile", "mutants"])
        .args(["-p", "verify", "--test", "agreement"])
        .args(["--", "--format", "pretty"])
        .args(filters)
        .env("CARGO_TARGET_DIR", tree.with_file_name("build"))
        .env("RUST_BACKTRACE", "0")
        // where answers of tests are kept, if there is such a folder
        .env_remove("LOOSELINK_LADDER")
        .current_dir(tree)
        .output()
        .into_diagnostic()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let failed = text.lines().filter_map(|line| {
        let name = line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?;
        Some(name.rsplit("::").next().unwrap_or(name).to_owned())
    });
    let failed: Vec<String> = failed.collect();
    ensure!(
        !text.contains("\nrunning 0 tests"),
        "no test is called {}",
        filters.join(" or ")
    );
    if failed.is_empty() && !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("the tests did not run:\n{errors}"));
    }
    Ok(failed)
}

#[cfg(test)]
mod tests {
    use super::list;
    use records::root;

    /// The comparison is worth what it catches; fewer faults than these would say little.
    const FEWEST: usize = 50;

    #[test]
    fn seeded_faults_fit_the_code() {
        let list = list().unwrap();
        for reference in [false, true] {
            let mistakes = list.iter().filter(|f| !f.is_variant());
            let side = mistakes.filter(|f| f.is_in_reference() == reference);
            assert!(side.count() >= FEWEST / 3, "both sides have faults");
        }
        for fault in &list {
            let changed = fault.applied(&root()).unwrap();
            assert!(changed.contains(&fault.replace), "{}", fault.name);
        }
        let mistakes = list.iter().filter(|f| !f.is_variant()).count();
        assert!(mistakes >= FEWEST, "{mistakes} faults");
    }
}
