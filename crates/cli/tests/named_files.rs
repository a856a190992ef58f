//! Files that a study or a folder names: of one that is no scene or no result the user learns where it fails, not what stands in it.

use crate::command_line::{TOP, expect, looselink};
use std::fs;
use std::path::Path;

/// Files that nobody wants to see in a log, each with words that stand in it.
const FOREIGN: [(&str, &[u8], &[&str]); 6] = [
    (
        "key",
        b"-----BEGIN PRIVATE KEY-----\nMIIEhunter2\n-----END PRIVATE KEY-----\n",
        &["PRIVATE", "hunter2"],
    ),
    ("env", b"API_KEY=hunter2\n", &["API_KEY", "hunter2"]),
    (
        "env-of-toml",
        b"API_KEY = \"hunter2\"\n[simulation_keys]\n",
        &["API_KEY", "hunter2", "simulation_keys"],
    ),
    (
        "passwd",
        b"root:x:0:0:hunter2:/root:/bin/bash\n",
        &["root", "hunter2"],
    ),
    ("bytes", b"hunter2 \xff\xfe\n", &["hunter2"]),
    ("twice", b"hunter2 = 1\nhunter2 = 2\n", &["hunter2"]),
];

const SWEEP: &str = "[parameters.m]\nfields = [\"bodies.journal.mass\"]\nvalues = [1, 2]\n[measures.x]\nof = \"last\"\nchannels = [\"journal.x\"]\n";
const PRECISION: &str = "duration = 1e-3\ninterval = 1e-3\nposition = [\"journal.x\"]\nreference = { set = [], steps = [1e-4, 1e-5] }\n\
    curves = [{ name = \"x\", steps = [1e-3] }]\n";

/// A scene that the commands run in no time.
fn scene() -> String {
    let text = fs::read_to_string(Path::new(TOP).join("scenes/bouncing-journal.toml")).unwrap();
    let shorter = text.replace("duration = 0.02", "duration = 1e-3");
    shorter.replace("= 1.6e-6", "= 2e-5")
}

#[track_caller]
fn assert_silent(said: &str, words: &[&str]) {
    let told = words.iter().find(|word| said.contains(**word));
    assert_eq!(told, None, "{said}");
}

#[test]
fn a_study_does_not_show_the_file_that_it_names() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [study, out] = [place("study.toml"), place("out")];
    for (name, bytes, words) in FOREIGN {
        fs::write(place(name), bytes).unwrap();
        for (command, text) in [("sweep", SWEEP), ("precision", PRECISION)] {
            let text = format!(
                "title = \"x\"\nscene = \"{name}\"\nset = [\"simulation.duration=1e-3\"]\n{text}"
            );
            fs::write(&study, text).unwrap();
            let output = looselink(&[command, &study, "--out", &out]);
            let line = if name == "twice" { 2 } else { 1 };
            expect(&output, 2, &format!("{name}`, line {line}, column"));
            assert_silent(&String::from_utf8_lossy(&output.stderr), words);
        }
        // who names it himself sees it
        let output = looselink(&["check", &place(name)]);
        expect(&output, 2, words[0]);
    }
    // of a scene the fault is told, without the line
    fs::write(
        place("scene"),
        scene().replace("mass = 0.05", "mas = 0.05 # hunter2"),
    )
    .unwrap();
    fs::write(&study, format!("title = \"x\"\nscene = \"scene\"\n{SWEEP}")).unwrap();
    let output = looselink(&["sweep", &study, "--out", &out]);
    expect(
        &output,
        2,
        "unknown key `mas` in bodies.journal; did you mean `mass`?",
    );
    assert_silent(
        &String::from_utf8_lossy(&output.stderr),
        &["hunter2", "0.05"],
    );
}

/// Puts a foreign file in the place of each file of a result, and of a sweep.
#[test]
fn results_do_not_show_foreign_files() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [scene_file, study, run, sweep] = ["scene.toml", "study.toml", "run", "sweep"].map(place);
    fs::write(&scene_file, scene()).unwrap();
    fs::write(
        &study,
        format!("title = \"x\"\nscene = \"scene.toml\"\n{SWEEP}"),
    )
    .unwrap();
    expect(&looselink(&["run", &scene_file, "--out", &run]), 0, "");
    expect(&looselink(&["sweep", &study, "--out", &sweep]), 0, "");
    let picture = place("x.svg");
    let plot = ["plot", &run, "--channels", "none", "-o", &picture];
    for (name, bytes, words) in FOREIGN {
        let rows = [
            bytes,
            b"hunter2,3\n1,2\n",
            b"{\"run\": \"hunter2\"}\n",
            b"\"hunter2\"\n",
        ]
        .concat();
        for file in [
            "scene.toml",
            "summary.json",
            "channels.csv",
            "motion.bin",
            "checkpoint.bin",
        ] {
            let path = Path::new(&run).join(file);
            let own = fs::read(&path).ok();
            for bytes in [
                bytes,
                b"hunter2,x\n1,2\n",
                b"{\"scene_hash\": 5, \"status\": \"hunter2\"}\n",
                b"\"hunter2\"\n",
            ] {
                fs::write(&path, bytes).unwrap();
                for arguments in [&["view", &run][..], &plot, &["resume", &run]] {
                    let output = looselink(arguments);
                    let said = String::from_utf8_lossy(&output.stderr);
                    assert_silent(&said, words);
                    assert_silent(&said, &["hunter2"]);
                }
            }
            match own {
                Some(own) => fs::write(&path, own).unwrap(),
                None => fs::remove_file(&path).unwrap(),
            }
        }
        let path = Path::new(&sweep).join("runs.jsonl");
        let own = fs::read_to_string(&path).unwrap();
        let head = own.lines().next().unwrap().as_bytes();
        for bytes in [rows.clone(), [head, b"\n", &rows].concat()] {
            fs::write(&path, bytes).unwrap();
            let output = looselink(&["sweep", &study, "--out", &sweep, "--merge"]);
            assert_eq!(output.status.code(), Some(2), "{name}");
            let said = String::from_utf8_lossy(&output.stderr);
            assert_silent(&said, words);
            assert_silent(&said, &["hunter2"]);
        }
        fs::write(&path, own).unwrap();
    }
}
