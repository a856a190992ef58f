//! Files that are not the program's, and links: they are never replaced, extended, deleted or followed.

use super::{ASIDE, COMPLETE, EARLIER, NEW, arguments, whole};
use crate::command_line::{TOP, contents, expect, files, looselink, read};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

/// A command that is refused changes nothing.
#[track_caller]
pub(super) fn refused(folder: &Path, command: &[&str], why: &str) {
    let before = contents(folder);
    expect(&looselink(command), 2, why);
    assert!(contents(folder) == before, "{command:?}");
}

/// The same, and not even for a moment.
#[track_caller]
fn untouched(folder: &Path, command: &[&str], why: &str) {
    let changed = || fs::metadata(folder).unwrap().modified().unwrap();
    let before = changed();
    refused(folder, command, why);
    assert_eq!(changed(), before, "{command:?}");
}

/// A command that may wait for ever, and is ended then.
fn impatient(before: &str, command: &[&str]) -> Output {
    let looselink = env!("CARGO_BIN_EXE_looselink");
    let script = format!("{before} exec timeout 20 {looselink} {}", command.join(" "));
    let mut shell = Command::new("sh");
    shell
        .current_dir(TOP)
        .args(["-c", &script])
        .output()
        .unwrap()
}

pub(super) fn study(folder: &Path, title: &str, masses: &str) -> String {
    let scene = Path::new(TOP).join("scenes/pendulum.toml");
    let path = folder.join("study.txt");
    let text = format!(
        "title = '{title}'\nscene = {scene:?}\nset = ['simulation.duration=0.02', 'output.interval=0.01']\n\
         parameters.mass = {{ fields = ['bodies.rod.mass'], values = {masses} }}\n\
         measures.last = {{ of = 'last', channels = ['points.rod.bob.x'] }}\n"
    );
    fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn files_of_the_user_are_not_replaced_by_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    for name in [
        "scene.toml",
        "summary.json",
        "channels.csv",
        "channels.jsonl",
        "onsets.jsonl",
        "motion.bin",
        "timing.json",
        "checkpoint.bin",
        "view.html",
        "manifest.jsonl",
    ] {
        fs::write(out.join(name), "mine").unwrap();
        for force in [&[NEW][..], &[NEW, "--force"]] {
            untouched(
                out,
                &arguments(out, force),
                &format!("{name}` is not a file of this program"),
            );
        }
        fs::remove_file(out.join(name)).unwrap();
    }
    // beside a result too
    whole(out, EARLIER);
    fs::write(out.join("channels.jsonl"), "mine").unwrap();
    fs::write(out.join("view.html"), "mine").unwrap();
    untouched(
        out,
        &arguments(out, &[NEW, "--force"]),
        "channels.jsonl` is not a file of this program",
    );
    untouched(
        out,
        &["view", out.to_str().unwrap()],
        "view.html` is not a file of this program",
    );
    fs::remove_file(out.join("channels.jsonl")).unwrap();
    fs::remove_file(out.join("view.html")).unwrap();
    // what stands aside, and what somebody has put there
    for (make, why) in [
        (
            (|aside| symlink("/etc", aside).unwrap()) as fn(&Path),
            "previous-result` is not a directory",
        ),
        (
            |aside| fs::write(aside, "mine").unwrap(),
            "previous-result` is not a directory",
        ),
        (
            |aside| {
                fs::create_dir(aside).unwrap();
                fs::write(aside.join("scene.toml"), "mine").unwrap();
            },
            "scene.toml` is not a file of this program",
        ),
    ] {
        make(&out.join(ASIDE));
        untouched(out, &arguments(out, &[NEW, "--force"]), why);
        let _ = fs::remove_file(out.join(ASIDE)).or_else(|_| fs::remove_dir_all(out.join(ASIDE)));
    }
    expect(&looselink(&arguments(out, &[NEW, "--force"])), 0, "");
    assert_eq!(files(out), COMPLETE);
}

/// A folder with the name of one that a killed program has left, and one that it has left.
#[test]
fn folders_of_the_user_are_not_taken_for_leftovers() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let [mine, left] = [".looselink-abcdef.tmp", ".looselink-ABCDEF.tmp"].map(|f| out.join(f));
    fs::create_dir(&mine).unwrap();
    fs::write(mine.join("summary.json"), "mine").unwrap();
    whole(out, EARLIER);
    fs::create_dir(&left).unwrap();
    for name in ["manifest.jsonl", "summary.json"] {
        fs::copy(out.join(name), left.join(name)).unwrap();
    }
    whole(&left.join("inner"), EARLIER);
    expect(&looselink(&arguments(out, &[NEW, "--force"])), 0, "");
    assert_eq!(read(&mine, "summary.json"), "mine");
    // what is not the program's stays
    assert_eq!(files(&left), ["inner"]);
    fs::remove_dir_all(left.join("inner")).unwrap();
    expect(&looselink(&arguments(out, &[NEW, "--force"])), 0, "");
    assert!(!left.exists() && mine.exists());
}

/// A refused command leaves no folder, no manifest, nothing.
#[test]
fn a_refusal_has_no_side_effects() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let out = here.join("a/b/out");
    let name = out.to_str().unwrap();
    let study = study(here, "masses", "[1.0, -2.0, 'x']");
    let commands: [&[&str]; 5] = [
        &[
            "run",
            "scenes/pendulum.toml",
            "--set",
            "integrator.step=-1",
            "--out",
            name,
        ],
        &[
            "ablate",
            "scenes/pendulum.toml",
            "--body",
            "nobody",
            "--out",
            name,
        ],
        &["precision", "scenes/pendulum.toml", "--out", name],
        &["sweep", &study, "--out", name],
        &["resume", name],
    ];
    for command in commands {
        refused(here, command, "");
    }
}

#[test]
fn files_of_the_user_are_not_touched_by_a_sweep() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path(), "masses", "[1.0, 2.0]");
    let out = folder.path().join("out");
    let sweep = |more: &[&str]| {
        let words = [
            &["sweep", &study, "--quiet", "--out", out.to_str().unwrap()],
            more,
        ]
        .concat();
        words.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let refused = |more: &[&str], why: &str| {
        let words = sweep(more);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        refused(&out, &words, why);
    };
    let made = |more: &[&str]| {
        let words = sweep(more);
        expect(
            &looselink(&words.iter().map(String::as_str).collect::<Vec<_>>()),
            0,
            "",
        );
    };
    fs::create_dir(&out).unwrap();
    // also a table that this sweep does not have
    for name in ["points.csv", "envelopes.csv", "sweep.md", "times.csv"] {
        fs::write(out.join(name), "mine").unwrap();
        for more in [&[][..], &["--force"]] {
            refused(more, &format!("{name}` is not a file of this program"));
        }
        fs::remove_file(out.join(name)).unwrap();
    }
    made(&[]);
    fs::write(out.join("runs-1-of-2.jsonl"), "mine\n").unwrap();
    refused(
        &["--force"],
        "runs-1-of-2.jsonl` is not a file of this program",
    );
    refused(&[], "it holds no rows of a sweep");
    fs::remove_file(out.join("runs-1-of-2.jsonl")).unwrap();
    // names that are nearly those of rows
    for name in ["runs-old.jsonl", "runs-3-of-2.jsonl", "runs-01-of-2.jsonl"] {
        fs::write(out.join(name), "mine").unwrap();
    }
    made(&["--force"]);
    assert_eq!(read(&out, "runs-old.jsonl"), "mine");

    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    for name in [
        "sweep.md",
        "sweep.csv",
        "times.csv",
        "times.jsonl",
        "runs.jsonl",
        "manifest.jsonl",
    ] {
        fs::write(other.join(name), "mine").unwrap();
        let words = ["sweep", &study, "--quiet", "--out", other.to_str().unwrap()];
        let output = looselink(&words);
        expect(&output, 2, name);
        assert_eq!(read(&other, name), "mine");
        let _ = fs::remove_dir_all(&other);
        fs::create_dir(&other).unwrap();
    }
}

/// Another study is refused and leaves nothing; a corrected title is the same one.
#[test]
fn a_refused_sweep_leaves_the_folder_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let name = out.to_str().unwrap();
    let first = study(folder.path(), "masses", "[1.0, 2.0]");
    expect(
        &looselink(&["sweep", &first, "--quiet", "--shard", "1/2", "--out", name]),
        0,
        "",
    );
    let other = study(folder.path(), "masses", "[1.0, 3.0]");
    for more in [&[][..], &["--shard", "2/2"], &["--merge"]] {
        let words = [&["sweep", &other, "--quiet", "--out", name], more].concat();
        refused(&out, &words, "it holds rows of another study");
    }
    let corrected = study(folder.path(), "Masses", "[1.0, 2.0]");
    expect(
        &looselink(&[
            "sweep", &corrected, "--quiet", "--shard", "2/2", "--out", name,
        ]),
        0,
        "",
    );
    expect(
        &looselink(&["sweep", &corrected, "--quiet", "--merge", "--out", name]),
        0,
        "",
    );
    assert!(read(&out, "sweep.md").starts_with("# Masses"));
}

/// Wherever a link stands, what it points at stays; a file of the user that a new file would replace is another matter.
#[test]
fn links_are_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("target");
    fs::write(&target, "mine").unwrap();
    let study = study(folder.path(), "masses", "[1.0, 2.0]");
    let out = folder.path().join("out");
    let name = out.to_str().unwrap();
    let page = out.join("page.html");
    let sweep: &[&str] = &["sweep", &study, "--quiet", "--out", name];
    let brief = [
        "run",
        "scenes/pendulum.toml",
        "--quiet",
        "--set",
        "simulation.duration=0.02",
        "--out",
        name,
    ];
    let run: &[&str] = &brief;
    let made = [run, sweep];
    for command in made {
        fs::create_dir(&out).unwrap();
        expect(&looselink(command), 0, "");
        let names = [
            files(&out),
            vec!["view.html".to_owned(), "checkpoint.bin".to_owned()],
        ]
        .concat();
        for link in names {
            for first in [true, false] {
                fs::remove_dir_all(&out).unwrap();
                fs::create_dir(&out).unwrap();
                if !first {
                    expect(&looselink(command), 0, "");
                    let _ = fs::remove_file(out.join(&link));
                }
                symlink(&target, out.join(&link)).unwrap();
                let forced = [command, &["--force"]].concat();
                let more: [&[&str]; 4] = [
                    command,
                    &forced,
                    &["view", name],
                    &["view", name, "-o", page.to_str().unwrap()],
                ];
                for command in more {
                    looselink(command);
                    assert_eq!(fs::read(&target).unwrap(), b"mine", "{link} {command:?}");
                    assert!(target.is_file() && !target.is_symlink());
                }
            }
        }
        fs::remove_dir_all(&out).unwrap();
    }
    // the file that the user names: its link is replaced
    let picture = folder.path().join("picture.svg");
    symlink(&target, &picture).unwrap();
    fs::create_dir(&out).unwrap();
    expect(&looselink(run), 0, "");
    let plot = [
        "plot",
        name,
        "--channels",
        "points.*",
        "-o",
        picture.to_str().unwrap(),
    ];
    expect(&looselink(&plot), 0, "");
    assert_eq!(fs::read(&target).unwrap(), b"mine");
    assert!(!picture.is_symlink() && read(folder.path(), "picture.svg").contains("<svg"));
}

/// Rows with a flipped bit are refused, and a damaged time is no loss.
#[test]
fn damaged_rows_of_sweeps_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let study = study(folder.path(), "masses", "[1.0, 2.0, 3.0]");
    let out = folder.path().join("out");
    let sweep = |more: &[&str]| {
        looselink(
            &[
                &["sweep", &study, "--quiet", "--out", out.to_str().unwrap()],
                more,
            ]
            .concat(),
        )
    };
    expect(&sweep(&[]), 0, "");
    let table = fs::read(out.join("sweep.csv")).unwrap();
    let path = out.join("runs.jsonl");
    let rows = fs::read(&path).unwrap();
    let mut random = super::Random(6);
    for _ in 0..super::rounds(30, 500) {
        let bit = (random.uniform() * 8.0 * rows.len() as f64) as usize;
        let mut flipped = rows.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        fs::write(&path, &flipped).unwrap();
        let output = sweep(&["--merge"]);
        // without its last line feed a file looks as if a kill had cut it
        let why = if bit / 8 == rows.len() - 1 {
            "have not been made"
        } else {
            "runs.jsonl`: "
        };
        expect(&output, 2, why);
    }
    fs::write(&path, &rows).unwrap();
    let times = out.join("times.jsonl");
    let mut damaged = fs::read(&times).unwrap();
    damaged[3] = 0xff;
    fs::write(&times, damaged).unwrap();
    expect(&sweep(&["--merge"]), 0, "");
    assert_eq!(fs::read(out.join("sweep.csv")).unwrap(), table);
    assert_eq!(read(&out, "times.csv").lines().count(), 3);
}

fn into<'a>(command: &[&'a str], out: &'a Path) -> Vec<&'a str> {
    [command, &[out.to_str().unwrap()]].concat()
}

/// A copy of a folder whose files are those of the folder.
fn linked(folder: &Path, copy: &Path) {
    fs::create_dir(copy).unwrap();
    for name in files(folder) {
        fs::hard_link(folder.join(&name), copy.join(name)).unwrap();
    }
}

#[test]
fn files_with_a_second_name_are_not_changed() {
    let folder = tempfile::tempdir().unwrap();
    let [run, sweep] = ["run", "sweep"].map(|name| folder.path().join(name));
    whole(&run, EARLIER);
    let study = study(folder.path(), "masses", "[1.0, 2.0]");
    let swept = ["sweep", &study, "--quiet", "--out"];
    expect(&looselink(&into(&swept, &sweep)), 0, "");
    let copies = [&run, &sweep].map(|folder| folder.with_extension("copy"));
    linked(&run, &copies[0]);
    linked(&sweep, &copies[1]);
    let before = contents(folder.path());
    let again = [&swept[..3], &["--force", "--out"]].concat();
    for command in [
        arguments(&copies[0], &[NEW, "--force"]),
        into(&["view"], &copies[0]),
        into(&["resume"], &copies[0]),
        into(&swept, &copies[1]),
        into(&again, &copies[1]),
    ] {
        expect(
            &looselink(&command),
            2,
            "it has a second name (a hard link)",
        );
        assert!(contents(folder.path()) == before, "{command:?}");
    }
}

/// A pipe that nobody writes to, and a file that never ends.
#[test]
fn what_is_no_file_is_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let pipe = folder.path().join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let picture = folder.path().join("picture.svg");
    let [place, picture] = [&out, &picture].map(|path| path.to_str().unwrap());
    let commands: [&[&str]; 4] = [
        &["view", place],
        &["plot", place, "--channels", "t", "-o", picture],
        &["resume", place],
        &[
            "run",
            "scenes/pendulum.toml",
            "--quiet",
            "--force",
            "--out",
            place,
        ],
    ];
    for name in COMPLETE {
        for target in [&pipe, Path::new("/dev/zero")] {
            for command in commands {
                whole(&out, EARLIER);
                fs::remove_file(out.join(name)).unwrap();
                // pipes have second names as files have
                let made = fs::hard_link(target, out.join(name));
                made.or_else(|_| symlink(target, out.join(name))).unwrap();
                let code = impatient("", command).status.code();
                assert!(matches!(code, Some(0..=2)), "{name} {command:?}: {code:?}");
                fs::remove_dir_all(&out).unwrap();
            }
        }
    }
}

/// Not replaced by a picture or page either, nor behind a link.
#[test]
fn what_is_no_file_is_no_place_for_an_output() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    whole(&out, EARLIER);
    let pipe = folder.path().join("pipe.svg");
    let [place, pipe] = [&out, &pipe].map(|p| p.to_str().unwrap());
    let made = Command::new("mkfifo").arg(pipe).status().unwrap();
    assert!(made.success());
    let [link, page] = ["link.svg", "page.html"].map(|f| folder.path().join(f));
    symlink("/dev/null", &link).unwrap();
    symlink("pipe.svg", &page).unwrap();
    let [link, page] = [&link, &page].map(|p| p.to_str().unwrap());
    let plot = |to| looselink(&["plot", place, "--channels", "error.x", "-o", to]);
    for output in [
        plot(pipe),
        plot(link),
        looselink(&["view", place, "-o", page]),
    ] {
        expect(&output, 2, "` is not a file");
    }
    assert_eq!(
        files(folder.path()),
        ["link.svg", "out", "page.html", "pipe.svg"]
    );
    assert!(fs::read_link(link).is_ok() && fs::read_link(page).is_ok());
    assert!(!fs::metadata(pipe).unwrap().is_file());
}

#[test]
fn a_program_that_may_open_no_more_files_says_so() {
    let folder = tempfile::tempdir().unwrap();
    for most in 3..=12 {
        let out = folder.path().join(most.to_string());
        let [out, duration] = [out.to_str().unwrap(), "simulation.duration=0.01"];
        let set = [
            "--set",
            duration,
            "--set",
            "output.interval=0.01",
            "--out",
            out,
        ];
        let run = [&["run", "scenes/pendulum.toml", "--quiet"], &set[..]].concat();
        let output = impatient(&format!("ulimit -n {most};"), &run);
        if !output.status.success() && most > 4 {
            expect(&output, 1, "Too many open files");
        }
    }
}
