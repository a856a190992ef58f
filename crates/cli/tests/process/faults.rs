//! Calls of the system on files that fail, each at its first, a middle and its last time: nothing is falsely complete, nothing of
//! others is lost, and the same command goes on.
#![cfg(target_os = "linux")]

use super::{Bytes, NEW, arguments, rounds, start, status};
use crate::command_line::{copy, expect, interrupt, looselink, program};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::time::Duration;

/// Of errno.h on Linux; 0 stands for half of a write.
const ERRORS: [i32; 4] = [28, 5, 13, 0];

/// Some hundred rows.
const SHORT: &str = "simulation.duration=3e-3";
const SHORTER: &str = "simulation.duration=2e-3";

/// A library that is loaded before that of the system.
fn library() -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("faults.so");
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/process/faults.c");
        // Rust links with it
        let mut compiler = Command::new("cc");
        compiler.args(["-O1", "-Wall", "-Werror", "-shared", "-fPIC", "-o"]);
        let compiled = compiler.arg(&path).args([source, "-ldl"]).status();
        assert!(compiled.unwrap().success());
        path
    })
}

/// A command, and what it finds and leaves.
struct Trial<'a> {
    /// The folder before it, with notes of the user.
    before: &'a Path,
    /// Its words without the folder.
    command: Vec<String>,
    /// What brings the result to its end after a fault.
    again: Vec<String>,
    /// Files of the whole result.
    wanted: BTreeMap<String, Vec<u8>>,
    /// Where the folder is.
    place: PathBuf,
}

impl Trial<'_> {
    fn out(&self) -> PathBuf {
        self.place.join("out")
    }

    fn words(&self, command: &[String]) -> Vec<String> {
        let out = self.out().to_str().unwrap().to_owned();
        command
            .iter()
            .map(|word| word.replace("OUT", &out))
            .collect()
    }

    fn run(&self, variables: &[(&str, &str)]) -> Output {
        let _ = fs::remove_dir_all(self.out());
        copy(self.before, &self.out());
        let mut program = program();
        program
            .current_dir(crate::command_line::TOP)
            .env("LD_PRELOAD", library())
            .env("FAULT_FOLDER", self.out());
        program.envs(variables.iter().copied());
        program.args(self.words(&self.command)).output().unwrap()
    }

    fn found(&self) -> BTreeMap<String, Vec<u8>> {
        let read = |name: &String| {
            (
                name.clone(),
                fs::read(self.out().join(name)).unwrap_or_default(),
            )
        };
        self.wanted.keys().map(read).collect()
    }

    /// Lets every call fail; returns how many did.
    fn all(&self, closing: &str) -> usize {
        let counts = self.place.join("counts");
        let output = self.run(&[("FAULT_COUNTS", counts.to_str().unwrap())]);
        expect(&output, 0, "");
        assert!(self.found() == self.wanted);
        let counts = fs::read_to_string(counts).unwrap();
        let mut faults = 0;
        for line in counts.lines() {
            let (call, number) = line.split_once(' ').unwrap();
            let number: usize = number.parse().unwrap();
            let mut times = vec![1, number / 2, number];
            times.extend(1..=rounds(0, number));
            times.retain(|n| (1..=number).contains(n));
            times.sort();
            times.dedup();
            for time in times {
                let errors = ERRORS.iter().filter(|error| **error > 0 || call == "write");
                for error in errors {
                    self.one(&format!("{call} {time} {error}"), closing);
                    faults += 1;
                }
            }
        }
        faults
    }

    fn one(&self, fault: &str, closing: &str) {
        let out = self.out();
        let output = self.run(&[("FAULT", fault)]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(fs::read(out.join("notes.txt")).unwrap(), b"mine", "{fault}");
        let is_whole = self.found() == self.wanted;
        if output.status.success() {
            assert!(is_whole, "{fault}: {said}");
            return;
        }
        // faults of scenes are shown with a cross
        let is_error = said.contains("error: ") || said.contains("× ");
        let named = is_error && said.contains(out.to_str().unwrap());
        assert!(named, "{fault}: {said}");
        if !is_whole {
            self.not_complete(fault, closing);
        }
        let again = self.words(&self.again);
        let again: Vec<&str> = again.iter().map(String::as_str).collect();
        expect(&looselink(&again), 0, "");
        assert!(self.found() == self.wanted, "{fault}");
        assert_eq!(fs::read(out.join("notes.txt")).unwrap(), b"mine", "{fault}");
    }

    /// What is not whole does not say that it is, unless it is the earlier result.
    fn not_complete(&self, fault: &str, closing: &str) {
        let closed = |folder: &Path| match closing {
            "summary.json" => is_whole(folder),
            _ => folder.join(closing).exists(),
        };
        let is_earlier = |folder: &Path| {
            let same = |name: &String| {
                fs::read(folder.join(name)).ok() == fs::read(self.before.join(name)).ok()
            };
            self.wanted.keys().all(same)
        };
        let (out, aside) = (self.out(), self.out().join(super::ASIDE));
        assert!(!closed(&out) || is_earlier(&out), "{fault}");
        assert!(
            !closed(self.before) || is_earlier(&out) || is_earlier(&aside),
            "{fault}"
        );
    }
}

fn is_whole(folder: &Path) -> bool {
    status(folder).as_deref() == Some("complete")
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// All files of a result that are the same when it is repeated.
fn repeatable(bytes: &Bytes) -> BTreeMap<String, Vec<u8>> {
    let files = super::FILES.iter().zip(bytes.repeatable());
    files
        .map(|(file, bytes)| ((*file).to_owned(), bytes.clone()))
        .collect()
}

fn notes(folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("notes.txt"), "mine").unwrap();
}

#[test]
fn runs_whose_calls_fail_leave_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let made = |name: &str, duration: &str| {
        expect(&looselink(&arguments(&at(name), &[duration])), 0, "");
        Bytes::of(&at(name))
    };
    let [short, new] = [made("short", SHORT), made("whole", NEW)];
    made("earlier", SHORTER);
    let run = |duration: &str, more: &[&str]| {
        owned(&arguments(
            Path::new("OUT"),
            &[&[duration][..], more].concat(),
        ))
    };
    notes(&at("nothing"));
    notes(&at("earlier"));
    notes(&at("stopped"));
    let mut child = start(&arguments(&at("stopped"), &[NEW]));
    let rows = at("stopped").join("channels.csv");
    while fs::metadata(&rows).map_or(0, |rows| rows.len()) < 10_000 {
        assert!(child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(1));
    }
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let resume = owned(&["resume", "OUT", "--quiet"]);
    let forced = run(SHORT, &["--force"]);
    let mut faults = 0;
    for (before, command, again, bytes) in [
        (
            "nothing",
            run(SHORT, &["--checkpoint", "0"]),
            forced.clone(),
            &short,
        ),
        ("earlier", forced.clone(), forced, &short),
        ("stopped", resume, run(NEW, &["--force"]), &new),
    ] {
        let trial = Trial {
            before: &at(before),
            command,
            again,
            wanted: repeatable(bytes),
            place: at("place"),
        };
        faults += trial.all("summary.json");
    }
    assert!(faults > 150, "{faults}");
}

#[test]
fn sweeps_whose_calls_fail_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let scene = Path::new(crate::command_line::TOP).join("scenes/pendulum.toml");
    let text = format!(
        "title = 'masses'\nscene = {scene:?}\nset = ['simulation.duration=0.02', 'output.interval=0.01']\n\
         parameters.mass = {{ fields = ['bodies.rod.mass'], values = [1.0, 2.0, 3.0] }}\n\
         measures.last = {{ of = 'last', channels = ['points.rod.bob.x'] }}\n"
    );
    fs::write(&study, &text).unwrap();
    let other = folder.path().join("other.toml");
    fs::write(&other, text.replace("3.0", "4.0")).unwrap();
    let [study, other] = [&study, &other].map(|path| path.to_str().unwrap());
    let at = |name: &str| folder.path().join(name);
    let sweep = owned(&["sweep", study, "--quiet", "--threads", "1", "--out", "OUT"]);
    let merge = owned(&["sweep", study, "--quiet", "--merge", "--out", "OUT"]);
    let shard = |out: &Path, index: &str| {
        let out = out.to_str().unwrap();
        expect(
            &looselink(&["sweep", study, "--shard", index, "--quiet", "--out", out]),
            0,
            "",
        );
    };
    notes(&at("nothing"));
    notes(&at("rows"));
    for index in ["1/2", "2/2"] {
        shard(&at("rows"), index);
    }
    notes(&at("some"));
    shard(&at("some"), "2/2");
    expect(
        &looselink(&[
            "sweep",
            study,
            "--quiet",
            "--out",
            at("whole").to_str().unwrap(),
        ]),
        0,
        "",
    );
    notes(&at("earlier"));
    let earlier = at("earlier");
    let made = [
        "sweep",
        other,
        "--quiet",
        "--out",
        earlier.to_str().unwrap(),
    ];
    expect(&looselink(&made), 0, "");
    let forced = [&sweep[..], &owned(&["--force"])].concat();
    let wanted = ["sweep.csv", "sweep.md", "sweep.svg", "sweep.json"];
    let wanted = wanted.map(|file| (file.to_owned(), fs::read(at("whole").join(file)).unwrap()));
    let mut faults = 0;
    for (before, command) in [
        ("nothing", &sweep),
        ("some", &sweep),
        ("rows", &merge),
        ("earlier", &forced),
    ] {
        let trial = Trial {
            before: &at(before),
            command: command.clone(),
            again: command.clone(),
            wanted: wanted.clone().into(),
            place: at("place"),
        };
        faults += trial.all("sweep.json");
    }
    assert!(faults > 100, "{faults}");
}
