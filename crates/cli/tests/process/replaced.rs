//! Results in the way of new ones.

use super::{
    ASIDE, Bytes, COMPLETE, EARLIER, Moment, NEW, Random, arguments, rounds, run_and_kill, start,
    status, whole,
};
use crate::command_line::{
    TOP, contents, expect, files, interrupt, looselink, program, read, summary,
};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

fn ended(mut child: Child) {
    assert!(child.wait().unwrap().success());
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
        assert_eq!(files(&out), COMPLETE);
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
    assert_eq!(files(&out), COMPLETE);
}

/// Two runs do not write to one folder, not even on demand.
#[test]
fn a_running_result_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut first = start(&arguments(&out, &["simulation.duration=3.0"]));
    let limit = Instant::now() + Duration::from_secs(20);
    while status(&out).is_none() {
        assert!(Instant::now() < limit, "no summary after 20 s");
        std::thread::sleep(Duration::from_millis(5));
    }
    expect(
        &looselink(&arguments(&out, &[NEW, "--force"])),
        2,
        "another looselink is writing to `",
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
    let scene = Path::new(TOP).join("scenes/pendulum.toml");
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
        let mut names = [&names[..], &["timing.json".to_owned()]].concat();
        names.retain(|file| cfg!(feature = "png") || !file.ends_with(".png"));
        let mut complete = [&names[..], &["manifest.jsonl".to_owned()]].concat();
        complete.sort();
        let is_earlier = |folder: &Path| {
            let marked = |file: &String| fs::read(folder.join(file)).is_ok_and(|b| b == b"earlier");
            names.iter().all(marked)
        };
        let mut stages = [0; 3];
        let first = folder.path().join(name);
        let make = [&command[..], &["--quiet", "--out", first.to_str().unwrap()]];
        expect(&looselink(&make.concat()), 0, "");
        let manifest = fs::read(first.join("manifest.jsonl")).unwrap();
        for n in 0..16 {
            let out = folder.path().join(format!("{name}-{n}"));
            fs::create_dir(&out).unwrap();
            names
                .iter()
                .for_each(|file| fs::write(out.join(file), "earlier").unwrap());
            fs::write(out.join("manifest.jsonl"), &manifest).unwrap();
            let forced = [
                &command[..],
                &["--force", "--quiet", "--out", out.to_str().unwrap()],
            ]
            .concat();
            let mut child = program()
                .args(&forced)
                .stdout(Stdio::null())
                .spawn()
                .unwrap();
            // it begins to write
            let limit = Instant::now() + Duration::from_secs(60);
            let begun = || {
                let mut files = files(&out).into_iter();
                files.any(|name| name == ASIDE || name.starts_with(".looselink-"))
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
                assert_eq!(files(&out), complete);
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

/// What stands in the place of a file of the result and is none is not replaced, and nothing beside it.
#[test]
fn what_is_no_file_is_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let summary = r#"{"scene_hash": "", "status": "complete", "version": "0.1.0"}"#;
    fs::write(out.join("summary.json"), summary).unwrap();
    symlink("discarded", out.join("channels.csv")).unwrap();
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
    assert_eq!(read(out, "summary.json"), summary);
}

/// Readers of a result that short runs replace one after the other see one of them.
#[test]
fn readers_see_one_result_while_it_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = arguments(&out, &["simulation.duration=2e-3", "--force"]);
    expect(&looselink(&run), 0, "");
    let picture = folder.path().join("picture.svg");
    let [place, picture] = [&out, &picture].map(|path| path.to_str().unwrap());
    let page = folder.path().join("page.html");
    let readers: [&[&str]; 2] = [
        &["plot", place, "--channels", "error.*", "-o", picture],
        &["view", place, "-o", page.to_str().unwrap()],
    ];
    std::thread::scope(|scope| {
        let runs = scope.spawn(|| {
            for _ in 0..rounds(60, 600) {
                expect(&looselink(&run), 0, "");
            }
        });
        while !runs.is_finished() {
            readers
                .iter()
                .for_each(|reader| expect(&looselink(reader), 0, ""));
            // a page may take longer to make than a run
            let beside = looselink(&["view", place]);
            if !beside.status.success() {
                expect(&beside, 2, "is being replaced by one run after the other");
            }
        }
    });
}

/// A page that is under way while its result is replaced shows the new one.
#[test]
fn a_page_is_of_the_result_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let page = ["view", out.to_str().unwrap()];
    for n in 0..rounds(5, 50) {
        let title = |title: &str| format!("title=\"{title}\"");
        let run = |title: &str, duration: &str| {
            looselink(&arguments(&out, &[duration, "--set", title, "--force"]))
        };
        expect(
            &run(&title("a long one"), "simulation.duration=0.05"),
            0,
            "",
        );
        let view = start(&page);
        std::thread::sleep(Duration::from_millis(4 * n as u64));
        expect(
            &run(&title("a short one"), "simulation.duration=2e-3"),
            0,
            "",
        );
        ended(view);
        let shown = read(&out, "view.html");
        assert!(shown.contains("a short one"), "round {n}");
    }
}

/// A page of a run under way is made again at its end.
#[test]
fn a_page_of_a_run_under_way_does_not_stay() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = start(&arguments(&out, &["simulation.duration=0.4"]));
    let place = out.to_str().unwrap();
    while status(&out).as_deref() != Some("incomplete") {
        std::thread::sleep(Duration::from_millis(1));
    }
    // its rows reach the disk every second
    expect(&looselink(&["view", place]), 0, "");
    assert_eq!(status(&out).as_deref(), Some("incomplete"));
    assert!(read(&out, "view.html").contains("\"incomplete\""));
    ended(run);
    assert_eq!(status(&out).as_deref(), Some("complete"));
    assert!(read(&out, "view.html").contains("\"complete\""));
}

/// The motion of a run under way reaches the disk after its channels: a page waits for it.
#[test]
fn a_page_waits_for_the_first_rows_of_the_motion() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    whole(&out, NEW);
    let [summary, motion] = ["summary.json", "motion.bin"].map(|file| out.join(file));
    let under_way = read(&out, "summary.json").replace("\"complete\"", "\"incomplete\"");
    fs::write(&summary, under_way).unwrap();
    // tables of a run under way have no digest
    let listed = read(&out, "manifest.jsonl");
    let lines = listed.lines().filter(|line| !line.contains("\"crc32\""));
    let lines: String = lines.map(|line| format!("{line}\n")).collect();
    fs::write(out.join("manifest.jsonl"), lines).unwrap();
    let whole_motion = fs::read(&motion).unwrap();
    let names = whole_motion.iter().position(|b| *b == b'\n').unwrap();
    // without its first line, and without rows
    for begun in [0, names + 1] {
        fs::write(&motion, &whole_motion[..begun]).unwrap();
        let mut view = program();
        view.args(["view", out.to_str().unwrap()]);
        let mut view = view.stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(300));
        assert!(
            view.try_wait().unwrap().is_none(),
            "{begun} bytes: it waits"
        );
        fs::write(&motion, &whole_motion).unwrap();
        assert!(view.wait().unwrap().success(), "{begun} bytes");
    }
}

/// A run that was killed before its first row: readers wait for it, then say where the earlier result is.
#[test]
fn a_result_without_rows_names_the_earlier_one() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    whole(&out, EARLIER);
    let long = arguments(&out, &["simulation.duration=3.0", "--force"]);
    let mut child = start(&long);
    while status(&out).as_deref() != Some("incomplete") {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    fs::write(out.join("channels.csv"), "").unwrap();
    let view = looselink(&["view", out.to_str().unwrap()]);
    expect(&view, 2, "out/previous-result`");
    let aside = out.join(ASIDE);
    let page = folder.path().join("page.html");
    let page = page.to_str().unwrap();
    expect(
        &looselink(&["view", aside.to_str().unwrap(), "-o", page]),
        0,
        "",
    );
    fs::remove_file(out.join("summary.json")).unwrap();
    let view = looselink(&["view", out.to_str().unwrap()]);
    expect(&view, 2, "it has no `summary.json`");
}

/// The rows and tables of a sweep stand aside until all runs of the new one are made, also when that is interrupted.
#[test]
fn a_sweep_is_replaced_when_the_new_one_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let study = |masses: usize| {
        let values: Vec<String> = (1..=masses).map(|mass| format!("{mass}.0")).collect();
        super::foreign::study(folder.path(), "masses", &format!("[{}]", values.join(", ")))
    };
    let out = folder.path().join("out");
    let sweep = |study: &str, more: &[&str]| {
        let out = out.to_str().unwrap();
        let words = [
            &["sweep", study, "--quiet", "--threads", "1", "--out", out],
            more,
        ]
        .concat();
        words.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let made = |words: &[String]| {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        expect(&looselink(&words), 0, "");
    };
    let earlier_study = study(3);
    made(&sweep(&earlier_study, &[]));
    let mut earlier = contents(&out);
    earlier.retain(|path, _| !path.ends_with("manifest.jsonl"));
    let stands = |folder: &Path| {
        let mut files = earlier.iter();
        files.all(|(path, bytes)| {
            fs::read(folder.join(path.file_name().unwrap())).is_ok_and(|found| found == *bytes)
        })
    };
    let long = study(400);
    // the second interruption does not push out the earlier result
    for _ in 0..2 {
        let words = sweep(&long, &["--force"]);
        let mut child = program()
            .args(&words)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let rows = || fs::read(out.join("runs.jsonl")).map_or(0, |rows| rows.len());
        for few in [true, false] {
            while (rows() < 2000) != few {
                assert!(child.try_wait().unwrap().is_none());
                std::thread::sleep(Duration::from_micros(100));
            }
        }
        interrupt(&child);
        assert_eq!(child.wait().unwrap().code(), Some(130));
        assert!(stands(&out.join(ASIDE)) && !out.join("sweep.json").exists());
    }
    // it goes on without --force
    made(&sweep(&long, &[]));
    assert!(!out.join(ASIDE).exists());
    assert_eq!(read(&out, "sweep.csv").lines().count(), 401);
    made(&sweep(&study(3), &["--force"]));
    assert!(!out.join(ASIDE).exists());
    assert_eq!(read(&out, "sweep.csv").lines().count(), 4);
}
