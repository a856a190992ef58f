//! The program `looselink` of an earlier commit.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Builds the program of a commit in `target/baseline`, with the release profile of that commit.
///
/// # Errors
/// When the commit is not in the repository, as in a shallow clone, or cannot be built.
pub fn program(root: &Path, commit: &str) -> Result<PathBuf> {
    let folder = root.join("target/baseline");
    let sources = folder.join(commit);
    if !sources.exists() {
        let incomplete = folder.join("incomplete");
        if incomplete.exists() {
            std::fs::remove_dir_all(&incomplete).into_diagnostic()?;
        }
        std::fs::create_dir_all(&incomplete).into_diagnostic()?;
        let mut archive = Command::new("git")
            .arg("-C")
            .arg(root)
            .args(["archive", commit])
            .stdout(Stdio::piped())
            .spawn()
            .into_diagnostic()
            .wrap_err("cannot start git, which has the earlier state")?;
        let stream = archive.stdout.take().expect("the output is piped");
        let unpacked = Command::new("tar")
            .args(["-x", "-C"])
            .arg(&incomplete)
            .stdin(stream)
            .status()
            .into_diagnostic()?;
        if !archive.wait().into_diagnostic()?.success() || !unpacked.success() {
            return Err(miette!(
                help =
                    "a shallow clone has no earlier commits: `git fetch --unshallow` brings them",
                "commit {commit} is not in the repository"
            ));
        }
        std::fs::rename(&incomplete, &sources).into_diagnostic()?;
    }
    build(&sources, &folder.join("target"))
}

/// Builds `looselink` as users have it; the path is the one that Valgrind names.
///
/// # Errors
/// When it cannot be built.
pub fn build(sources: &Path, target: &Path) -> Result<PathBuf> {
    let built = Command::new("cargo")
        .args([
            "build",
            "--quiet",
            "--release",
            "--locked",
            "-p",
            "looselink-cli",
            "--target-dir",
        ])
        .arg(target)
        .current_dir(sources)
        .status()
        .into_diagnostic()?;
    match built.success() {
        true => target
            .join("release/looselink")
            .canonicalize()
            .into_diagnostic(),
        false => Err(miette!(
            "looselink cannot be built in {}",
            sources.display()
        )),
    }
}
