//! Runs that are interrupted or killed, and resumed.

use super::{COMPLETE, FILES, Random, rounds, start, twice};
use crate::command_line::{expect, files, interrupt, looselink, program, read, signal};
use looselink::output::StoredCheckpoint;
use numbers::hexadecimal;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Output, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Scenes with contacts, flexible links and springs, cut to some tenths of a second of processor time.
const SCENES: [(&str, &str, &str); 3] = [
    ("scenes/3rrr/case3.toml", "0.1", "5e-6"),
    ("scenes/3rrr/case4.toml", "0.06", "5e-6"),
    ("scenes/four-bar-three-loose.toml", "0.1", "5e-6"),
];
/// Methods, with equal steps and with an accuracy.
const METHODS: [&str; 4] = [
    "{method=\"bathe\",newton_tolerance=1e-10,onset_tolerance=1e-12,step=STEP}",
    "{method=\"generalized_alpha\",spectral_radius=0.8,newton_tolerance=1e-10,onset_tolerance=1e-12,step=STEP}",
    "{method=\"trapezoidal\",newton_tolerance=1e-10,onset_tolerance=1e-12,accuracy={position=1e-6,energy=1e-6,horizon=0.01}}",
    "{method=\"dormand_prince\",onset_tolerance=1e-12,accuracy={position=1e-7,horizon=0.01}}",
];
/// Interruptions of every scene with every method.
const INTERRUPTIONS: usize = 5;

/// What ends a run: Ctrl-C, a kill, a request to end, the end of the terminal.
const SIGNALS: [&str; 4] = ["INT", "KILL", "TERM", "HUP"];

/// Sends a signal after a time; true if the program has ended by itself before.
fn stop(mut child: Child, after: Duration, name: &str) -> bool {
    std::thread::sleep(after);
    signal(&child, name);
    let status = child.wait().unwrap();
    // a signal ends a program that does not watch for it yet
    let stopped = status.code() == Some(130) || status.signal().is_some();
    assert!(stopped || status.success(), "{status}");
    status.success()
}

/// All files of a result but the timing, which differs when a run is repeated.
fn result(folder: &Path) -> Vec<(&'static str, Vec<u8>)> {
    let repeatable = FILES.iter().filter(|file| **file != "timing.json");
    let bytes = |file| fs::read(folder.join(file)).unwrap();
    repeatable.map(|file| (*file, bytes(file))).collect()
}

/// A run of a scene, and the same run with interruptions; returns how many of them came before its end, and how many times
/// it was resumed.
fn check(folder: &Path, changes: [&str; 3], scene: &str, random: &mut Random) -> [usize; 2] {
    let [whole, parts] = ["whole", "parts"].map(|part| folder.join(part));
    let options = ["--quiet", "--checkpoint", "0"];
    let run = |out| {
        let changes = changes.iter().flat_map(|change| ["--set", change]);
        let arguments = ["run", scene, "--force", "--out", path(out)];
        let arguments = arguments.into_iter().chain(options).chain(changes);
        arguments.collect::<Vec<_>>()
    };
    let began = Instant::now();
    expect(&looselink(&run(&whole)), 0, "");
    let time = began.elapsed();
    let resume = [&["resume", path(&parts)], &options[..]].concat();
    let next = || match parts.join("checkpoint.bin").exists() {
        true => resume.clone(),
        false => run(&parts),
    };
    let [mut stops, mut resumed] = [0; 2];
    for k in 0..INTERRUPTIONS {
        let arguments = next();
        resumed += usize::from(arguments[0] == "resume");
        // together less than the run takes, also where the processor is slower for a while
        let after = time.mul_f64(random.uniform() * 0.8 / INTERRUPTIONS as f64);
        if stop(start(&arguments), after, SIGNALS[k % 4]) {
            break;
        }
        stops += 1;
    }
    if stops == INTERRUPTIONS {
        let arguments = next();
        resumed += usize::from(arguments[0] == "resume");
        expect(&looselink(&arguments), 0, "");
    }
    assert!(result(&parts) == result(&whole), "{scene} {changes:?}");
    assert_eq!(files(&parts), COMPLETE);
    [stops, resumed]
}

fn path(folder: &Path) -> &str {
    folder.to_str().unwrap()
}

#[test]
fn runs_that_are_stopped_at_random_instants_end_with_the_bytes_of_whole_ones() {
    let counts = Mutex::new([0; 2]);
    twice(|thread| {
        let mut random = Random(20 + thread);
        let methods = METHODS.iter().skip(thread as usize).step_by(2);
        for method in methods.cycle().take(rounds(1, 5) * METHODS.len() / 2) {
            for (scene, duration, step) in SCENES {
                let folder = tempfile::tempdir().unwrap();
                let integrator = format!("integrator={}", method.replace("STEP", step));
                let duration = format!("simulation.duration={duration}");
                let changes = [&integrator, "assumptions={}", &duration];
                let found = check(folder.path(), changes, scene, &mut random);
                let mut counts = counts.lock().unwrap();
                counts.iter_mut().zip(found).for_each(|(sum, n)| *sum += n);
            }
        }
    });
    let [stops, resumed] = counts.into_inner().unwrap();
    // a run whose processor was free meanwhile may end before its interruptions; most do not
    let half = rounds(1, 5) * METHODS.len() * SCENES.len() * INTERRUPTIONS / 2;
    assert!(stops.min(resumed) >= half, "{stops} {resumed}");
}

/// A run that is interrupted when it has recorded some rows.
fn interrupted(out: &Path) -> Output {
    let run = ["run", SCENES[0].0, "--quiet", "--out", path(out)];
    let child = program().args(run).stderr(Stdio::piped()).spawn().unwrap();
    let began = Instant::now();
    while !fs::read(out.join("channels.csv")).is_ok_and(|rows| rows.len() > 10_000) {
        assert!(began.elapsed() < Duration::from_secs(60), "no rows");
        std::thread::sleep(Duration::from_millis(1));
    }
    interrupt(&child);
    child.wait_with_output().unwrap()
}

#[test]
fn what_cannot_be_resumed_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("the run");
    let resume = || looselink(&["resume", path(&out)]);
    expect(&resume(), 2, "it has no `summary.json`, so there is no run");
    let stopped = interrupted(&out);
    let hint = format!(
        "`looselink resume '{}'` goes on from its last checkpoint",
        path(&out)
    );
    expect(&stopped, 130, &hint);

    let file = |name: &str| out.join(name);
    let refused = |name: &str, bytes: &[u8], message: &str| {
        let was = fs::read(file(name)).unwrap();
        fs::write(file(name), bytes).unwrap();
        let before = result(&out);
        expect(&resume(), 2, message);
        assert!(result(&out) == before, "{message}");
        fs::write(file(name), was).unwrap();
    };
    let scene = read(&out, "scene.toml") + "\n";
    let changed = format!(
        "`{}` has been changed since it began",
        path(&file("scene.toml"))
    );
    refused("scene.toml", scene.as_bytes(), &changed);

    let checkpoint = fs::read(file("checkpoint.bin")).unwrap();
    let damaged = "`checkpoint.bin` is damaged";
    refused(
        "checkpoint.bin",
        &checkpoint[..checkpoint.len() - 1],
        damaged,
    );
    refused("checkpoint.bin", &checkpoint[..100], damaged);
    // every bit of what it belongs to
    let lines: Vec<_> = checkpoint.splitn(3, |byte| *byte == b'\n').collect();
    let header = lines[0].len() + 1 + lines[1].len() + 1;
    for bit in 0..8 * header {
        let mut flipped = checkpoint.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        fs::write(file("checkpoint.bin"), &flipped).unwrap();
        let read = StoredCheckpoint::read(&out, view::kind());
        assert!(read.is_err(), "bit {bit} of the header");
    }
    fs::write(file("checkpoint.bin"), &checkpoint).unwrap();
    let text = |part: &[u8]| String::from_utf8(part.to_vec()).unwrap();
    let mut of_another: Value = serde_json::from_str(&text(lines[1])).unwrap();
    of_another["program"] = "0123456789abcdef".into();
    let followed = [of_another.to_string().as_bytes(), b"\n", lines[2]].concat();
    let digest = hexadecimal(&Sha256::digest(&followed));
    let other = [digest.as_bytes(), b"\n", &followed].concat();
    let message =
        "it was begun by another program (looselink 0.1.0 with SHA-256 0123456789ab...; this is";
    refused("checkpoint.bin", &other, message);
    // one of an earlier version
    refused("checkpoint.bin", &followed, "an earlier version");

    let mut random = Random(5);
    for table in ["channels.csv", "motion.bin"] {
        let rows = fs::read(file(table)).unwrap();
        let message = format!("`{}` has lost rows", path(&file(table)));
        refused(table, &rows[..rows.len() / 2], &message);
        // what comes after the checkpoint does not count, and may be half of a second
        let before = rows.len() / 4;
        for _ in 0..rounds(20, 250) {
            let mut flipped = rows.clone();
            let bit = (random.uniform() * 8.0 * before as f64) as usize;
            flipped[bit / 8] ^= 1 << (bit % 8);
            refused(table, &flipped, &message);
        }
    }

    let rows = file("channels.csv");
    let away = out.join("away");
    fs::rename(&rows, &away).unwrap();
    expect(
        &resume(),
        2,
        &format!("`{}` is missing; `looselink run`", path(&rows)),
    );
    fs::rename(&away, &rows).unwrap();
    let again = looselink(&["run", SCENES[0].0, "--out", path(&out)]);
    let hint = format!("`looselink resume '{}'` goes on with the run", path(&out));
    expect(&again, 2, &hint);
    // another run holds the folder
    let held = fs::File::open(file("manifest.jsonl")).unwrap();
    held.lock().unwrap();
    expect(&resume(), 2, "another looselink is writing to");
    drop(held);

    fs::remove_file(file("checkpoint.bin")).unwrap();
    expect(&resume(), 2, "it was stopped before its first checkpoint");
    fs::write(file("checkpoint.bin"), checkpoint).unwrap();
    expect(&resume(), 0, "resumed at t = ");
    expect(&resume(), 2, "it is complete");
}
