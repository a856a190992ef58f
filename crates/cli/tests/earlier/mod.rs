//! Results, checkpoints, sweeps and scenes of an earlier version: read, replaced on request, or refused by name.

use crate::command_line::{TOP, contents, copy, expect, files, looselink, program, read, summary};
use numbers::hexadecimal;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The commit whose program has written the files. Its runs and studies have no manifest, its checkpoints and rows no digest.
const VERSION: &str = "332b0af";

fn stored() -> PathBuf {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/earlier");
    tests.join(VERSION)
}

/// A copy of what the earlier program has written, in which commands work.
struct Copy(TempDir);

impl Copy {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        copy(&stored(), folder.path());
        Copy(folder)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    #[track_caller]
    fn expect(&self, command: &str, code: i32, stderr: &str) {
        let words = command.split_whitespace();
        let output = program().current_dir(self.0.path()).args(words).output();
        expect(&output.unwrap(), code, stderr);
    }

    /// A command is refused and changes nothing.
    #[track_caller]
    fn refused(&self, command: &str, message: &str) {
        let before = contents(self.0.path());
        self.expect(command, 2, message);
        assert!(contents(self.0.path()) == before, "{command}");
    }
}

#[test]
fn earlier_results_are_read() {
    let copy = Copy::new();
    for result in ["run", "json_lines", "interrupted"] {
        copy.expect(&format!("view {result}"), 0, "");
        let page = read(&copy.at(result), "view.html");
        assert!(page.contains("slider"), "{result}");
        copy.expect(
            &format!("plot {result} --channels slider.x -o {result}.svg"),
            0,
            "",
        );
        assert!(read(&copy.at(""), &format!("{result}.svg")).contains("slider.x"));
    }
}

/// Also where the present program has put a page into the folder.
#[test]
fn earlier_results_are_replaced_on_request_only() {
    let copy = Copy::new();
    let short = "--set simulation.duration=1e-3";
    let commands = [
        ("run scene.toml --quiet --out run", "summary.json"),
        ("run scene.toml --quiet --out json_lines", "summary.json"),
        ("run scene.toml --quiet --out interrupted", "summary.json"),
        (
            &format!("ablate scene.toml --quiet {short} --out ablation"),
            "ablation.json",
        ),
        (
            "precision work-and-precision.toml --out precision",
            "precision.json",
        ),
    ];
    copy.expect("view json_lines", 0, "");
    for (command, closing) in commands {
        copy.refused(command, closing);
        copy.expect(&format!("{command} --force"), 0, "");
        let out = copy.at(command.split_whitespace().last().unwrap());
        assert!(read(&out, "manifest.jsonl").contains(closing), "{command}");
        assert!(!files(&out).contains(&"previous-result".to_owned()));
    }
    for run in ["run", "json_lines", "interrupted"] {
        assert_eq!(summary(&copy.at(run))["status"], "complete");
        let left = ["view.html", "channels.jsonl", "checkpoint.bin"];
        let names = files(&copy.at(run));
        assert!(left.iter().all(|name| !names.contains(&(*name).to_owned())));
    }
}

/// An earlier result is read where it stands aside, too.
#[test]
#[cfg(unix)]
fn earlier_results_that_stand_aside_are_read() {
    let copy = Copy::new();
    let looselink = env!("CARGO_BIN_EXE_looselink");
    let fails = format!("ulimit -f 2; exec {looselink} run scene.toml --quiet --force --out run");
    let mut shell = std::process::Command::new("sh");
    let output = shell.current_dir(copy.at("")).args(["-c", &fails]).output();
    expect(
        &output.unwrap(),
        1,
        "the earlier result is in `run/previous-result`",
    );
    copy.expect(
        "plot run/previous-result --channels slider.x -o aside.svg",
        0,
        "",
    );
    copy.expect("view run/previous-result -o aside.html", 0, "");
}

#[test]
fn earlier_checkpoints_and_sweeps_are_refused_by_name() {
    let copy = Copy::new();
    let version =
        "`checkpoint.bin` is of an earlier version of the program; `looselink run` with --force";
    copy.refused("resume interrupted", version);
    let rows =
        "`sweep/runs.jsonl`: its rows are of an earlier program, which gave them no checksums";
    for more in ["", "--merge", "--shard 1/2"] {
        copy.refused(
            &format!("sweep study.toml --quiet --out sweep {more}"),
            rows,
        );
    }
    copy.expect("sweep study.toml --quiet --out sweep --force", 0, "");
    copy.expect("sweep study.toml --quiet --out sweep --merge", 0, "");
}

#[test]
fn earlier_results_share_their_folder_with_no_other() {
    let copy = Copy::new();
    for (folder, kind) in [
        ("run", "a run"),
        ("interrupted", "a run"),
        ("ablation", "an ablation"),
        ("precision", "a study of precision"),
    ] {
        let message = format!("`{folder}` holds {kind} already");
        copy.refused(
            &format!("sweep study.toml --quiet --out {folder}"),
            &message,
        );
    }
    for force in ["", " --force"] {
        copy.refused(
            &format!("run scene.toml --out sweep{force}"),
            "`sweep` holds a sweep already",
        );
        copy.refused(
            &format!("run scene.toml --out ablation{force}"),
            "holds an ablation already",
        );
    }
}

/// Those that have not changed since are run by the tests of this version.
#[test]
fn scenes_of_an_earlier_version_are_kept_and_run() {
    let mut changed = 0;
    for line in read(&stored(), "scenes.sha256").lines() {
        let (digest, scene) = line.split_once("  ").unwrap();
        let now = fs::read(Path::new(TOP).join(scene)).unwrap_or_default();
        if hexadecimal(&Sha256::digest(now)) == digest {
            continue;
        }
        let then = stored().join(scene);
        let bytes = fs::read(&then).unwrap_or_else(|_| {
            panic!("{scene} has changed since {VERSION}: put that version at {then:?}")
        });
        assert_eq!(hexadecimal(&Sha256::digest(bytes)), digest, "{scene}");
        let folder = tempfile::tempdir().unwrap();
        let [then, out] = [&then, folder.path()].map(|path| path.to_str().unwrap());
        let output = looselink(&["run", then, "--quiet", "--out", out]);
        expect(&output, 0, "");
        assert_eq!(summary(folder.path())["status"], "complete", "{scene}");
        changed += 1;
    }
    let kept = contents(&stored().join("scenes"));
    let kept = kept.keys().filter(|path| path.is_file());
    assert_eq!(kept.count(), changed, "a copy of a scene that is as it was");
}
