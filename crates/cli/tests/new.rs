//! Scenes that `looselink new` writes.

use crate::command_line::{expect, files, looselink, program, read, summary};
use std::fs;
use std::path::Path;
use std::process::Output;

/// Every template, with a duration that takes a second at most.
pub const TEMPLATES: [(&str, &str); 6] = [
    ("pendulum", "5"),
    ("crane", "4"),
    ("slider-crank", "0.05"),
    ("four-bar", "0.2"),
    ("3rrr", "0.02"),
    ("empty", "1"),
];

fn new(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = program();
    command.current_dir(folder).arg("new").args(arguments);
    command.output().unwrap()
}

/// The commands are those that the scene shows; nothing is said of the results that a newcomer would have to look up.
#[test]
fn every_template_runs_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    for (name, duration) in TEMPLATES {
        let file = format!("my-{name}.toml");
        let output = new(folder.path(), &[name, &file]);
        expect(&output, 0, "");
        let shown = String::from_utf8_lossy(&output.stdout).into_owned();
        let scene = read(folder.path(), &file);
        assert!(scene.starts_with("#:schema ./looselink.schema.json\n"));
        for command in [
            format!("looselink inspect {file}\n"),
            format!("looselink run {file} --out out/my-{name} --view\n"),
        ] {
            let line = scene.lines().find(|l| l.contains(command.trim_end()));
            assert!(line.is_some() && shown.contains(&command), "{shown}{scene}");
            let mut words = command.split_whitespace();
            let mut run = program();
            run.current_dir(folder.path()).args(words.by_ref().skip(1));
            if command.contains(" run ") {
                run.args(["--quiet", "--set"]);
                run.arg(format!("simulation.duration={duration}"));
            }
            let output = run.output().unwrap();
            expect(&output, 0, "");
            assert!(output.stderr.is_empty(), "{name}: {output:?}");
        }
        let out = folder.path().join(format!("out/my-{name}"));
        assert_eq!(summary(&out)["status"], "complete");
    }
}

/// One word makes a joint tight or loose, and a link rigid or flexible.
#[test]
fn the_switches_of_the_templates_work() {
    let folder = tempfile::tempdir().unwrap();
    for (name, switches) in [
        (
            "slider-crank",
            ["joints.wrist_pin.model=ideal", "bodies.rod.model=flexible"],
        ),
        (
            "four-bar",
            ["joints.C.model=ideal", "bodies.coupler.model=flexible"],
        ),
        ("3rrr", ["joints.B1.model=ideal", "joints.C1.model=ideal"]),
        (
            "empty",
            ["bodies.bar.model=flexible", "bodies.bar.elements=2"],
        ),
    ] {
        expect(&new(folder.path(), &[name, name]), 0, "");
        let scene = folder.path().join(name);
        let set = switches.map(|switch| ["--set", switch]).concat();
        let check = ["check", scene.to_str().unwrap()];
        expect(&looselink(&[&check[..], &set].concat()), 0, "");
    }
}

/// A scene with its keys and tables in comments.
fn uncommented(scene: &str) -> String {
    let lines = scene.lines().map(|line| match line.strip_prefix("# ") {
        Some(inner) if inner.starts_with('[') => inner,
        Some(inner) if inner.split(' ').nth(1) == Some("=") => inner,
        _ => line,
    });
    lines.map(|line| format!("{line}\n")).collect()
}

#[test]
fn what_the_empty_template_has_in_comments_is_right() {
    let folder = tempfile::tempdir().unwrap();
    expect(&new(folder.path(), &["empty", "my.toml"]), 0, "");
    let scene = uncommented(&read(folder.path(), "my.toml"));
    assert!(scene.contains("\n[drives.motor]\n") && scene.contains("\nonset_tolerance ="));
    let full = folder.path().join("full.toml");
    fs::write(&full, scene).unwrap();
    expect(&looselink(&["check", full.to_str().unwrap()]), 0, "");
}

#[test]
fn a_file_is_replaced_only_on_demand() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("my.toml"), "mine").unwrap();
    let output = new(folder, &["four-bar", "my.toml"]);
    expect(&output, 2, "`my.toml` exists already");
    expect(&output, 2, "--force");
    assert_eq!(read(folder, "my.toml"), "mine");
    assert_eq!(files(folder), ["my.toml"]);
    expect(&new(folder, &["four-bar", "my.toml", "--force"]), 0, "");
    assert!(read(folder, "my.toml").contains("four-bar linkage"));
    assert_eq!(files(folder), ["looselink.schema.json", "my.toml"]);
}

#[test]
fn a_schema_that_is_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("looselink.schema.json"), "mine").unwrap();
    expect(&new(folder, &["empty", "my.toml"]), 0, "");
    assert_eq!(read(folder, "looselink.schema.json"), "mine");
    expect(&new(folder, &["empty", "my.toml", "--force"]), 0, "");
    let printed = looselink(&["schema"]).stdout;
    assert_eq!(read(folder, "looselink.schema.json").as_bytes(), printed);
}

#[test]
fn nothing_is_left_of_a_scene_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    expect(&new(folder, &["empty", "absent/my.toml"]), 1, "absent");
    fs::create_dir(folder.join("my.toml")).unwrap();
    let output = new(folder, &["empty", "my.toml", "--force"]);
    expect(&output, 2, "`my.toml` is not a file");
    assert_eq!(files(folder), ["looselink.schema.json", "my.toml"]);
}

#[test]
fn a_name_with_a_space_is_quoted() {
    let folder = tempfile::tempdir().unwrap();
    expect(&new(folder.path(), &["empty", "my scene.toml"]), 0, "");
    let scene = read(folder.path(), "my scene.toml");
    let command = "looselink run 'my scene.toml' --out 'out/my scene' --view\n";
    assert!(scene.contains(command), "{scene}");
}
