//! The command line: exit codes, messages, and a result folder that is never damaged.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

const SCENE: &str = "scenes/bouncing-journal.toml";

/// The top of the project, where scenes are called `scenes/...`.
pub const TOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// The program, started at the top of the project.
pub fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_looselink"));
    command.current_dir(TOP);
    command
}

pub fn looselink(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// Interrupts a program as Ctrl-C does; it may have ended by itself.
#[cfg(unix)]
pub fn interrupt(child: &Child) {
    signal(child, "INT");
}

/// Sends a signal by its name.
pub fn signal(child: &Child, name: &str) {
    let process = child.id().to_string();
    let mut kill = Command::new("kill");
    let kill = kill.args(["-s", name, &process]).stderr(Stdio::null());
    kill.status().unwrap();
}

pub fn run(out: &Path, more: &[&str]) -> Output {
    let arguments = ["run", SCENE, "--out", out.to_str().unwrap()];
    looselink(&[&arguments, more].concat())
}

#[track_caller]
pub fn expect(output: &Output, code: i32, stderr: &str) {
    let shown = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{shown}");
    assert!(shown.contains(stderr), "`{stderr}` is not in\n{shown}");
}

pub fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

pub fn summary(folder: &Path) -> serde_json::Value {
    serde_json::from_str(&read(folder, "summary.json")).unwrap()
}

pub fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// All below a folder: the bytes of files, and where links point.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_symlink() {
            let target = fs::read_link(&path).unwrap();
            found.insert(path, target.into_os_string().into_encoded_bytes());
        } else if path.is_dir() {
            found.extend(contents(&path));
            found.insert(path, Vec::new());
        } else {
            found.insert(path.clone(), fs::read(path).unwrap());
        }
    }
    found
}

/// Copies a folder without links.
pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &to),
            false => drop(fs::copy(entry.path(), to).unwrap()),
        }
    }
}

#[test]
fn a_run_leaves_a_result() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/result");
    let output = run(&out, &["--set", "simulation.duration=2e-3"]);
    expect(&output, 0, "t = ");
    assert!(output.stdout.is_empty());
    assert_eq!(
        files(&out),
        [
            "channels.csv",
            "manifest.jsonl",
            "motion.bin",
            "onsets.csv",
            "scene.toml",
            "summary.json",
            "timing.json"
        ]
    );

    assert_eq!(
        read(&out, "scene.toml"),
        fs::read_to_string(Path::new(TOP).join(SCENE)).unwrap()
    );
    let summary = summary(&out);
    assert_eq!(summary["status"], "complete");
    assert_eq!(summary["overrides"][0], "simulation.duration=2e-3");
    assert_eq!(summary["scene_hash"].as_str().unwrap().len(), 64);
    assert_eq!(summary["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["onsets"], 1);
    let timing: serde_json::Value = serde_json::from_str(&read(&out, "timing.json")).unwrap();
    assert!(timing["wall_seconds"].as_f64().unwrap() > 0.0);
    assert!(timing["cpu_seconds"].as_f64().unwrap() > 0.0);

    let channels = read(&out, "channels.csv");
    let mut lines = channels.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header[0], "t [s]");
    assert!(header.contains(&"journal.x [m]"), "{header:?}");
    let rows: Vec<Vec<f64>> = lines
        .map(|l| l.split(',').map(|c| c.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 1251);
    assert!(rows.iter().all(|row| row.len() == header.len()));
    // The first onset of a free journal: c / v, to the onset tolerance over the speed.
    let onsets = read(&out, "onsets.csv");
    let mut lines = onsets.lines();
    assert_eq!(
        lines.next(),
        Some(
            "t [s],joint,impact_velocity [m/s],delta [m],angle [rad],deepest_penetration [m],largest_force [N],end [s],exit_velocity [m/s]"
        )
    );
    let onset: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(onset[1], "pin");
    assert!((onset[0].parse::<f64>().unwrap() - 1e-3).abs() < 1e-13 / 0.02 + 1e-15);
}

/// The cells of `onsets.csv` without the header.
fn contacts(folder: &Path) -> Vec<Vec<String>> {
    let text = read(folder, "onsets.csv");
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(str::to_owned).collect())
        .collect()
}

/// Every contact that closes is a row, in the order of the ends; those closed at the end of the run come last, without an
/// end. The first ones are those of the summary.
#[test]
fn every_contact_is_a_row_from_its_onset_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let scene = ["run", "scenes/3rrr/case3.toml", "--quiet", "--out"];
    let changes = ["simulation.duration=0.01", "integrator.step=1e-5"];
    let changes = changes.map(|change| ["--set", change]).concat();
    let at = [out.to_str().unwrap()];
    expect(&looselink(&[&scene[..], &at, &changes].concat()), 0, "");
    let (rows, summary) = (contacts(out), summary(out));
    assert_eq!(summary["onsets"].as_u64(), Some(rows.len() as u64));
    assert!(rows.len() > 30);
    let number = |cell: &String| cell.parse::<f64>().unwrap();
    let (ended, closed): (Vec<_>, Vec<_>) = rows.iter().partition(|row| !row[7].is_empty());
    assert_eq!(ended.len() as u64, summary["ended_contacts"]);
    assert!(rows.is_sorted_by_key(|row| row[7].is_empty()));
    assert!(closed.iter().all(|row| row[8].is_empty()));
    assert!(ended.is_sorted_by_key(|row| number(&row[7])));
    for row in &ended {
        assert!(
            number(&row[7]) > number(&row[0]) && number(&row[8]) > 0.0,
            "{row:?}"
        );
        assert!(
            number(&row[5]) > 0.0
                && number(&row[6]) > 0.0
                && number(&row[4]).abs() <= std::f64::consts::PI
        );
    }
    let mut by_onset: Vec<_> = rows.iter().collect();
    by_onset.sort_by(|a, b| number(&a[0]).total_cmp(&number(&b[0])));
    let impacts = summary["impacts"].as_array().unwrap();
    assert_eq!(impacts.len(), 10);
    let names = [
        "t",
        "joint",
        "impact_velocity",
        "delta",
        "angle",
        "deepest_penetration",
        "largest_force",
        "end",
        "exit_velocity",
    ];
    for (impact, row) in impacts.iter().zip(by_onset) {
        for (name, cell) in names.iter().zip(row) {
            match impact[name].as_f64() {
                // the reader of JSON is off by one in the last digit now and then
                Some(value) => assert!(
                    (value - number(cell)).abs() <= f64::EPSILON * value.abs(),
                    "{name} of {impact}"
                ),
                None => assert_eq!(impact[name].as_str(), Some(cell.as_str())),
            }
        }
    }
}

/// The journal touches after 1 ms and leaves 80 us later: the run ends in between.
#[test]
fn a_contact_that_is_closed_when_the_run_ends_has_no_end() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &["--set", "simulation.duration=1.04e-3"]), 0, "");
    let rows = contacts(out);
    assert_eq!(rows.len(), 1, "{rows:?}");
    assert_eq!((rows[0][7].as_str(), rows[0][8].as_str()), ("", ""));
    assert!((rows[0][0].parse::<f64>().unwrap() - 1e-3).abs() < 1e-11);
    let summary = summary(out);
    assert_eq!(
        (&summary["onsets"], &summary["ended_contacts"]),
        (&1.into(), &0.into())
    );
}

#[test]
fn a_repeated_run_differs_in_its_timing_only() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
    for out in [&first, &second] {
        expect(&run(out, &["--quiet"]), 0, "");
    }
    for file in [
        "channels.csv",
        "onsets.csv",
        "motion.bin",
        "scene.toml",
        "summary.json",
    ] {
        let bytes = [&first, &second].map(|out| fs::read(out.join(file)).unwrap());
        assert_eq!(bytes[0], bytes[1], "{file}");
    }
}

/// An accuracy on the command line replaces the step of the scene; a number without a key is the position.
#[test]
fn an_accuracy_replaces_the_step() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("controlled");
    let accuracy = ["--accuracy", "position=1e-8,horizon=0.02"];
    let output = run(&out, &accuracy);
    expect(
        &output,
        0,
        "accuracy: 1e-8 m over 0.02 s requested, steps from",
    );
    let control = &summary(&out)["accuracy"];
    assert_eq!(control["position"], 1e-8);
    assert!(control["rejected_steps"].as_u64() > Some(0));
    // the summary says for which motions, with impacts and without
    let holds = "the accuracy holds for motions that do not amplify errors; ";
    expect(
        &output,
        0,
        &format!("{holds}impacts do: compare with a run at position=1e-9\n"),
    );
    let pendulum = folder.path().join("pendulum");
    let arguments = ["run", "scenes/pendulum.toml", "--accuracy", "1e-6", "--out"];
    let output = looselink(&[&arguments[..], &[pendulum.to_str().unwrap()]].concat());
    let shows = format!("{holds}a run at position=1e-7 shows whether this one does\n");
    expect(&output, 0, &shows);
    for folder in [&out, &pendulum] {
        let holds_for = &summary(folder)["accuracy"]["holds_for"];
        assert_eq!(holds_for, "motions that do not amplify errors");
    }
    let stepped = folder.path().join("stepped");
    let output = run(&stepped, &["--set", "simulation.duration=2e-3"]);
    assert!(!String::from_utf8_lossy(&output.stderr).contains("the accuracy holds"));
    let inspect = |arguments: &[&str]| looselink(&[&["inspect"], arguments].concat());
    let output = inspect(&["scenes/pendulum.toml", "--accuracy", "1e-9"]);
    expect(&output, 0, "");
    assert!(
        String::from_utf8_lossy(&output.stdout).contains("with an accuracy of 1e-9 m over 10 s")
    );
    let output = inspect(&[SCENE, "--accuracy", "1e-9,horizon=0.02"]);
    expect(&output, 0, "");
    assert!(
        String::from_utf8_lossy(&output.stdout).contains("with an accuracy of 1e-9 m over 0.02 s")
    );
    let output = inspect(&[SCENE, "--accuracy", "1e-9"]);
    expect(&output, 2, "missing key `horizon` in integrator.accuracy");
    for (typed, message) in [
        ("1e-9 m", "`1e-9 m` lacks a key"),
        ("position=1nm", "`1nm` is not a number"),
        ("position=0,001", "`001` lacks a key"),
        ("positon=1e-6", "unknown key `positon`"),
    ] {
        let output = inspect(&[SCENE, "--accuracy", typed]);
        expect(&output, 2, message);
        expect(&output, 2, "for example `position=1e-9,horizon=0.01`");
    }
}

fn warnings(value: &serde_json::Value) -> Vec<String> {
    let list = value["warnings"].as_array().expect("a list of warnings");
    list.iter()
        .map(|w| w.as_str().unwrap().to_owned())
        .collect()
}

/// What `--quiet` leaves on standard error: the warnings, each on a line of its own.
#[track_caller]
fn expect_warnings(output: &Output, warnings: &[String]) {
    let lines = warnings.iter().map(|w| format!("warning: {w}\n"));
    let shown = String::from_utf8_lossy(&output.stderr);
    assert_eq!(shown, lines.collect::<String>());
}

#[test]
fn a_quiet_run_without_warnings_is_silent() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["--quiet"]);
    expect(&output, 0, "");
    assert!(output.stderr.is_empty() && output.stdout.is_empty());
    assert!(warnings(&summary(folder.path())).is_empty());
}

/// Steps that are too long for the contact, in a run that ends and in one that stops.
#[test]
fn a_quiet_run_shows_its_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let rough = ["--set", "integrator.step=1.6e-5", "--set"];
    let rows = "output.interval=1.6e-5";
    let quiet = [&rough[..], &[rows, "--quiet"]].concat();
    let out = folder.path().join("quiet");
    let output = run(&out, &quiet);
    expect(&output, 0, "");
    let reported = warnings(&summary(&out));
    assert!(!reported.is_empty());
    expect_warnings(&output, &reported);
    assert!(output.stdout.is_empty());

    let out = folder.path().join("loud");
    let output = run(&out, &[&rough[..], &[rows]].concat());
    for warning in &reported {
        expect(&output, 0, &format!("warning: {warning}\n"));
    }
    expect(&output, 0, "steps in ");

    let out = folder.path().join("stopped");
    let output = run(&out, &["--quiet", "--set", "bodies.journal.mass=1e-300"]);
    let reported = warnings(&summary(&out));
    assert!(!reported.is_empty());
    for warning in &reported {
        expect(&output, 3, &format!("warning: {warning}\n"));
    }
    expect(&output, 3, "error: the run cannot go on: ");
}

#[test]
fn a_quiet_study_shows_the_warnings_of_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("study");
    let study = ["precision", "studies/bouncing-journal.toml", "--smoke"];
    let output = looselink(&[&study[..], &["--quiet", "--out", out.to_str().unwrap()]].concat());
    expect(&output, 0, "");
    let found: serde_json::Value = serde_json::from_str(&read(&out, "precision.json")).unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    let page = read(&out, "precision.md");
    let mut count = 0;
    for run in found["runs"].as_array().unwrap() {
        for warning in warnings(run) {
            let named = format!(": {warning}\n");
            let curve = run["curve"].as_str().unwrap();
            let line = |line: &str| line.contains(curve) && line.ends_with(named.trim_end());
            assert!(stderr.lines().any(line), "{curve}{named}{stderr}");
            assert!(page.lines().any(line), "{curve}{named}{page}");
            count += 1;
        }
    }
    // backward Euler loses most of the energy
    assert!(count > 0 && stderr.lines().count() == count);
    assert!(stderr.lines().all(|line| line.starts_with("warning: ")));
}

#[test]
fn a_result_is_replaced_only_on_demand() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    expect(&run(out, &[]), 0, "");
    let before = ["channels.csv", "summary.json", "timing.json"].map(|file| read(out, file));

    expect(&run(out, &[]), 2, "holds a result already");
    expect(&run(out, &[]), 2, "--force");
    // A scene that cannot be read or run replaces nothing, not even on demand.
    expect(
        &run(out, &["--force", "--set", "integrator.step=-1"]),
        2,
        "greater than zero",
    );
    expect(
        &run(out, &["--force", "--set", "output.channels=[\"nothing\"]"]),
        2,
        "nothing",
    );
    let after = ["channels.csv", "summary.json", "timing.json"].map(|file| read(out, file));
    assert_eq!(before, after);

    expect(
        &run(out, &["--force", "--set", "simulation.duration=1e-3"]),
        0,
        "",
    );
    assert_eq!(summary(out)["overrides"][0], "simulation.duration=1e-3");
    assert!(read(out, "channels.csv").len() < before[0].len());
    assert_eq!(read(out, "notes.txt"), "mine");
}

#[test]
fn a_part_of_a_result_counts_as_one() {
    for file in [
        "channels.csv",
        "motion.bin",
        "onsets.csv",
        "scene.toml",
        "summary.json",
        "timing.json",
        "view.html",
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(file), "precious").unwrap();
        expect(&run(folder.path(), &[]), 2, file);
        assert_eq!(read(folder.path(), file), "precious");
        assert_eq!(files(folder.path()), [file]);
    }
}

#[test]
fn a_scene_may_be_run_again_from_its_result() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    expect(&run(folder.path(), &["--quiet"]), 0, "");
    let channels = read(folder.path(), "channels.csv");
    let scene = folder.path().join("scene.toml");
    expect(
        &looselink(&["run", scene.to_str().unwrap(), "--out", out, "--force"]),
        0,
        "",
    );
    assert_eq!(read(folder.path(), "channels.csv"), channels);
}

#[test]
fn bad_input_is_shown_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(Path::new(TOP).join(SCENE)).unwrap();
    let scene = folder.path().join("typo.toml");
    fs::write(&scene, text.replacen("restitution =", "restitutoin =", 1)).unwrap();
    let scene = scene.to_str().unwrap();
    let line = text
        .lines()
        .position(|l| l.starts_with("restitution"))
        .unwrap()
        + 1;
    for command in [
        &["check", scene][..],
        &["inspect", scene],
        &["run", scene, "--out", "unused"],
    ] {
        let output = looselink(command);
        expect(
            &output,
            2,
            "unknown key `restitutoin` in contacts.aluminium; did you mean `restitution`?",
        );
        expect(&output, 2, &format!("typo.toml:{line}:1"));
        assert!(output.stdout.is_empty());
    }
    assert!(!Path::new("unused").exists());
    expect(
        &looselink(&["check", SCENE, "--set", "integrator.stepp=1"]),
        2,
        "--set:1:12",
    );
    expect(&looselink(&["check", "absent.toml"]), 2, "absent.toml");
    expect(&looselink(&["check", "scenes"]), 2, "directory");
}

#[test]
fn usage_errors() {
    expect(&looselink(&[]), 2, "Usage");
    expect(&looselink(&["run", SCENE]), 2, "--out");
    expect(&looselink(&["fly"]), 2, "unrecognized subcommand");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    expect(&run(&file, &[]), 2, "is not a directory");
    // a negative number is a value, not an option
    expect(
        &looselink(&["modes", SCENE, "--at", "-1"]),
        2,
        "--at -1 lies outside the duration",
    );
    expect(
        &looselink(&["check", SCENE, "--accuracy", "-1e-3"]),
        2,
        "`integrator.accuracy.position` must be greater than zero, not -1e-3",
    );
}

#[test]
fn every_field_of_a_summary_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let accuracy = "position=1e-8,horizon=0.02";
    expect(&run(&out, &["--accuracy", accuracy]), 0, "");
    let page = fs::read_to_string(Path::new(TOP).join("docs/scene.md")).unwrap();
    let table = page.split("`summary.json` has the fields below").nth(1);
    let table = table.unwrap().split("\n\n").nth(1).unwrap();
    let summary = summary(&out);
    for field in summary.as_object().unwrap().keys() {
        let parts = summary[field]
            .as_object()
            .filter(|_| field == "integration");
        let parts = parts.map_or(vec![field.clone()], |parts| {
            let whole = |part: &String| format!("integration.{}", part.trim_end_matches("_of"));
            parts.keys().map(whole).collect()
        });
        for name in parts {
            assert!(table.contains(&format!("`{name}`")), "{name}");
        }
    }
}

const UNIT: &str = "warning: materials.aluminium.density is 2.7 kg/m3";

/// Before the run has taken its time, once, and in the summary.
#[test]
fn a_run_begins_with_questions_about_units() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let changes = [
        "--set",
        "materials.aluminium.density=2.7",
        "--set",
        "simulation.duration=2e-3",
    ];
    let output = run(&out, &changes);
    expect(&output, 0, UNIT);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.starts_with(UNIT) && said.matches(UNIT).count() == 1,
        "{said}"
    );
    let kept = warnings(&summary(&out));
    assert_eq!(kept.len(), 1, "{kept:?}");
    assert!(format!("warning: {}", kept[0]).starts_with(UNIT));
}

#[test]
fn check_and_inspect() {
    let output = looselink(&["check", SCENE]);
    expect(&output, 0, "");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        said.ends_with(": no error found; 1 degree of freedom, not driven\n"),
        "{said}"
    );
    assert!(output.stderr.is_empty());
    let output = looselink(&["check", SCENE, "--set", "materials.aluminium.density=2.7"]);
    expect(&output, 0, UNIT);
    let friction =
        "contacts.aluminium.friction={ law = \"ambrosio\", coefficient = 0.1, v1 = 2e-3 }";
    let output = looselink(&["inspect", SCENE, "--set", friction]);
    expect(&output, 0, "");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        text.contains("unknown coordinates   3, 3 of them independent\n"),
        "{text}"
    );
    assert!(text.contains("0.9132"), "{text}");
    assert!(text.contains("stiffness K = "), "{text}");
    let contact = "/m^1.5 (that of a sphere in a spherical cup, without the length of the pin), friction 0.1 with v0 = 0.0001 m/s, \
                   the default, and v1 = 0.002 m/s\n";
    assert!(text.contains(contact), "{text}");
    let output = looselink(&["inspect", "scenes/slider-crank/both.toml"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    // density times area times length: 7800 kg/m^3, 5 mm by 44.87 mm, 120 mm
    for line in [
        "rod                 0.21 kg, centre of mass at x = 0.11 m",
        "slider              0.14 kg",
        "motor               turns main: angle 0 rad, 0 degrees, speed 523.6 rad/s",
    ] {
        assert!(text.contains(line), "{text}");
    }
    let point = "drives.motor={ type = \"point\", point = \"slider.pin\", x = \"0.3 + t / 8\" }";
    let output = looselink(&["inspect", "scenes/harmonic-slider.toml", "--set", point]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = "motor               moves slider.pin: x = 0.3 m, speed 0.125 m/s";
    assert!(text.contains(line), "{text}");
    let output = looselink(&["inspect", SCENE, "--json"]);
    expect(&output, 0, "");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (json["unknowns"].as_u64(), json["contacts"].as_u64()),
        (Some(3), Some(1))
    );
    assert_eq!(json["freedoms"]["left"].as_u64(), Some(1));
}

/// Every scene of the project on one screen, and all of it with `--all`.
#[test]
fn an_inspection_fits_on_a_screen() {
    let shown = |scene: &str, more: &[&str]| {
        let output = looselink(&[&["inspect", scene], more].concat());
        expect(&output, 0, "");
        String::from_utf8(output.stdout).unwrap()
    };
    let folders = ["", "3rrr", "ablation", "hard", "slider-crank"].iter();
    let entries = folders.flat_map(|name| fs::read_dir(format!("{TOP}/scenes/{name}")).unwrap());
    let files = entries.map(|entry| entry.unwrap().path());
    let scenes: Vec<_> = files.filter(|path| path.extension().is_some()).collect();
    assert!(scenes.len() >= 40, "{} scenes", scenes.len());
    for scene in scenes.iter().filter_map(|path| path.to_str()) {
        if scene.ends_with(".md") {
            continue;
        }
        let text = shown(scene, &[]);
        assert!(text.lines().count() <= 40, "{scene}\n{text}");
        assert!(!text.contains("Channels\n"), "{scene}\n{text}");
        assert!(shown(scene, &["--all"]).contains("\nChannels\n  t [s]\n"));
    }
    let text = shown("scenes/3rrr/case4.toml", &[]);
    for line in [
        "  mobility              3 degrees of freedom, all of them driven\n",
        "  unknown coordinates   27, 27 of them independent\n",
        "  B1, B2, B3, C1, C2, C3 clearance 2e-5 m",
        "  B1, B2, B3, C1, C2, C3: lankarani_nikravesh with a restitution of 0.9 gives 0.9132",
        " more: --all\n",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let all = shown("scenes/3rrr/case4.toml", &["--all"]);
    assert!(
        all.contains("  contacts.pin.restitution = 0.9: not given"),
        "{all}"
    );
    assert!(!all.contains("more: --all"), "{all}");
}

/// The closing table has only what the scene has, in readable units, and `summary.json` has its numbers.
#[test]
fn a_run_closes_with_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let table = |scene: &str, duration: &str| {
        let folder = out.to_str().unwrap();
        let duration = format!("simulation.duration={duration}");
        let arguments = ["run", scene, "--force", "--out", folder, "--set", &duration];
        let output = looselink(&arguments);
        expect(&output, 0, " s after ");
        (String::from_utf8(output.stderr).unwrap(), summary(&out))
    };
    let (text, found) = table("scenes/3rrr/case4.toml", "0.004");
    let error = found["closing"]["errors"]["platform"]["position"]["largest"].as_f64();
    let error = format!(
        "error of platform        {}",
        numbers::si(error.unwrap(), "m")
    );
    for line in [
        &error,
        "angle error of platform",
        "force of B1 ",
        "torque in A1 ",
        "power in A1 ",
        "contact of C1: ",
        "% of the time in contact\n",
        "energy: ",
        ", the integrator ",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    let (text, _) = table("scenes/pendulum.toml", "0.5");
    for line in ["error of", "torque in", "power in", "contact of", "note: "] {
        assert!(!text.contains(line), "{line}\n{text}");
    }
    assert!(text.contains("of the energy of the motion\n"), "{text}");
    let (text, _) = table("scenes/slider-crank/loose.toml", "0.002");
    assert!(text.contains("note: the largest force of "), "{text}");
}

const ABLATION: &[&str] = &[
    "ablation.json",
    "ablation.md",
    #[cfg(feature = "png")]
    "ablation.png",
    "ablation.svg",
    "manifest.jsonl",
    "timing.json",
];

fn ablate(more: &[&str]) -> Output {
    let scene = "scenes/ablation/everything.toml";
    let short = ["--set", "simulation.duration=2e-3", "--runs", "1"];
    looselink(&[&["ablate", scene], &short[..], more].concat())
}

#[test]
fn an_ablation_leaves_tables_numbers_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
    let outputs = [&first, &second].map(|out| ablate(&["--out", out.to_str().unwrap()]));
    for (output, out) in outputs.iter().zip([&first, &second]) {
        expect(output, 0, "full scene");
        assert_eq!(files(out), ABLATION);
    }
    let text = String::from_utf8_lossy(&outputs[0].stdout).into_owned();
    for part in [
        "− clearance (and contact damping, friction)",
        "Processor time",
        "rocker",
    ] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
    // processor times differ; nothing else does
    for file in ["ablation.json", "ablation.md"] {
        assert_eq!(read(&first, file), read(&second, file), "{file}");
    }
    let ablation: serde_json::Value = serde_json::from_str(&read(&first, "ablation.json")).unwrap();
    let variants = ablation["variants"].as_array().unwrap();
    assert_eq!(variants.len(), 16);
    assert_eq!(variants[9]["removed"][2], "structural damping");
    assert!(variants[8]["physics"]["peak_joint_force"].as_f64().unwrap() > 0.0);
    assert_eq!(variants[8]["less_full_scene"]["rms_error"], 0.0);
    assert_eq!(ablation["overrides"][0], "simulation.duration=2e-3");
    let timing: serde_json::Value = serde_json::from_str(&read(&first, "timing.json")).unwrap();
    assert_eq!(timing["variants"][15]["variant"], "− gravity");
    assert!(
        timing["variants"][15]["microseconds_a_step"]
            .as_f64()
            .unwrap()
            > 0.0
    );

    let out = first.to_str().unwrap();
    expect(
        &ablate(&["--out", out]),
        2,
        "holds a result already (`ablation.json`)",
    );
    expect(&ablate(&["--out", out, "--force"]), 0, "");
}

#[test]
fn an_ablation_on_standard_output() {
    let output = ablate(&["--json", "--quiet", "--body", "coupler"]);
    expect(&output, 0, "");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // variants with the same effects share one run
    let mut reported = BTreeMap::new();
    for variant in json["ablation"]["variants"].as_array().unwrap() {
        let name = variant["variant"].as_str().unwrap();
        let named = warnings(variant)
            .into_iter()
            .map(|w| format!("{name}: {w}"));
        reported
            .entry(variant["effects"].to_string())
            .or_insert_with(|| named.collect::<Vec<_>>());
    }
    let stderr = String::from_utf8_lossy(&output.stderr);
    let mut shown: Vec<&str> = stderr.lines().collect();
    let mut reported: Vec<_> = reported.into_values().flatten().collect();
    reported
        .iter_mut()
        .for_each(|w| w.insert_str(0, "warning: "));
    shown.sort_unstable();
    reported.sort_unstable();
    assert!(!reported.is_empty(), "contacts of 2 ms in long steps");
    assert_eq!(shown, reported);
    assert_eq!(json["ablation"]["body"]["name"], "coupler");
    let table = ablate(&["--quiet", "--body", "coupler"]).stdout;
    let table = String::from_utf8_lossy(&table);
    assert!(table.contains("coupler from its path in the rigid ideal mechanism"));
    assert!(table.contains("µm"), "errors have SI prefixes: {table}");
    assert_eq!(json["timing"]["variants"][0]["runs"], 1);
    expect(
        &ablate(&["--body", "cuopler"]),
        2,
        "there are crank, coupler, rocker",
    );
    expect(
        &ablate(&["--set", "integrator.step=-1"]),
        2,
        "greater than zero",
    );
    expect(&ablate(&["--runs", "0"]), 2, "--runs");
    expect(&ablate(&["--force"]), 2, "--out");
}

#[test]
fn every_command_has_help_with_an_example() {
    for command in [
        &["--help"][..],
        &["run", "--help"],
        &["view", "--help"],
        &["plot", "--help"],
        &["inspect", "--help"],
        &["check", "--help"],
        &["ablate", "--help"],
        &["new", "--help"],
        &["completions", "--help"],
    ] {
        let output = looselink(command);
        expect(&output, 0, "");
        let help = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(help.contains("Example:\n  looselink "), "{help}");
    }
}

#[test]
fn a_run_that_cannot_go_on_keeps_what_it_has() {
    let folder = tempfile::tempdir().unwrap();
    // A body without mass flies freely up to its first contact, whose force no step is short enough for.
    let output = run(folder.path(), &["--set", "bodies.journal.mass=1e-300"]);
    expect(&output, 3, "the run cannot go on: journal.");
    expect(&output, 3, "the results up to that time are in");
    let summary = summary(folder.path());
    assert_eq!(summary["status"], "failed");
    assert!(summary["error"].as_str().unwrap().contains(" at t = "));
    // The bearing is reached after 1 ms at 1.6 us a row.
    assert!(read(folder.path(), "channels.csv").lines().count() > 625);
}

#[cfg(unix)]
mod unix {
    use super::*;

    /// What cannot be printed is an error of the system; a reader that has gone away is none.
    #[test]
    fn standard_output_may_be_full_or_closed() {
        let program = assert_cmd::cargo::cargo_bin("looselink");
        let inspect = |target: &str| {
            let line = format!("\"$0\" inspect {SCENE} {target}");
            let mut shell = Command::new("bash");
            shell.args(["-o", "pipefail", "-c", &line]).arg(&program);
            shell.current_dir(TOP);
            shell.output().unwrap()
        };
        expect(
            &inspect("> /dev/full"),
            1,
            "cannot write to standard output",
        );
        expect(&inspect("| true"), 0, "");
    }

    use std::io::Read;
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    #[test]
    fn an_interrupted_run_is_readable_and_marked() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        let mut child = program()
            .args([
                "run",
                "scenes/3rrr/case4.toml",
                "--out",
                out.to_str().unwrap(),
            ])
            .args(["--set", "simulation.duration=1e4"])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Rows appear on disk while it runs.
        let limit = Instant::now() + Duration::from_secs(60);
        while fs::metadata(out.join("channels.csv")).map_or(0, |m| m.len()) < 10_000 {
            assert!(Instant::now() < limit, "no rows after a minute");
            std::thread::sleep(Duration::from_millis(20));
        }
        assert_eq!(summary(out)["status"], "incomplete");
        interrupt(&child);
        let mut stderr = String::new();
        child
            .stderr
            .take()
            .unwrap()
            .read_to_string(&mut stderr)
            .unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(130), "{stderr}");
        assert!(stderr.contains("interrupted at t = "), "{stderr}");
        let summary = summary(out);
        assert_eq!(summary["status"], "incomplete");
        assert!(summary["steps"].as_u64().unwrap() > 0);
        let channels = read(out, "channels.csv");
        let width = channels.lines().next().unwrap().split(',').count();
        assert!(
            channels.ends_with('\n') && channels.lines().all(|l| l.split(',').count() == width)
        );
    }
}
