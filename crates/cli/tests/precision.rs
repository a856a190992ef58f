//! `looselink precision`

use crate::command_line::program;
use assert_cmd::assert::OutputAssertExt;
use std::path::Path;

/// The command writes what it found and what it took apart, refuses to overwrite, and says exit code 2 for bad input.
#[test]
fn the_command_writes_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let command = |study: &Path, more: &[&str]| {
        let mut command = program();
        command.arg("precision").arg(study).arg("--out").arg(&out);
        command.args(["--smoke", "--quiet"]).args(more).assert()
    };
    let study = Path::new("studies/pendulum.toml");
    let shown = command(study, &[]).success();
    let shown = String::from_utf8(shown.get_output().stdout.clone()).unwrap();
    assert!(
        shown.contains("| Bathe | step 4\u{a0}ms |") && shown.contains("Cargo.lock"),
        "{shown}"
    );
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let found = read("precision.json");
    assert!(!found.contains("seconds"));
    let timing: serde_json::Value = serde_json::from_str(&read("timing.json")).unwrap();
    for run in timing["runs"].as_array().unwrap() {
        let seconds = run["timing"]["seconds"].as_array().unwrap();
        assert_eq!(seconds.len(), 1, "a smoke test is timed once");
        assert_eq!(run["timing"]["median"], seconds[0]);
    }
    let rows: Vec<&str> = shown.lines().filter(|l| l.starts_with("| ")).collect();
    let width = |row: &str| row.matches('|').count();
    assert!(rows.iter().all(|row| width(row) == width(rows[0])));
    assert!(rows[0].contains("| processor time | least | runs |"));
    assert!(
        read("precision.svg").len() > 10_000 && read("precision.md").contains("(precision.svg)")
    );
    let png = std::fs::metadata(out.join("precision.png"));
    assert_eq!(
        png.is_ok_and(|file| file.len() > 10_000),
        cfg!(feature = "png")
    );
    command(study, &[]).code(2);
    command(study, &["--force"]).success();
    assert_eq!(read("precision.json"), found);
    command(Path::new("no-such-study.toml"), &["--force"]).code(2);
}
