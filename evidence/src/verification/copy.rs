//! A copy of the workspace that deliberate mistakes are put into, one at a time, and the tests that notice them.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::root;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A copy of the workspace with a build folder of its own.
#[derive(Debug)]
pub struct WorkspaceCopy {
    folder: PathBuf,
}

impl WorkspaceCopy {
    /// Copies what is under version control to `target/<name>`, where cargo never looks for a workspace of its own.
    ///
    /// # Errors
    /// Files that cannot be listed, read or written.
    pub fn new(name: &str) -> Result<WorkspaceCopy> {
        let copy = WorkspaceCopy {
            folder: root().join("target").join(name),
        };
        let listed = Command::new("git")
            .args(["ls-files", "-z", "--cached"])
            .args(["--others", "--exclude-standard"])
            .current_dir(root())
            .output()
            .into_diagnostic()
            .wrap_err("git lists the files to copy")?;
        let names = String::from_utf8(listed.stdout).into_diagnostic()?;
        for name in names.split('\0').filter(|name| !name.is_empty()) {
            let bytes = fs::read(root().join(name)).into_diagnostic()?;
            let to = copy.tree().join(name);
            if fs::read(&to).is_ok_and(|there| there == bytes) {
                continue;
            }
            if let Some(folder) = to.parent() {
                fs::create_dir_all(folder).into_diagnostic()?;
            }
            write(&to, &bytes)?;
        }
        Ok(copy)
    }

    /// The root of the copy.
    pub fn tree(&self) -> PathBuf {
        self.folder.join("tree")
    }

    /// Puts `text` in the place of a file, asks `tests`, and puts the file back.
    ///
    /// # Errors
    /// A file that cannot be read or written, or tests that did not run.
    pub fn with(
        &self,
        file: &str,
        text: &str,
        tests: impl FnOnce() -> Result<Vec<String>>,
    ) -> Result<Vec<String>> {
        let path = self.tree().join(file);
        let sound = fs::read(&path).into_diagnostic()?;
        write(&path, text.as_bytes())?;
        let failed = tests();
        write(&path, &sound)?;
        failed
    }

    /// Names of the tests that fail under `cargo test` with these arguments, of those whose names have one of the filters.
    ///
    /// # Errors
    /// Tests that do not compile or do not run.
    pub fn failing(&self, arguments: &[&str], filters: &[&str]) -> Result<Vec<String>> {
        let output = Command::new(env!("CARGO"))
            .args(["test", "--quiet"])
            .args(arguments)
            .args(["--", "--format", "pretty"])
            .args(filters)
            .env("CARGO_TARGET_DIR", self.folder.join("build"))
            .env("RUST_BACKTRACE", "0")
            // what is caught is caught by fresh cases, and leaves none behind
            .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1")
            .current_dir(self.tree())
            .output()
            .into_diagnostic()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let failed = text.lines().filter_map(|line| {
            let name = line.strip_prefix("test ")?.strip_suffix(" ... FAILED")?;
            Some(name.rsplit("::").next().unwrap_or(name).to_owned())
        });
        let failed: Vec<String> = failed.collect();
        if failed.is_empty() && !output.status.success() {
            let errors = String::from_utf8_lossy(&output.stderr);
            return Err(miette!("the tests did not run:\n{errors}"));
        }
        Ok(failed)
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let written = fs::write(path, bytes).into_diagnostic();
    written.wrap_err_with(|| format!("cannot write {}", path.display()))
}
