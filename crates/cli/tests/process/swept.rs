//! Sweeps on several threads, in shards, interrupted and killed: the same bytes.

use super::Random;
use crate::command_line::{expect, looselink, program, read};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// 200 runs of some milliseconds each, in which a pin bounces; with a restitution above 1 they are refused.
const STUDY: &str = r#"
title = "many short runs"
scene = "SCENE"
set = ["simulation.duration=0.002"]
[parameters.clearance]
fields = ["contacts.pin.clearance"]
from = 1e-4
to = 5e-4
count = 10
unit = "m"
[parameters.restitution]
fields = ["contacts.pin.restitution"]
values = [0.6, 1.5, 0.7, 0.8, 0.9]
[starts]
count = 4
velocity = 1e-6
[measures.force]
of = "largest"
channels = ["slider_pin.force"]
[envelopes.force_over_time]
channels = ["slider_pin.force"]
parts = 10
"#;
const RUNS: usize = 200;

fn study(folder: &Path) -> PathBuf {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scene = scenes
        .canonicalize()
        .unwrap()
        .join("slider-crank/loose.toml");
    let path = folder.join("study.toml");
    fs::write(&path, STUDY.replace("SCENE", scene.to_str().unwrap())).unwrap();
    path
}

fn sweep<'a>(study: &'a Path, out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let [study, out] = [study, out].map(|path| path.to_str().unwrap());
    [&["sweep", study, "--out", out, "--quiet"], more].concat()
}

/// The result without times and rows in the order of their ends.
fn result(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            let bytes = fs::read(entry.path()).unwrap();
            (name, bytes)
        })
        .filter(|(name, _)| !name.ends_with(".jsonl") && name != "times.csv")
        .collect()
}

#[test]
fn a_sweep_has_the_same_bytes_however_it_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path());
    let out = |name: &str| folder.path().join(name);
    let one = out("one");
    let started = Instant::now();
    let output = looselink(&sweep(&study, &one, &["--threads", "1"]));
    let took = started.elapsed();
    expect(&output, 0, "cannot start: ");
    let expected = result(&one);
    let names: Vec<&str> = expected.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "envelopes.csv",
            "points.csv",
            "sweep.csv",
            "sweep.json",
            "sweep.md",
            #[cfg(feature = "parquet")]
            "sweep.parquet",
            #[cfg(feature = "png")]
            "sweep.png",
            "sweep.svg"
        ]
    );
    let table = read(&one, "sweep.csv");
    assert_eq!(table.lines().count(), RUNS + 1);
    assert_eq!(table.matches(",refused,").count(), RUNS / 5);

    let two = out("two");
    expect(&looselink(&sweep(&study, &two, &["--threads", "2"])), 0, "");
    assert!(result(&two) == expected, "threads");

    let shards = out("shards");
    for shard in ["1/4", "2/4", "3/4", "4/4"] {
        expect(
            &looselink(&sweep(&study, &shards, &["--shard", shard])),
            0,
            "",
        );
        assert!(result(&shards).is_empty(), "a shard makes no table");
    }
    expect(&looselink(&sweep(&study, &shards, &["--merge"])), 0, "");
    assert!(result(&shards) == expected, "shards");

    let killed = out("killed");
    let mut random = Random(18);
    let (mut kills, mut between) = (0, 0);
    for _ in 0..10 {
        let mut child = program()
            .args(sweep(&study, &killed, &[]))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(took.mul_f64(0.1 * random.uniform()));
        child.kill().unwrap();
        kills += usize::from(child.wait().unwrap().signal().is_some());
        let rows = fs::read_to_string(killed.join("runs.jsonl")).unwrap_or_default();
        let rows = rows.lines().count();
        between += usize::from(rows > 1 && rows < RUNS);
        let missing = looselink(&sweep(&study, &killed, &["--merge"]));
        if rows > 1 && rows < RUNS {
            expect(&missing, 2, "runs have not been made: ");
        }
    }
    assert!(kills >= 5 && between >= 3, "{kills} {between}");
    expect(&looselink(&sweep(&study, &killed, &[])), 0, "");
    assert!(result(&killed) == expected, "kills");
}

#[test]
fn an_interrupted_sweep_says_how_to_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path());
    let out = folder.path().join("out");
    let child = program()
        .args(sweep(&study, &out, &["--threads", "1"]))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let rows = || fs::read(out.join("runs.jsonl")).is_ok_and(|bytes| bytes.len() > 1000);
    let started = Instant::now();
    while !rows() {
        assert!(started.elapsed() < Duration::from_secs(60), "no row came");
        std::thread::sleep(Duration::from_millis(1));
    }
    let id = child.id().to_string();
    std::process::Command::new("kill")
        .args(["-INT", &id])
        .status()
        .unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(
        message.contains("of 200 runs are made; the same command goes on"),
        "{message}"
    );
    assert!(result(&out).is_empty());
}

#[test]
fn faults_of_the_command_line_of_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path());
    let out = folder.path().join("out");
    let cases: [(&[&str], &str); 6] = [
        (&["--shard", "1/4", "--force"], "cannot be used with"),
        (&["--shard", "5/4"], "write i/n with 1 <= i <= n"),
        (&["--shard", "1/4", "--merge"], "cannot be used with"),
        (&["--target", "force"], "write measure=value"),
        (&["--target", "fource=1.0"], "did you mean `force`?"),
        (
            &["--target", "force=1.0"],
            "a bisection needs exactly one parameter",
        ),
    ];
    for (more, wanted) in cases {
        expect(&looselink(&sweep(&study, &out, more)), 2, wanted);
    }
    expect(&looselink(&sweep(&study, &out, &["--merge"])), 2, "out");
    assert!(
        !out.exists(),
        "nothing is created by a command that is refused"
    );
}
