//! Runs that are killed, that find no room, that may not write: what is on disk is readable and says what it is, and an
//! earlier result is whole, in its place or aside.
#![cfg(unix)]

mod contended;
mod faults;
mod foreign;
mod killed;
mod listed;
mod no_room;
mod replaced;
mod resumed;
mod swept;

use crate::command_line::{expect, looselink, program, read};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A run with contact whose rows reach the disk all along.
const RUN: [&str; 8] = [
    "run",
    "scenes/3rrr/case3.toml",
    "--quiet",
    "--set",
    "integrator.step=1e-5",
    "--set",
    "output.interval=1e-5",
    "--set",
];
const NEW: &str = "simulation.duration=0.04";
const EARLIER: &str = "simulation.duration=0.02";

const FILES: [&str; 6] = [
    "channels.csv",
    "motion.bin",
    "onsets.csv",
    "scene.toml",
    "summary.json",
    "timing.json",
];
/// The folder of a complete result.
const COMPLETE: [&str; 7] = [
    "channels.csv",
    "manifest.jsonl",
    "motion.bin",
    "onsets.csv",
    "scene.toml",
    "summary.json",
    "timing.json",
];
const ASIDE: &str = "previous-result";

/// Sebastiano Vigna's splitmix64: the same instants every time.
struct Random(u64);

impl Random {
    /// Uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A moment of a run that takes `whole`: near its start, anywhere, and near its end, a third each.
    fn moment(&mut self, whole: Duration) -> Moment {
        let x = self.uniform();
        match (3.0 * self.uniform()) as u32 {
            0 => Moment::After(whole.mul_f64(0.1 * x)),
            1 => Moment::After(whole.mul_f64(x)),
            _ => Moment::Closing(Duration::from_millis(4).mul_f64(x)),
        }
    }
}

/// When a run is killed.
enum Moment {
    /// So long after its start.
    After(Duration),
    /// So long after it has begun to close its result.
    Closing(Duration),
}

fn arguments<'a>(out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    [&RUN[..], more, &["--out", out.to_str().unwrap()]].concat()
}

/// How often something is tried: `few` times with every change of the sources, `many` times with LOOSELINK_LONG.
fn rounds(few: usize, many: usize) -> usize {
    match std::env::var_os("LOOSELINK_LONG") {
        Some(_) => many,
        None => few,
    }
}

/// Starts the program; nobody reads its messages.
fn start(arguments: &[&str]) -> Child {
    program()
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Runs and kills; true when the run had ended by itself.
fn run_and_kill(out: &Path, more: &[&str], moment: Moment) -> bool {
    let mut child = start(&arguments(out, more));
    let time = match moment {
        Moment::After(time) => time,
        Moment::Closing(time) => {
            // the timing comes last but one; that of an earlier result stands in the way until it is set aside
            let forced = more.contains(&"--force");
            let closes =
                || (!forced || out.join(ASIDE).exists()) && out.join("timing.json").exists();
            while !closes() && child.try_wait().unwrap().is_none() {
                std::thread::sleep(Duration::from_micros(100));
            }
            time
        }
    };
    std::thread::sleep(time);
    child.kill().unwrap();
    child.wait().unwrap().signal().is_none()
}

/// The bytes of a result.
#[derive(Debug, PartialEq)]
struct Bytes([Vec<u8>; FILES.len()]);

impl Bytes {
    fn of(folder: &Path) -> Bytes {
        Bytes(FILES.map(|file| fs::read(folder.join(file)).unwrap_or_default()))
    }

    /// All but the timing, which differs when a run is repeated.
    fn repeatable(&self) -> &[Vec<u8>] {
        &self.0[..FILES.len() - 1]
    }

    fn lay(&self, folder: &Path) {
        fs::create_dir_all(folder).unwrap();
        for (file, bytes) in FILES.iter().zip(&self.0) {
            fs::write(folder.join(file), bytes).unwrap();
        }
    }
}

/// A whole run, and how long it took.
fn whole(folder: &Path, duration: &str) -> (Bytes, Duration) {
    let started = Instant::now();
    expect(&looselink(&arguments(folder, &[duration])), 0, "");
    let bytes = Bytes::of(folder);
    let text = read(folder, "channels.csv");
    let width = text.lines().next().unwrap().split(',').count();
    for line in text.lines().skip(1) {
        let numbers = line.split(',').map(|x| x.parse::<f64>().unwrap());
        assert_eq!(numbers.filter(|x| x.is_finite()).count(), width);
    }
    assert!(text.lines().count() > 1000 && bytes.0[2].len() > 1000);
    (bytes, started.elapsed())
}

fn status(folder: &Path) -> Option<String> {
    let summary = fs::read(folder.join("summary.json")).ok()?;
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    Some(summary["status"].as_str().unwrap().to_owned())
}

/// What is on disk is the beginning of the whole result, and is not called complete unless it is that.
#[track_caller]
fn check_killed(folder: &Path, whole: &Bytes) {
    let found = Bytes::of(folder);
    match status(folder).as_deref() {
        Some("complete") => assert_eq!(found.repeatable(), whole.repeatable()),
        Some("incomplete") | None => check_beginning(&found, whole),
        Some(other) => panic!("{other}"),
    }
}

/// The rows are the first of the whole result.
#[track_caller]
fn check_beginning(found: &Bytes, whole: &Bytes) {
    for k in [0, 1, 2] {
        assert!(whole.0[k].starts_with(&found.0[k]), "{}", FILES[k]);
    }
    assert!(found.0[3].is_empty() || found.0[3] == whole.0[3]);
}

/// On two threads, as many as there are cores at least.
fn twice(work: impl Fn(u64) + Sync) {
    std::thread::scope(|scope| {
        let work = &work;
        for thread in 0..2 {
            scope.spawn(move || work(thread));
        }
    });
}
