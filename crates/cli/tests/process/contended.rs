//! Several programs at once in one folder: one writes a result, the others are told so.

use super::{ASIDE, Bytes, EARLIER, NEW, arguments, rounds, start, status, whole};
use crate::command_line::{TOP, expect, files, looselink, program, read, summary};
use std::fs;
use std::path::Path;
use std::process::{Child, Stdio};

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

/// A run whose rows somebody else takes away, cuts, replaces or edits does not call itself complete.
#[test]
fn rows_that_others_change_in_mid_run_are_not_complete() {
    let folder = tempfile::tempdir().unwrap();
    type Change = fn(&Path);
    let changes: [(&str, Change); 5] = [
        ("deleted", |table| fs::remove_file(table).unwrap()),
        ("cut", |table| {
            let file = fs::File::options().write(true).open(table).unwrap();
            file.set_len(100).unwrap();
        }),
        ("replaced", |table| {
            let copy = table.with_extension("copy");
            fs::copy(table, &copy).unwrap();
            fs::rename(copy, table).unwrap();
        }),
        ("edited", |table| {
            use std::os::unix::fs::FileExt;
            let file = fs::File::options().write(true).open(table).unwrap();
            file.write_all_at(b"9", 200).unwrap();
        }),
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
            let child = program().args(&run).stderr(Stdio::piped()).spawn().unwrap();
            while fs::metadata(&table).map_or(0, |file| file.len()) < 10_000 {
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
            change(&table);
            let output = child.wait_with_output().unwrap();
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
    type Change = fn(&Path);
    let changes: [Change; 3] = [
        |scene| fs::remove_file(scene).unwrap(),
        |scene| fs::write(scene, "title = 'mine'\n").unwrap(),
        |scene| fs::write(scene, fs::read_to_string(scene).unwrap() + "\n").unwrap(),
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let out = folder.path().join(n.to_string());
        let child = program()
            .args(arguments(&out, &["simulation.duration=0.1"]))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while fs::metadata(out.join("channels.csv")).map_or(0, |file| file.len()) < 10_000 {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        change(&out.join("scene.toml"));
        let output = child.wait_with_output().unwrap();
        expect(&output, 1, "scene.toml` was ");
        let summary = summary(&out);
        assert_eq!(summary["status"], "failed");
        assert!(summary["error"].as_str().unwrap().contains("scene.toml"));
    }
}

/// A sweep whose rows somebody else takes away, cuts, replaces or edits makes no tables, and the same command goes on.
#[test]
fn rows_that_others_change_in_mid_sweep_make_no_tables() {
    let folder = tempfile::tempdir().unwrap();
    let masses: Vec<String> = (1..=300).map(|mass| format!("{mass}.0")).collect();
    let masses = format!("[{}]", masses.join(", "));
    let study = super::foreign::study(folder.path(), "masses", &masses);
    type Change = fn(&Path);
    let changes: [(&str, Change); 6] = [
        ("deleted", |rows| fs::remove_file(rows).unwrap()),
        ("cut", |rows| {
            let file = fs::File::options().write(true).open(rows).unwrap();
            file.set_len(1000).unwrap();
        }),
        ("without lines", |rows| {
            let text = fs::read_to_string(rows).unwrap();
            let first: Vec<&str> = text.split_inclusive('\n').take(4).collect();
            fs::write(rows, first.concat()).unwrap();
        }),
        ("replaced", |rows| {
            let copy = rows.with_extension("copy");
            fs::copy(rows, &copy).unwrap();
            fs::rename(copy, rows).unwrap();
        }),
        ("edited", |rows| {
            use std::os::unix::fs::FileExt;
            let file = fs::File::options().write(true).open(rows).unwrap();
            file.write_all_at(b"#", 900).unwrap();
        }),
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
            let child = program()
                .args(&words)
                .stderr(Stdio::piped())
                .spawn()
                .unwrap();
            while fs::metadata(&rows).map_or(0, |file| file.len()) < 5000 {
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
            change(&rows);
            let output = child.wait_with_output().unwrap();
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
    type Change = fn(&Path);
    let changes: [Change; 3] = [
        |rows| fs::remove_file(rows).unwrap(),
        |rows| {
            let file = fs::File::options().write(true).open(rows).unwrap();
            file.set_len(1000).unwrap();
        },
        // of which sweep they are
        |rows| {
            use std::os::unix::fs::FileExt;
            let file = fs::File::options().write(true).open(rows).unwrap();
            file.write_all_at(b"#", 20).unwrap();
        },
    ];
    for (n, change) in changes.into_iter().enumerate() {
        let out = folder.path().join(n.to_string());
        let words = ["sweep", &study, "--quiet", "--out", out.to_str().unwrap()];
        let shard = [&words[..], &["--shard", "1/4"]].concat();
        expect(&looselink(&shard), 0, "");
        let child = program()
            .args(words)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while fs::metadata(out.join("runs.jsonl")).map_or(0, |file| file.len()) < 5000 {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        change(&out.join("runs-1-of-4.jsonl"));
        let output = child.wait_with_output().unwrap();
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
        expect(&looselink(command), 2, "another run is writing to `");
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
