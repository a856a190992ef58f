//! Several programs at once in one folder: one writes a result, the others are told so.

use super::{ASIDE, Bytes, EARLIER, NEW, arguments, rounds, start, status, whole};
use crate::command_line::{TOP, expect, files, looselink, program, read, summary};
use std::fs;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Output, Stdio};

fn ended(mut children: Vec<Child>) -> Vec<Option<i32>> {
    let codes = children
        .iter_mut()
        .map(|child| child.wait().unwrap().code());
    codes.collect()
}

/// Two runs, and four, of different lengths: the result is whole and of one of them.
#[test]
fn runs_that_start_together_leave_one_whole_result() {
    let folder = tempfile::tempdir().unwrap();
    let short = ["simulation.duration=2e-3", "simulation.duration=3e-3"];
    let results = short.map(|duration| {
        let out = folder.path().join(duration);
        expect(&looselink(&arguments(&out, &[duration])), 0, "");
        Bytes::of(&out)
    });
    let mut refused = 0;
    for (count, tries) in [(2, rounds(40, 1000)), (4, rounds(10, 200))] {
        let out = folder.path().join("out");
        let _ = fs::remove_dir_all(&out);
        for n in 0..tries {
            let runs = (0..count).map(|k| {
                let duration = short[(k + n) % 2];
                start(&arguments(&out, &[duration, "--force"]))
            });
            let codes = ended(runs.collect());
            assert!(codes.contains(&Some(0)), "{codes:?}");
            assert!(
                codes.iter().all(|code| [Some(0), Some(2)].contains(code)),
                "{codes:?}"
            );
            refused += codes.iter().filter(|code| **code == Some(2)).count();
            let found = Bytes::of(&out);
            assert_eq!(status(&out).as_deref(), Some("complete"));
            let mut whole = results.iter().map(Bytes::repeatable);
            assert!(
                whole.any(|whole| whole == found.repeatable()),
                "{:?}",
                files(&out)
            );
            assert_eq!(files(&out), super::COMPLETE);
        }
    }
    assert!(refused > 0, "they never met");
}

/// Pages, pictures and tables of one result, made by many programs while others read them.
#[test]
fn pages_pictures_and_tables_are_made_at_the_same_time() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let study = at("study.toml");
    let scene = Path::new(TOP).join("scenes/pendulum.toml");
    let brief = ["simulation.duration=0.02", "output.interval=0.01"];
    let text = format!(
        "title = 'masses'\nscene = {scene:?}\nset = {brief:?}\n\
         parameters.mass = {{ fields = ['bodies.rod.mass'], values = [1.0, 2.0] }}\n\
         measures.last = {{ of = 'last', channels = ['points.rod.bob.x'] }}\n"
    );
    fs::write(&study, text).unwrap();
    let (run, swept, picture) = (at("run"), at("sweep"), at("picture.svg"));
    let set = brief.iter().flat_map(|change| ["--set", change]);
    let scene = scene.to_str().unwrap();
    let made: Vec<&str> = ["run", scene, "--quiet", "--out", &run]
        .into_iter()
        .chain(set)
        .collect();
    expect(&looselink(&made), 0, "");
    expect(
        &looselink(&["sweep", &study, "--quiet", "--out", &swept]),
        0,
        "",
    );
    let commands: [&[&str]; 3] = [
        &["view", &run],
        &["plot", &run, "--channels", "points.*", "-o", &picture],
        &["sweep", &study, "--quiet", "--merge", "--out", &swept],
    ];
    for command in commands {
        expect(&looselink(command), 0, "");
    }
    let written = [
        at("run/view.html"),
        picture.clone(),
        at("sweep/sweep.csv"),
        at("sweep/sweep.json"),
    ];
    let expected = written.each_ref().map(|path| fs::read(path).unwrap());
    for _ in 0..rounds(2, 10) {
        let children = (0..20).flat_map(|_| commands).map(|command| {
            let mut program = program();
            program
                .args(command)
                .stdout(Stdio::null())
                .stderr(Stdio::null());
            program.spawn().unwrap()
        });
        let mut children: Vec<Child> = children.collect();
        while children
            .iter_mut()
            .any(|child| child.try_wait().unwrap().is_none())
        {
            for (path, expected) in written.iter().zip(&expected) {
                assert!(fs::read(path).unwrap() == *expected, "{path}");
            }
        }
        assert!(ended(children).iter().all(|code| *code == Some(0)));
    }
    let names = files(folder.path());
    assert_eq!(names, ["picture.svg", "run", "study.toml", "sweep"]);
    assert!(
        files(Path::new(&run))
            .iter()
            .all(|name| !name.starts_with('.'))
    );
}

/// What somebody else does to a file.
type Change = fn(&Path);

fn cut(path: &Path, bytes: u64) {
    let file = fs::File::options().write(true).open(path).unwrap();
    file.set_len(bytes).unwrap();
}

fn edit(path: &Path, byte: u8, at: u64) {
    let file = fs::File::options().write(true).open(path).unwrap();
    file.write_all_at(&[byte], at).unwrap();
}

fn replace(path: &Path) {
    let copy = path.with_extension("copy");
    fs::copy(path, &copy).unwrap();
    fs::rename(copy, path).unwrap();
}

/// Of a command during which somebody changes a file, once another one has so many bytes.
fn meddled(
    command: &[&str],
    [grown, changed]: [&PathBuf; 2],
    bytes: u64,
    change: Change,
) -> Output {
    let mut child = program()
        .args(command)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let size = || fs::metadata(grown).map_or(0, |file| file.len());
    while size() < bytes && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    change(changed);
    child.wait_with_output().unwrap()
}

/// Of a run during which somebody changes a file beside its rows.
fn meddled_beside(out: &Path, name: &str, change: Change) -> Output {
    let run = arguments(out, &["simulation.duration=0.1"]);
    let files = ["channels.csv", name].map(|name| out.join(name));
    meddled(&run, files.each_ref(), 10_000, change)
}

/// A run whose rows somebody else takes away, cuts, replaces or edits does not call itself complete.
#[test]
fn rows_that_others_change_in_mid_run_are_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    let changes: [(&str, Change); 5] = [
        ("deleted", |table| fs::remove_file(table).unwrap()),
        ("cut", |table| cut(table, 100)),
        ("replaced", replace),
        ("edited", |table| edit(table, b'9', 200)),
        ("moved", |table| {
            let out = table.parent().unwrap();
            fs::rename(out, out.with_extension("elsewhere")).unwrap();
        }),
    ];
    for (how, change) in changes {
        for name in ["channels.csv", "motion.bin"] {
            let out = folder.path().join(format!("{how}-{name}"));
            let table = out.join(name);
            let run = arguments(&out, &["simulation.duration=0.2"]);
            let output = meddled(&run, [&table, &table], 10_000, change);
            expect(&output, 1, "while the program wrote");
            expect(&output, 1, out.to_str().unwrap());
            let status = status(&out);
            assert_ne!(status.as_deref(), Some("complete"), "{how} {name}");
            if status.as_deref() == Some("failed") {
                let why = summary(&out)["error"].as_str().unwrap().to_owned();
                assert!(why.contains(name), "{why}");
                // readers refuse what the program did not write
                expect(&looselink(&["view", out.to_str().unwrap()]), 2, name);
            } else {
                assert_eq!(how, "moved");
            }
        }
    }
}

/// The scene in the folder is part of the result.
#[test]
fn a_scene_that_others_change_in_mid_run_is_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    let changes: [Change; 3] = [
        |scene| fs::remove_file(scene).unwrap(),
        |scene| fs::write(scene, "title = 'mine'\n").unwrap(),
        |scene| fs::write(scene, fs::read_to_string(scene).unwrap() + "\n").unwrap(),
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let out = folder.path().join(n.to_string());
        let output = meddled_beside(&out, "scene.toml", change);
        expect(&output, 1, "scene.toml` was ");
        let summary = summary(&out);
        assert_eq!(summary["status"], "failed");
        assert!(summary["error"].as_str().unwrap().contains("scene.toml"));
    }
}

/// A manifest that lists nothing any more.
#[test]
fn a_manifest_that_others_change_in_mid_run_is_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    let changes: [Change; 3] = [
        |manifest| fs::write(manifest, "").unwrap(),
        |manifest| edit(manifest, b'9', 3),
        |manifest| fs::remove_file(manifest).unwrap(),
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let out = folder.path().join(n.to_string());
        let output = meddled_beside(&out, "manifest.jsonl", change);
        expect(&output, 1, "manifest.jsonl` was ");
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(told.matches("manifest.jsonl` was ").count(), 1, "{told}");
        assert!(!told.contains("resume"), "{told}");
        assert_ne!(status(&out).as_deref(), Some("complete"));
    }
}

/// A sweep whose rows somebody else takes away, cuts, replaces or edits makes no tables, and the same command goes on.
#[test]
fn rows_that_others_change_in_mid_sweep_make_no_tables() {
    let folder = tempfile::tempdir().unwrap();
    let masses: Vec<String> = (1..=300).map(|mass| format!("{mass}.0")).collect();
    let masses = format!("[{}]", masses.join(", "));
    let study = super::foreign::study(folder.path(), "masses", &masses);
    let changes: [(&str, Change); 6] = [
        ("deleted", |rows| fs::remove_file(rows).unwrap()),
        ("cut", |rows| cut(rows, 1000)),
        ("without lines", |rows| {
            let text = fs::read_to_string(rows).unwrap();
            let first: Vec<&str> = text.split_inclusive('\n').take(4).collect();
            fs::write(rows, first.concat()).unwrap();
        }),
        ("replaced", replace),
        ("edited", |rows| edit(rows, b'#', 900)),
        ("without its manifest", |rows| {
            fs::remove_file(rows.with_file_name("manifest.jsonl")).unwrap();
        }),
    ];
    for (how, change) in changes {
        for shard in [None, Some("1/1")] {
            let out = folder.path().join(format!("{how} {}", shard.is_some()));
            let rows = out.join("runs.jsonl");
            let place = out.to_str().unwrap();
            let mut words = vec!["sweep", &study, "--quiet", "--out", place];
            words.extend(shard.iter().flat_map(|shard| ["--shard", shard]));
            let output = meddled(&words, [&rows, &rows], 5000, change);
            let file = if how == "without its manifest" {
                "manifest"
            } else {
                "runs"
            };
            expect(&output, 1, &format!("{file}.jsonl` was "));
            assert!(!out.join("sweep.csv").exists(), "{how}");
            let again = looselink(&words);
            match how {
                "edited" | "cut" => expect(
                    &again,
                    2,
                    "is damaged; without that line its run is made again",
                ),
                "without its manifest" => {
                    expect(&again, 2, "runs.jsonl` is not a file of this program")
                }
                _ => {
                    expect(&again, 0, "");
                    expect(&looselink(&words[..5]), 0, "");
                    assert_eq!(read(&out, "sweep.csv").lines().count(), 301);
                }
            }
        }
    }
}

/// The same of rows that other shards have made, or somebody has brought.
#[test]
fn rows_of_others_that_change_in_mid_sweep_make_no_tables() {
    let folder = tempfile::tempdir().unwrap();
    let masses: Vec<String> = (1..=300).map(|mass| format!("{mass}.0")).collect();
    let masses = format!("[{}]", masses.join(", "));
    let study = super::foreign::study(folder.path(), "masses", &masses);
    let changes: [Change; 3] = [
        |rows| fs::remove_file(rows).unwrap(),
        |rows| cut(rows, 1000),
        // of which sweep they are
        |rows| edit(rows, b'#', 20),
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let out = folder.path().join(n.to_string());
        let words = ["sweep", &study, "--quiet", "--out", out.to_str().unwrap()];
        let shard = [&words[..], &["--shard", "1/4"]].concat();
        expect(&looselink(&shard), 0, "");
        let files = ["runs.jsonl", "runs-1-of-4.jsonl"].map(|name| out.join(name));
        let output = meddled(&words, files.each_ref(), 5000, change);
        expect(&output, 1, "runs-1-of-4.jsonl` was ");
        assert!(!out.join("sweep.csv").exists(), "{n}");
    }
}

/// A run whose folder is taken by another one between its end and its resumption.
#[test]
fn a_folder_in_use_is_not_resumed_swept_or_studied() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    whole(&out, EARLIER);
    let held = fs::File::open(out.join("manifest.jsonl")).unwrap();
    held.lock().unwrap();
    let name = out.to_str().unwrap();
    let before = Bytes::of(&out);
    let commands: [&[&str]; 4] = [
        &arguments(&out, &[NEW, "--force"]),
        &["resume", name],
        &["ablate", "scenes/pendulum.toml", "--force", "--out", name],
        &[
            "precision",
            "studies/pendulum.toml",
            "--smoke",
            "--force",
            "--out",
            name,
        ],
    ];
    for command in commands {
        expect(&looselink(command), 2, "another looselink is writing to `");
        assert!(Bytes::of(&out) == before && !out.join(ASIDE).exists());
    }
    drop(held);
    // it holds something else
    for command in &commands[2..] {
        expect(
            &looselink(command),
            2,
            "holds a run already; choose another folder",
        );
    }
    assert!(Bytes::of(&out) == before);
}
