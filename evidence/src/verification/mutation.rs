//! Mutation testing: mutants are drawn by a fixed seed, and cargo-mutants tries them in parts, each with the tests of its scope.

use crate::campaign::results;
use crate::worktree;
use miette::{IntoDiagnostic, Result, WrapErr, ensure};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use records::{Journal, root};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::ops::AddAssign;
use std::path::Path;
use std::process::Command;

/// Seed of the draw.
const SEED: u64 = 4;
/// Mutants a part.
const PART: usize = 25;
/// Seconds after which tests of a mutant count as endless; all tests take some two minutes.
const TIMEOUT: &str = "--timeout=400";

/// What mutants are drawn from.
pub struct Scope {
    /// Name of the campaign.
    pub name: &'static str,
    /// How many mutants are drawn.
    count: usize,
    /// Arguments that choose the files, with spaces between them.
    files: &'static str,
    /// Argument that chooses the tests.
    tests: &'static str,
}

/// The folders of the formulas.
pub const KERNELS: Scope = Scope {
    name: "mutation-kernels",
    count: 500,
    files: "--package=looselink --file=src/link/** --file=src/contact/** --file=src/constraint/** \
            --file=src/force/** --file=src/stepper/**",
    tests: "--cargo-arg=--test=kernels",
};

/// All of the solver, with its command line.
pub const SOLVER: Scope = Scope {
    name: "mutation-solver",
    count: 250,
    files: "--package=looselink --package=looselink-cli --package=looselink-studies \
            --file=src/** --file=crates/cli/src/** --file=crates/studies/src/**",
    tests: "--test-package=looselink,looselink-cli,looselink-studies,evidence",
};

/// A mutation run.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Mutants {
    /// Number of mutants from which those of this record were drawn.
    pub possible: usize,
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

    /// Share of them that a test noticed.
    pub fn caught(self) -> f64 {
        (self.caught + self.timeout) as f64 / self.viable() as f64
    }
}

/// Draws and tries mutants.
///
/// # Errors
/// When cargo-mutants is missing, or has no verdict on a mutant.
pub fn measure(scope: &Scope, journal: &Journal) -> Result<Value> {
    let tree = worktree::copy("mutation")?;
    let mut drawn = journal.item("all", || list(scope, &tree))?;
    let mut found = Mutants {
        possible: drawn.len(),
        ..Mutants::default()
    };
    drawn.shuffle(&mut ChaCha8Rng::seed_from_u64(SEED));
    drawn.truncate(scope.count);
    for (index, part) in drawn.chunks(PART).enumerate() {
        let tried = journal.item(&format!("part {index}"), || test(scope, &tree, part))?;
        // cargo-mutants 27.1 tests some deleted fields that no expression names
        for (name, verdict) in tried.into_iter().filter(|(name, _)| part.contains(name)) {
            let file = name.split(':').next().unwrap_or(&name).to_owned();
            let counts = found.files.entry(file).or_default();
            match &verdict[..] {
                "caught" => counts.caught += 1,
                "timeout" => counts.timeout += 1,
                "unviable" => counts.unviable += 1,
                _ => {
                    counts.survived += 1;
                    found.survivors.push(name);
                }
            }
        }
    }
    found.survivors.sort();
    let judged = found.files.values().map(|c| c.viable() + c.unviable);
    let judged: usize = judged.sum();
    ensure!(
        judged == drawn.len(),
        "{} mutants were tried, {judged} have a verdict",
        drawn.len()
    );
    results(found)
}

/// Has cargo-mutants try these mutants in the copy; their names and its verdicts.
fn test(scope: &Scope, tree: &Path, drawn: &[String]) -> Result<Vec<(String, String)>> {
    let output = root().join("target/mutation");
    let mut command = Command::new("cargo");
    command.arg("mutants").current_dir(tree);
    command
        .args(scope.files.split(' '))
        .args(["--in-place", TIMEOUT]);
    command.args(["--profile=mutants", "--test-tool=nextest"]);
    command.env("NEXTEST_PROFILE", "mutants");
    command.env("CARGO_TARGET_DIR", output.join("build"));
    // what is caught is caught by fresh cases, and leaves none behind
    command.env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1");
    command.arg("--output").arg(&output);
    for name in drawn {
        let exactly = format!("^{}$", regex::escape(name));
        command.arg("--re").arg(exactly);
    }
    // for the build as well as for the run
    command.arg(scope.tests);
    // its exit code says whether there are survivors; what became of each mutant stands in its files
    let started = command.status().into_diagnostic();
    started.wrap_err("cargo-mutants cannot be started")?;
    let mut tried = Vec::new();
    for verdict in ["caught", "timeout", "missed", "unviable"] {
        let path = output.join(format!("mutants.out/{verdict}.txt"));
        let text = fs::read_to_string(&path).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", path.display()))?;
        tried.extend(
            text.lines()
                .map(|name| (name.to_owned(), verdict.to_owned())),
        );
    }
    Ok(tried)
}

/// Names of all mutants of a scope.
fn list(scope: &Scope, tree: &Path) -> Result<Vec<String>> {
    let mut command = Command::new("cargo");
    command
        .args(["mutants", "--list"])
        .args(scope.files.split(' '));
    let listed = command.current_dir(tree).output().into_diagnostic()?;
    ensure!(
        listed.status.success(),
        "cargo mutants fails: {}",
        String::from_utf8_lossy(&listed.stderr)
    );
    let text = String::from_utf8(listed.stdout).into_diagnostic()?;
    Ok(text.lines().map(str::to_owned).collect())
}
