//! Runs that are killed, that find no room, that may not write: what is on disk is readable and says what it is, and an
//! earlier result is whole, in its place or aside.
#![cfg(unix)]

use crate::command_line::{expect, files, looselink, read, summary};
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
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

const FILES: [&str; 5] = [
    "channels.csv",
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

fn start(out: &Path, more: &[&str]) -> Child {
    Command::new(assert_cmd::cargo::cargo_bin("looselink"))
        .args(arguments(out, more))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Runs and kills; true when the run had ended by itself.
fn run_and_kill(out: &Path, more: &[&str], moment: Moment) -> bool {
    let mut child = start(out, more);
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
struct Bytes([Vec<u8>; 5]);

impl Bytes {
    fn of(folder: &Path) -> Bytes {
        Bytes(FILES.map(|file| fs::read(folder.join(file)).unwrap_or_default()))
    }

    /// All but the timing, which differs when a run is repeated.
    fn repeatable(&self) -> &[Vec<u8>] {
        &self.0[..4]
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
    assert!(text.lines().count() > 1000 && bytes.0[1].len() > 1000);
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
        Some("incomplete") | None => {
            for k in [0, 1] {
                assert!(whole.0[k].starts_with(&found.0[k]), "{}", FILES[k]);
            }
            assert!(found.0[2].is_empty() || found.0[2] == whole.0[2]);
        }
        Some(other) => panic!("{other}"),
    }
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

#[test]
fn a_killed_run_is_readable_and_marked_and_can_be_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let (bytes, time) = whole(&folder.path().join("whole"), NEW);
    let stages = std::sync::Mutex::new([0; 4]);
    twice(|thread| {
        let mut random = Random(thread);
        for n in 0..100 {
            let out = folder.path().join(format!("{thread}-{n}"));
            let ended = run_and_kill(&out, &[NEW], random.moment(time));
            check_killed(&out, &bytes);
            let rows = fs::read(out.join("channels.csv")).unwrap_or_default();
            let rows = rows.iter().filter(|b| **b == b'\n').count();
            let stage = match (ended, rows) {
                (true, _) => 3,
                (_, 2..) => 2,
                (_, 1) => 1,
                _ => 0,
            };
            stages.lock().unwrap()[stage] += 1;
            if ended || n % 4 == 0 {
                expect(&looselink(&arguments(&out, &[NEW, "--force"])), 0, "");
                assert_eq!(files(&out), FILES);
                assert_eq!(Bytes::of(&out).repeatable(), bytes.repeatable());
            }
            let _ = fs::remove_dir_all(&out);
        }
    });
    // before there was anything, with a header, with rows, after the end
    let [nothing, _, rows, ended] = stages.into_inner().unwrap();
    assert!(
        nothing > 0 && rows > 20 && ended > 0,
        "{nothing} {rows} {ended}"
    );
}

/// The earlier result stands in its place or aside, byte for byte, until the new one is complete; also after a second kill.
#[test]
fn a_run_killed_while_it_replaces_a_result_leaves_that_whole() {
    let folder = tempfile::tempdir().unwrap();
    let (new, time) = whole(&folder.path().join("new"), NEW);
    let (earlier, _) = whole(&folder.path().join("earlier"), EARLIER);
    let stages = std::sync::Mutex::new([0; 3]);
    twice(|thread| {
        let mut random = Random(10 + thread);
        for n in 0..50 {
            let out = folder.path().join(format!("{thread}-{n}"));
            earlier.lay(&out);
            let mut held = Bytes::of(&out);
            for _ in 0..2 {
                run_and_kill(&out, &[NEW, "--force"], random.moment(time));
                let found = Bytes::of(&out);
                let (in_place, aside) = (found == held, Bytes::of(&out.join(ASIDE)) == held);
                let replaced = found.repeatable() == new.repeatable();
                assert!(in_place || aside || replaced, "{:?}", files(&out));
                // between the two results what is left of the earlier one has no summary
                let mut files = found.0.iter().zip(&held.0);
                let left = files.all(|(found, held)| found.is_empty() || found == held);
                if !in_place && (status(&out).is_some() || !left) {
                    check_killed(&out, &new);
                }
                let stage = if in_place {
                    0
                } else {
                    1 + usize::from(replaced)
                };
                stages.lock().unwrap()[stage] += 1;
                if replaced {
                    held = found;
                }
            }
            if n % 5 == 0 {
                expect(&looselink(&arguments(&out, &[NEW, "--force"])), 0, "");
                assert_eq!(files(&out), FILES);
                assert_eq!(Bytes::of(&out).repeatable(), new.repeatable());
            }
            fs::remove_dir_all(&out).unwrap();
        }
    });
    let [in_place, aside, replaced] = stages.into_inner().unwrap();
    assert!(
        in_place > 0 && aside > 10 && replaced > 0,
        "{in_place} {aside} {replaced}"
    );
}

#[test]
fn without_force_an_earlier_result_is_never_touched() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let (earlier, _) = whole(&out, EARLIER);
    let mut random = Random(20);
    for _ in 0..40 {
        let time = Duration::from_millis(10).mul_f64(random.uniform());
        run_and_kill(&out, &[NEW], Moment::After(time));
        assert_eq!(files(&out), FILES);
        assert_eq!(Bytes::of(&out), earlier);
    }
    // another scene's result is one as well
    let other = [
        "run",
        "scenes/bouncing-journal.toml",
        "--out",
        out.to_str().unwrap(),
    ];
    expect(&looselink(&other), 2, "holds a result already");
    assert_eq!(Bytes::of(&out), earlier);
}

/// A run that fails while it replaces a result says where that is; the next one that is complete deletes it.
#[test]
fn a_run_that_fails_names_the_earlier_result() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let journal = |more: &[&str]| {
        let run = ["run", "scenes/bouncing-journal.toml", "--quiet", "--force"];
        looselink(&[&run, more, &["--out", out.to_str().unwrap()]].concat())
    };
    expect(&journal(&[]), 0, "");
    let earlier = Bytes::of(&out);
    for _ in 0..2 {
        let output = journal(&["--set", "bodies.journal.mass=1e-300"]);
        expect(&output, 3, "the earlier result is in `");
        expect(&output, 3, "out/previous-result`");
        assert_eq!(summary(&out)["status"], "failed");
        assert_eq!(Bytes::of(&out.join(ASIDE)), earlier);
    }
    expect(&journal(&[]), 0, "");
    assert_eq!(files(&out), FILES);
}

/// Two runs do not write to one folder, not even on demand.
#[test]
fn a_running_result_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut first = start(&out, &["simulation.duration=3.0"]);
    let limit = Instant::now() + Duration::from_secs(20);
    while status(&out).is_none() {
        assert!(Instant::now() < limit, "no summary after 20 s");
        std::thread::sleep(Duration::from_millis(5));
    }
    expect(
        &looselink(&arguments(&out, &[NEW, "--force"])),
        2,
        "another run is writing to `",
    );
    assert_eq!(status(&out).as_deref(), Some("incomplete"));
    first.kill().unwrap();
    first.wait().unwrap();
    expect(&looselink(&arguments(&out, &[NEW, "--force"])), 0, "");
    assert_eq!(status(&out).as_deref(), Some("complete"));
}

/// A study and an ablation are written at their end, in one piece: killed just then, they leave the earlier result whole.
#[test]
fn results_in_one_piece_are_replaced_whole() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/pendulum.toml");
    let text = format!(
        "title = 'brief'\nscene = {scene:?}\nduration = 0.02\ninterval = 0.01\nposition = ['points.rod.bob.x']\n\
         reference = {{ set = [], steps = [2e-3, 1e-3] }}\ncurves = [{{ name = 'one', steps = [5e-3] }}]\n"
    );
    fs::write(&study, text).unwrap();
    let study = study.to_str().unwrap();
    let brief = [
        "--set",
        "simulation.duration=0.02",
        "--set",
        "output.interval=0.01",
    ];
    let ablate = [
        &["ablate", "scenes/pendulum.toml", "--runs", "1"],
        &brief[..],
    ]
    .concat();
    let commands = [
        ("precision", vec!["precision", study, "--repeats", "1"]),
        ("ablation", ablate),
    ];
    let mut random = Random(30);
    for (name, command) in commands {
        let names = ["json", "md", "png", "svg"].map(|kind| format!("{name}.{kind}"));
        let names = [&names[..], &["timing.json".to_owned()]].concat();
        let is_earlier = |folder: &Path| {
            let marked = |file: &String| fs::read(folder.join(file)).is_ok_and(|b| b == b"earlier");
            names.iter().all(marked)
        };
        let mut stages = [0; 3];
        for n in 0..16 {
            let out = folder.path().join(format!("{name}-{n}"));
            fs::create_dir(&out).unwrap();
            names
                .iter()
                .for_each(|file| fs::write(out.join(file), "earlier").unwrap());
            let forced = [
                &command[..],
                &["--force", "--quiet", "--out", out.to_str().unwrap()],
            ]
            .concat();
            let mut child = Command::new(assert_cmd::cargo::cargo_bin("looselink"))
                .args(&forced)
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            // it begins to write
            let limit = Instant::now() + Duration::from_secs(60);
            let begun = || {
                [".previous-result.tmp", ASIDE]
                    .iter()
                    .any(|n| out.join(n).exists())
            };
            while !begun() && child.try_wait().unwrap().is_none() {
                assert!(Instant::now() < limit, "nothing is written");
                std::thread::sleep(Duration::from_micros(20));
            }
            std::thread::sleep(Duration::from_millis(4).mul_f64(random.uniform()));
            child.kill().unwrap();
            child.wait().unwrap();
            let closed = fs::read(out.join(&names[0])).is_ok_and(|b| b != b"earlier");
            let stage = match (is_earlier(&out), is_earlier(&out.join(ASIDE)), closed) {
                (true, ..) => 0,
                (_, true, false) => 1,
                (.., true) => 2,
                _ => panic!("{:?}", files(&out)),
            };
            stages[stage] += 1;
            if stage == 2 || n % 8 == 0 {
                expect(&looselink(&forced), 0, "");
                assert_eq!(files(&out), names);
                assert!(
                    names
                        .iter()
                        .all(|f| fs::read(out.join(f)).unwrap() != b"earlier")
                );
            }
        }
        assert!(stages[1] > 0, "{name}: {stages:?}");
    }
}

/// Runs under a limit of the size of files, in blocks of the shell; the signal that comes with it is left to kill, or not.
fn limited(out: &Path, blocks: usize, dies: bool, more: &[&str]) -> Output {
    let signal = if dies { "" } else { "trap '' XFSZ; " };
    Command::new("sh")
        .args([
            "-c",
            &format!("{signal}ulimit -c 0; ulimit -f {blocks}; exec \"$@\""),
        ])
        .arg("sh")
        .arg(assert_cmd::cargo::cargo_bin("looselink"))
        .args(arguments(out, more))
        .output()
        .unwrap()
}

/// No room for a file, at sizes that each of the files reaches first with one of the three lists of channels.
#[test]
fn a_full_disk_ends_a_run_with_the_name_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut hit = std::collections::BTreeSet::new();
    let lots = ["simulation.duration=0.02"];
    // two rows, of all channels or of one: the summary or the onsets are the longest file then
    let few = |channels: &'static str| {
        [
            "simulation.duration=0.05",
            "--set",
            "output.interval=0.05",
            "--set",
            channels,
        ]
    };
    let (all, one) = (
        few("output.channels=[\"*\"]"),
        few("output.channels=[\"error.x\"]"),
    );
    for (n, more) in [&lots[..], &all, &one].into_iter().enumerate() {
        let out = folder.path().join(format!("whole-{n}"));
        expect(&looselink(&arguments(&out, more)), 0, "");
        let whole = Bytes::of(&out);
        for blocks in (0..40).chain([80, 160, 320]) {
            for dies in [false, true] {
                let out = folder.path().join(format!("{n}-{blocks}-{dies}"));
                let output = limited(&out, blocks, dies, more);
                if output.status.success() {
                    assert_eq!(Bytes::of(&out).repeatable(), whole.repeatable());
                    continue;
                }
                check_killed(&out, &whole);
                assert_ne!(status(&out).as_deref(), Some("complete"));
                if dies {
                    assert!(output.status.signal().is_some());
                    continue;
                }
                expect(&output, 1, "cannot write `");
                let stderr = String::from_utf8(output.stderr).unwrap();
                let (_, path) = stderr.split_once("cannot write `").unwrap();
                let name = Path::new(path.split('`').next().unwrap())
                    .file_name()
                    .unwrap();
                hit.insert(name.to_str().unwrap().to_owned());
                if blocks % 8 == 0 {
                    expect(
                        &looselink(&arguments(&out, &[more, &["--force"]].concat())),
                        0,
                        "",
                    );
                    assert_eq!(Bytes::of(&out).repeatable(), whole.repeatable());
                }
            }
        }
    }
    let hit: Vec<_> = hit.iter().map(String::as_str).collect();
    assert_eq!(
        hit,
        [
            ".scene.toml.tmp",
            ".summary.json.tmp",
            "channels.csv",
            "onsets.csv"
        ]
    );
}

/// Files that are written in one piece, each onto a full device.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_at_any_file_leaves_no_complete_summary() {
    for file in ["summary.json", "scene.toml", "timing.json"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path();
        let temporary = format!(".{file}.tmp");
        symlink("/dev/full", out.join(&temporary)).unwrap();
        expect(&looselink(&arguments(out, &[EARLIER])), 1, &temporary);
        assert_ne!(status(out).as_deref(), Some("complete"), "{file}");
        assert!(!out.join(temporary).exists());
    }
}

/// Places where nobody can write, root neither; nothing comes into being.
#[test]
fn unwritable_places_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("file"), "mine").unwrap();
    symlink(at("nowhere"), at("dangling")).unwrap();
    symlink(at("loop"), at("loop")).unwrap();
    let below = |path: &Path| -> PathBuf { path.join("below") };
    for (out, code) in [
        (at("file"), 2),
        (at("dangling"), 2),
        (at("loop"), 2),
        (below(&at("file")), 1),
        (below(&at("dangling")), 1),
        (below(Path::new("/proc")), 1),
        (PathBuf::from("/proc/self"), 1),
    ] {
        let name = out.to_str().unwrap();
        for force in [&[][..], &["--force"]] {
            let runs: [&[&str]; 3] = [
                &["run", "scenes/pendulum.toml"],
                &["precision", "studies/pendulum.toml", "--smoke"],
                &["ablate", "scenes/pendulum.toml"],
            ];
            for run in runs {
                let output = looselink(&[run, force, &["--out", name]].concat());
                expect(&output, code, name);
                // before the runs, which would tell of themselves
                assert!(output.stderr.starts_with(b"error: "), "{run:?} {name}");
            }
        }
    }
    assert_eq!(files(folder.path()), ["dangling", "file", "loop"]);
    assert_eq!(read(folder.path(), "file"), "mine");
}

/// What stands in the place of a file of the result and is none is not replaced, and nothing beside it.
#[test]
fn what_is_no_file_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    fs::write(out.join("summary.json"), "{}").unwrap();
    symlink("nowhere", out.join("channels.csv")).unwrap();
    fs::create_dir(out.join("timing.json")).unwrap();
    let before = files(out);
    expect(
        &looselink(&arguments(out, &[NEW])),
        2,
        "holds a result already",
    );
    let forced = arguments(out, &[NEW, "--force"]);
    expect(&looselink(&forced), 2, "channels.csv` is not a file");
    fs::remove_file(out.join("channels.csv")).unwrap();
    expect(&looselink(&forced), 2, "timing.json` is not a file");
    fs::remove_dir(out.join("timing.json")).unwrap();
    assert_eq!(before, ["channels.csv", "summary.json", "timing.json"]);
    assert_eq!(files(out), ["summary.json"]);
    assert_eq!(read(out, "summary.json"), "{}");
}
