//! Full disks and places where nobody can write.

use super::{Bytes, arguments, check_beginning, status};
use crate::command_line::{TOP, expect, files, looselink, program, read, summary};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs under a limit of the size of files, in blocks of the shell. The signal that comes with it kills programs that do not expect it.
fn limited(blocks: usize, command: &[&str]) -> Output {
    Command::new("sh")
        .args(["-c", &format!("ulimit -f {blocks}; exec \"$@\"")])
        .arg("sh")
        .arg(program().get_program())
        .current_dir(TOP)
        .args(command)
        .output()
        .unwrap()
}

/// No room for a file, at sizes that each of the files reaches first with one of the four lists of channels.
#[test]
fn a_full_disk_ends_a_run_with_the_name_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut hit = std::collections::BTreeSet::new();
    let lots = ["simulation.duration=0.02"];
    // two rows, of all channels before there are many contacts, or of one after many: the summary or the onsets are the
    // longest file then
    let all = [
        "simulation.duration=4e-3",
        "--set",
        "output.interval=4e-3",
        "--set",
        "output.channels=[\"*\"]",
    ];
    let one = [
        "simulation.duration=0.05",
        "--set",
        "output.interval=0.05",
        "--set",
        "output.channels=[\"error.x\"]",
    ];
    // many rows of one channel: the motion is the longest file then
    let few = [
        "simulation.duration=0.02",
        "--set",
        "output.channels=[\"error.x\"]",
    ];
    for (n, more) in [&lots[..], &all, &one, &few].into_iter().enumerate() {
        let out = folder.path().join(format!("whole-{n}"));
        expect(&looselink(&arguments(&out, more)), 0, "");
        let whole = Bytes::of(&out);
        let view = limited(8, &["view", out.to_str().unwrap()]);
        expect(&view, 1, "view.html`: File too large");
        for blocks in (0..40).chain([80, 160, 320]) {
            let out = folder.path().join(format!("{n}-{blocks}"));
            let output = limited(blocks, &arguments(&out, more));
            if output.status.success() {
                assert_eq!(Bytes::of(&out).repeatable(), whole.repeatable());
                continue;
            }
            check_beginning(&Bytes::of(&out), &whole);
            match status(&out).as_deref() {
                // where there was room for the summary
                Some("failed") => {
                    let error = summary(&out)["error"].as_str().unwrap().to_owned();
                    assert!(error.contains("cannot write `"), "{error}");
                }
                status => assert_ne!(status, Some("complete")),
            }
            expect(&output, 1, "cannot write `");
            let stderr = String::from_utf8(output.stderr).unwrap();
            // nobody but the program has
            assert!(!stderr.contains("was changed"), "{stderr}");
            let (_, path) = stderr.split_once("cannot write `").unwrap();
            let name = Path::new(path.split('`').next().unwrap())
                .file_name()
                .unwrap();
            hit.insert(name.to_str().unwrap().to_owned());
            if blocks % 8 == 0 {
                expect(
                    &looselink(&arguments(&out, &[more, &["--force"]].concat())),
                    0,
                    "",
                );
                assert_eq!(Bytes::of(&out).repeatable(), whole.repeatable());
            }
        }
    }
    let hit: Vec<_> = hit.iter().map(String::as_str).collect();
    assert_eq!(
        hit,
        [
            "channels.csv",
            "manifest.jsonl",
            "motion.bin",
            "onsets.csv",
            "scene.toml",
            "summary.json"
        ]
    );
}

/// An earlier result is set aside in a folder that does not stay where there is no room for its manifest.
#[test]
fn a_full_disk_leaves_nothing_of_what_it_sets_aside() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    expect(
        &looselink(&arguments(&out, &["simulation.duration=2e-3"])),
        0,
        "",
    );
    let before = crate::command_line::contents(&out);
    expect(
        &limited(
            0,
            &arguments(&out, &["simulation.duration=3e-3", "--force"]),
        ),
        1,
        "cannot write `",
    );
    assert!(crate::command_line::contents(&out) == before);
}

/// Places where nobody can write, root neither; nothing comes into being.
#[test]
fn unwritable_places_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("file"), "mine").unwrap();
    symlink(at("discarded"), at("dangling")).unwrap();
    symlink(at("loop"), at("loop")).unwrap();
    let below = |path: &Path| -> PathBuf { path.join("below") };
    for (out, code) in [
        (at("file"), 2),
        (at("dangling"), 2),
        (at("loop"), 2),
        (below(&at("file")), 1),
        (below(&at("dangling")), 1),
        (below(Path::new("/proc")), 1),
        (PathBuf::from("/proc/self"), 1),
    ] {
        let name = out.to_str().unwrap();
        for force in [&[][..], &["--force"]] {
            let runs: [&[&str]; 3] = [
                &["run", "scenes/pendulum.toml"],
                &["precision", "studies/pendulum.toml", "--smoke"],
                &["ablate", "scenes/pendulum.toml"],
            ];
            for run in runs {
                let output = looselink(&[run, force, &["--out", name]].concat());
                expect(&output, code, name);
                // before the runs, which would tell of themselves
                assert!(output.stderr.starts_with(b"error: "), "{run:?} {name}");
            }
        }
    }
    assert_eq!(files(folder.path()), ["dangling", "file", "loop"]);
    assert_eq!(read(folder.path(), "file"), "mine");
}
