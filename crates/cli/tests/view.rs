//! `looselink view`; `crates/view/web/test` looks at the pages in a browser.

use crate::command_line::{expect, files, looselink, read, run};
use std::fs;
use std::path::Path;
use std::process::Output;

fn view(folder: &Path, more: &[&str]) -> Output {
    looselink(&[&["view", folder.to_str().unwrap()], more].concat())
}

/// The page of a finished run does not depend on which command wrote it.
#[test]
fn run_and_view_write_the_same_page() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &["--view"]), 0, "view.html");
    let page = read(out, "view.html");
    let summary: serde_json::Value = serde_json::from_str(&read(out, "summary.json")).unwrap();
    assert!(page.contains(summary["title"].as_str().unwrap()));
    assert!(!page.contains("src=") && !page.contains("<link rel=\"stylesheet"));
    expect(&view(out, &[]), 0, "");
    assert_eq!(read(out, "view.html"), page);
    // a name of its own for the page
    expect(
        &view(out, &["-o", out.join("channels.csv").to_str().unwrap()]),
        2,
        ".html",
    );
    // a page is a part of its result
    expect(&run(out, &["--force"]), 0, "");
    assert!(!out.join("view.html").exists());
}

/// Also a run that was killed can be looked at: rows that were cut are left out.
#[test]
fn a_part_of_a_run_can_be_seen() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &[]), 0, "");
    let manifest = read(out, "manifest.jsonl");
    let damaged = manifest.replace(
        "{\"file\":\"channels.csv\",\"bytes\"",
        "{\"fild\":\"channels.csv\",\"bytes\"",
    );
    assert_ne!(damaged, manifest);
    fs::write(out.join("manifest.jsonl"), damaged).unwrap();
    expect(&view(out, &[]), 2, "manifest.jsonl` is damaged");
    fs::write(out.join("manifest.jsonl"), manifest).unwrap();
    for file in ["channels.csv", "motion.bin"] {
        let bytes = fs::read(out.join(file)).unwrap();
        fs::write(out.join(file), &bytes[..bytes.len() / 2 + 3]).unwrap();
    }
    expect(
        &view(out, &[]),
        2,
        "channels.csv` is damaged, or was changed",
    );
    // the manifest of a run that is under way has no digests
    fs::remove_file(out.join("manifest.jsonl")).unwrap();
    expect(&view(out, &[]), 0, "");
}

#[test]
fn tables_of_json_lines_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(
        &run(out, &["--set", "output.format=json_lines", "--view"]),
        0,
        "",
    );
    assert!(read(out, "view.html").contains("energy.kinetic"));
}

#[test]
fn pictures_stand_at_evenly_spaced_times() {
    let folder = tempfile::tempdir().unwrap();
    let (out, pictures) = (folder.path().join("run"), folder.path().join("pictures"));
    expect(&run(&out, &[]), 0, "");
    let frames = ["--frames", pictures.to_str().unwrap(), "--count", "3"];
    expect(&view(&out, &frames), 0, "");
    assert_eq!(
        files(&pictures),
        ["frame-0000.svg", "frame-0001.svg", "frame-0002.svg"]
    );
    // pictures of two series are not mixed
    expect(&view(&out, &frames), 2, "holds pictures already");
    let last = read(&out, "channels.csv")
        .lines()
        .last()
        .unwrap()
        .to_owned();
    let end: f64 = last.split(',').next().unwrap().parse().unwrap();
    assert!(read(&pictures, "frame-0000.svg").contains("t = 0.000000 s"));
    assert!(read(&pictures, "frame-0002.svg").contains(&format!("t = {end:.6} s")));
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&view(&out.join("nothing"), &[]), 2, "holds no result");
    let still = ["--set", "output.motion=false"];
    expect(
        &run(out, &[&still[..], &["--view"]].concat()),
        2,
        "leaves out",
    );
    expect(&run(out, &still), 0, "");
    expect(&view(&out.join("scene.toml"), &[]), 2, "is a file");
    assert!(!out.join("motion.bin").exists());
    expect(&view(out, &[]), 2, "output.motion = false");
    expect(&run(out, &["--force"]), 0, "");
    let scene = read(out, "scene.toml");
    fs::write(
        out.join("scene.toml"),
        scene.replace("duration = 0.02", "duration = 0.03"),
    )
    .unwrap();
    expect(&view(out, &[]), 2, "not the scene of the run");
    // rows that are damaged are refused before they are read: here they only look so
    fs::remove_file(out.join("manifest.jsonl")).unwrap();
    fs::write(out.join("scene.toml"), scene).unwrap();
    fs::write(out.join("motion.bin"), "{\"columns\":[\"t\"]}\n").unwrap();
    expect(&view(out, &[]), 2, "its columns are not those of the scene");
    let missing = out.join("no/such/page.html");
    fs::remove_file(out.join("motion.bin")).unwrap();
    expect(&view(out, &[]), 2, "it has no `motion.bin`");
    expect(&run(out, &["--force"]), 0, "");
    expect(
        &view(out, &["-o", missing.to_str().unwrap()]),
        1,
        "cannot write",
    );
}

/// The page of a run that ends early says so.
#[test]
fn a_run_that_cannot_go_on_has_its_page() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(
        folder.path(),
        &["--view", "--set", "bodies.journal.mass=1e-300"],
    );
    expect(&output, 3, "view.html");
    assert!(read(folder.path(), "view.html").contains("failed"));
}
