//! Campaigns run in a worktree of one commit, so that their results belong to it whatever happens to the files meanwhile.

use crate::campaign::Campaign;
use crate::output;
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use records::{Journal, Origin, Record, root};
use serde_json::Value;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs campaigns at a commit, or at the one that is checked out; with `resume` those that were interrupted, at theirs, whose
/// finished items are kept.
///
/// # Errors
/// Changes that are not committed, a commit that does not compile, a campaign that fails.
pub fn record(campaigns: &[&Campaign], at: Option<&str>, resume: bool) -> Result<()> {
    let folder = root().join("target/evidence");
    let begun = folder.join("interrupted");
    let hash = |name: &str| git(&["rev-parse", "--short=12", "--verify", name]);
    let commit = match at {
        Some(name) => hash(&format!("{name}^{{commit}}"))?,
        None if resume => fs::read_to_string(&begun)
            .into_diagnostic()
            .wrap_err("no campaign was interrupted")?,
        None => {
            let changes = git(&["status", "--porcelain"])?;
            ensure!(
                changes.is_empty(),
                help = "results belong to a commit: commit the changes first",
                "these files are not as the commit has them:\n{changes}"
            );
            hash("HEAD")?
        }
    };
    fs::create_dir_all(&folder).into_diagnostic()?;
    // the worktree is one
    let lock = File::create(folder.join("lock")).into_diagnostic()?;
    let free = lock.try_lock();
    free.map_err(|_| miette!("another `record` is at work in target/evidence"))?;
    // what another commit has finished is nothing of this one
    let journals = folder.join(&commit);
    fs::create_dir_all(&journals).into_diagnostic()?;
    let tree = folder.join("tree");
    check_out(&tree, &commit)?;
    fs::write(&begun, &commit).into_diagnostic()?;
    for campaign in campaigns {
        eprintln!("{}: {} min at most", campaign.name, campaign.minutes);
        let mut command = Command::new("cargo");
        command.args([
            "run",
            "--release",
            "--quiet",
            "-p",
            "evidence",
            "--",
            "measure",
        ]);
        command.arg(campaign.name).arg(&commit);
        command.arg(journals.join(format!("{}.jsonl", campaign.name)));
        command.arg(output::path(&root(), campaign.name));
        if resume {
            command.arg("--resume");
        }
        command.env("CARGO_TARGET_DIR", folder.join("build"));
        let status = command.current_dir(&tree).status().into_diagnostic()?;
        ensure!(
            status.success(),
            help = "`--resume` continues it",
            "campaign {} failed",
            campaign.name
        );
    }
    fs::remove_file(&begun).into_diagnostic()
}

/// Measures in this process, which belongs to `commit`, and writes the record.
///
/// # Errors
/// Those of the campaign.
pub fn measure(
    campaign: &Campaign,
    commit: &str,
    journal: &Path,
    path: &Path,
    resume: bool,
) -> Result<()> {
    let journal = Journal::open(journal, resume)?;
    let results: Value = (campaign.measure)(&journal)?;
    let origin = Origin {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: commit.to_owned(),
        date: said(Command::new("date").args(["-u", "+%F"]))?,
        machine: studies::machine::machine().processor,
        seeds: campaign.seeds.to_owned(),
        seconds: Some(journal.seconds().round()),
    };
    Record { origin, results }.write(path)
}

/// A copy of this workspace at its commit, in `target/<name>/tree`: a worktree of its own, which changes to it do not leave.
///
/// # Errors
/// A folder that cannot be written.
pub fn copy(name: &str) -> Result<PathBuf> {
    let tree = root().join("target").join(name).join("tree");
    check_out(&tree, &git(&["rev-parse", "HEAD"])?)?;
    Ok(tree)
}

/// A worktree of the commit in this folder; one that is there is brought to it.
fn check_out(tree: &Path, commit: &str) -> Result<()> {
    let shown = tree.display().to_string();
    match tree.join(".git").exists() {
        true => git(&[
            "-C", &shown, "checkout", "--quiet", "--detach", "--force", commit,
        ]),
        false => {
            git(&["worktree", "prune"])?;
            git(&["worktree", "add", "--quiet", "--detach", &shown, commit])
        }
    }
    .map(drop)
}

fn git(arguments: &[&str]) -> Result<String> {
    said(Command::new("git").args(arguments).current_dir(root()))
}

/// What a command prints.
fn said(command: &mut Command) -> Result<String> {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().into_diagnostic()?;
    match status.success() {
        true => Ok(String::from_utf8_lossy(&stdout).trim().to_owned()),
        false => Err(miette!("{}", String::from_utf8_lossy(&stderr).trim())),
    }
}
