//! The answers of the tests: every question that a test asks, with its number, what is allowed, and why.

use crate::campaign::results;
use ladder::Answer;
use miette::{IntoDiagnostic, Result, ensure};
use records::{Journal, root};
use serde_json::Value;
use std::process::Command;

/// Runs all tests and collects their answers.
///
/// # Errors
/// A test that fails.
pub fn measure(journal: &Journal) -> Result<Value> {
    let answers = journal.item("all tests", || {
        let folder = root().join("target/answers");
        if folder.exists() {
            std::fs::remove_dir_all(&folder).into_diagnostic()?;
        }
        let mut command = Command::new(env!("CARGO"));
        command.args(["test", "--workspace", "--quiet"]);
        command.env(ladder::FOLDER, &folder).current_dir(root());
        // the profile of the tests, in a folder of its own
        command.env("CARGO_TARGET_DIR", root().join("target"));
        ensure!(
            command.status().into_diagnostic()?.success(),
            "a test fails"
        );
        Answer::read_all(&folder)
    })?;
    results(answers)
}
