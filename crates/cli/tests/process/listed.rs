//! The manifest: what it lists is the program's, whatever else has the name of a result; a command that is refused lists nothing.

use super::foreign::{refused, study};
use super::{EARLIER, NEW, arguments, whole};
use crate::command_line::{contents, expect, looselink, read};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

fn sweep<'a>(study: &'a str, out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let out = out.to_str().unwrap();
    [&["sweep", study, "--quiet", "--out", out], more].concat()
}

/// Rows that somebody has brought count, and stay as they are.
#[test]
fn rows_that_are_not_listed_are_read_and_never_extended() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path(), "masses", "[1.0, 2.0, 3.0, 4.0]");
    let made = folder.path().join("made");
    for shard in ["1/2", "2/2"] {
        expect(
            &looselink(&sweep(&study, &made, &["--shard", shard])),
            0,
            "",
        );
    }
    expect(&looselink(&sweep(&study, &made, &[])), 0, "");
    for (file, more) in [
        ("runs-1-of-2.jsonl", &["--shard", "1/2"][..]),
        ("times-1-of-2.jsonl", &["--shard", "1/2"]),
        ("runs.jsonl", &[]),
    ] {
        let out = folder.path().join(file);
        fs::create_dir(&out).unwrap();
        let rows = read(&made, "runs-1-of-2.jsonl");
        let first: Vec<&str> = rows.split_inclusive('\n').take(2).collect();
        fs::write(out.join(file), first.concat()).unwrap();
        let why = format!("{file}` is not a file of this program; move it");
        refused(&out, &sweep(&study, &out, more), &why);
        refused(&out, &sweep(&study, &out, &["--force"]), &why);
    }
    // brought together
    let out = folder.path().join("together");
    fs::create_dir(&out).unwrap();
    for file in ["runs-1-of-2.jsonl", "runs-2-of-2.jsonl"] {
        fs::copy(made.join(file), out.join(file)).unwrap();
    }
    let rows = contents(&out);
    expect(&looselink(&sweep(&study, &out, &["--merge"])), 0, "");
    assert_eq!(read(&out, "sweep.csv"), read(&made, "sweep.csv"));
    expect(&looselink(&sweep(&study, &out, &[])), 0, "");
    let now = contents(&out);
    assert!(rows.iter().all(|(path, bytes)| now[path] == *bytes));
    assert!(!read(&out, "manifest.jsonl").contains("-of-2"));
}

/// A result without a manifest is that of an earlier version, one with an empty manifest is not.
#[test]
fn only_a_result_without_a_manifest_is_an_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path(), "masses", "[1.0, 2.0]");
    let [run, out] = ["run", "sweep"].map(|name| folder.path().join(name));
    whole(&run, EARLIER);
    expect(&looselink(&sweep(&study, &out, &[])), 0, "");
    for cut in ["", "{\"looselink\":\"a"] {
        fs::write(run.join("manifest.jsonl"), cut).unwrap();
        fs::write(out.join("manifest.jsonl"), cut).unwrap();
        let why = "is not a file of this program";
        refused(&run, &arguments(&run, &[NEW, "--force"]), why);
        refused(
            &run,
            &["view", run.to_str().unwrap()],
            "manifest.jsonl` is damaged",
        );
        for more in [&[][..], &["--force"], &["--merge"]] {
            refused(&out, &sweep(&study, &out, more), why);
        }
    }
    fs::remove_file(out.join("manifest.jsonl")).unwrap();
    for _ in 0..2 {
        refused(
            &out,
            &sweep(&study, &out, &[]),
            "runs.jsonl` is not a file of",
        );
    }
    expect(&looselink(&sweep(&study, &out, &["--merge"])), 0, "");
    fs::remove_file(out.join("manifest.jsonl")).unwrap();
    expect(&looselink(&sweep(&study, &out, &["--force"])), 0, "");
    expect(&looselink(&sweep(&study, &out, &[])), 0, "");
    // a file of the user that is called so
    fs::write(run.join("manifest.jsonl"), "mine").unwrap();
    fs::remove_file(run.join("channels.csv")).unwrap();
    for command in [
        arguments(&run, &[NEW, "--force"]),
        vec!["view", run.to_str().unwrap()],
    ] {
        refused(&run, &command, "");
    }
}

/// A bisection has no shards, and a folder without rows no tables; neither leaves anything.
#[test]
fn a_sweep_that_cannot_begin_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path(), "masses", "[1.0, 2.0]");
    let text = fs::read_to_string(&path).unwrap();
    let text = text.replace("values = [1.0, 2.0]", "from = 1.0, to = 2.0")
        + "design = 'bisection'\ntarget = { measure = 'last', value = 0.5 }\n";
    let bisection = folder.path().join("bisection.toml");
    fs::write(&bisection, text).unwrap();
    let bisection = bisection.to_str().unwrap();
    let out = folder.path().join("out");
    for (study, more, why) in [
        (
            bisection,
            &["--shard", "1/2"][..],
            "a bisection has no shards",
        ),
        (
            &path,
            &["--merge"],
            "out` is no folder with rows of a sweep",
        ),
    ] {
        refused(folder.path(), &sweep(study, &out, more), why);
    }
    fs::create_dir(&out).unwrap();
    refused(
        &out,
        &sweep(&path, &out, &["--merge"]),
        "2 runs have not been made",
    );
}

/// Every line is an object whose keys differ, and is repeated by nothing that only goes on.
#[test]
fn a_manifest_is_read_by_any_reader_of_json() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    whole(&run, EARLIER);
    let mut digests = BTreeMap::new();
    for line in read(&run, "manifest.jsonl").lines() {
        let value: Value = serde_json::from_str(line).unwrap();
        let keys = value.as_object().unwrap().keys();
        keys.for_each(|key| assert_eq!(line.matches(&format!("\"{key}\":")).count(), 1, "{line}"));
        if let Some(crc) = value["crc32"].as_u64() {
            digests.insert(value["file"].as_str().unwrap().to_owned(), crc);
        }
    }
    for (file, crc) in &digests {
        let bytes = fs::read(run.join(file)).unwrap();
        assert_eq!(u64::from(crc32fast::hash(&bytes)), *crc, "{file}");
    }
    let tables: Vec<_> = digests.keys().collect();
    assert_eq!(tables, ["channels.csv", "motion.bin", "onsets.csv"]);

    let study = study(folder.path(), "masses", "[1.0, 2.0]");
    let out = folder.path().join("sweep");
    expect(&looselink(&sweep(&study, &out, &[])), 0, "");
    let before = contents(&out);
    expect(&looselink(&sweep(&study, &out, &[])), 0, "");
    assert!(contents(&out) == before);
}
