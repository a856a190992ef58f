//! The tutorial and the how-to pages do what they say: their pieces make a scene, their commands run, their numbers come out.
//!
//! `LOOSELINK_WRITE=1 cargo test -p looselink-cli how_to` writes the pictures of the how-to pages.

use crate::command_line::TOP;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The tutorial and the file of its scene.
const TUTORIAL: (&str, &str) = ("docs/tutorial.md", "crank.toml");

/// The how-to pages, all files of this folder, and the file of their scenes.
const HOW_TO: (&str, &str) = ("docs/how-to", "my.toml");

/// What a reader does, in the order of the page.
enum Action {
    /// Appends to the scene.
    Scene(String),
    /// Writes another file, whose name is the comment in its first line.
    File(String, String),
    /// Types a command.
    Command(String),
    /// Runs a script with a program and its arguments.
    Script([&'static str; 2], String),
    /// Finds a piece of Rust in an example.
    Example(String),
    /// Compares what the last command or script has printed.
    Expected(String),
}

fn actions(page: &str) -> Vec<Action> {
    let mut actions = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let block: Vec<_> = lines.by_ref().take_while(|l| *l != "```").collect();
            let text = block.join("\n") + "\n";
            actions.push(match language {
                "toml" => match block.first().and_then(|line| line.strip_prefix("# ")) {
                    Some(name) if name.ends_with(".toml") => Action::File(name.to_owned(), text),
                    _ => Action::Scene(text),
                },
                "python" => Action::Script(["python3", "-c"], text),
                "matlab" => Action::Script(["octave-cli", "--eval"], text),
                "rust" => Action::Example(text),
                "text" => Action::Expected(text),
                other => panic!("a block of {other}"),
            });
        } else if let Some(name) = line.strip_prefix("    cargo run --release --example ") {
            let example = Path::new(TOP).join(format!("examples/{name}.rs"));
            assert!(example.exists(), "{line}");
        } else if let Some(command) = line.strip_prefix("    ") {
            assert!(command.starts_with("looselink "), "{line} is not run");
            actions.push(Action::Command(command.to_owned()));
        }
    }
    actions
}

/// What a command prints.
#[track_caller]
fn succeed(command: &mut Command, folder: &Path) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_looselink"));
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", program.parent().unwrap().display());
    let output = command.current_dir(folder).env("PATH", path).output();
    let Output {
        status,
        stdout,
        stderr,
    } = output.unwrap();
    let printed = String::from_utf8([stdout, stderr].concat()).unwrap();
    assert!(status.success(), "{command:?}\n{printed}");
    printed
}

fn exists(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap();
    std::env::split_paths(&path).any(|folder| folder.join(program).exists())
}

/// Leaves a line in the list of what `test.sh` names as skipped. In the gate nothing that a test needs is missing.
fn skip(what: &str) {
    eprintln!("skipped: {what}");
    assert!(std::env::var_os("LOOSELINK_GATE").is_none(), "{what}");
    if let Some(list) = std::env::var_os("LOOSELINK_SKIPPED") {
        let mut list = OpenOptions::new()
            .append(true)
            .create(true)
            .open(list)
            .unwrap();
        writeln!(list, "{what}").unwrap();
    }
}

/// The sources of all examples.
fn examples() -> String {
    let entries = fs::read_dir(Path::new(TOP).join("examples")).unwrap();
    let sources = entries.map(|e| fs::read_to_string(e.unwrap().path()).unwrap());
    sources.collect()
}

/// What a page has led to.
#[derive(Default)]
struct Followed {
    /// Commands that ran.
    commands: usize,
    /// Blocks that were compared with what was printed.
    compared: usize,
    /// Output of the last command or script; none if its program is missing.
    printed: Option<String>,
    /// Output of the last script.
    of_script: String,
}

/// Does what a page says, in a folder that has the scenes of the project.
fn follow(page: &str, scene_file: &str, folder: &Path) -> Followed {
    symlink(Path::new(TOP).join("scenes"), folder.join("scenes")).unwrap();
    let mut scene = String::new();
    let mut followed = Followed::default();
    for action in actions(page) {
        match action {
            Action::Scene(text) => {
                scene += &format!("{text}\n");
                fs::write(folder.join(scene_file), &scene).unwrap();
            }
            Action::File(name, text) => fs::write(folder.join(name), text).unwrap(),
            Action::Command(command) => {
                followed.commands += 1;
                let mut shell = Command::new("sh");
                followed.printed = Some(succeed(shell.args(["-c", &command]), folder));
            }
            Action::Script([program, argument], text) => {
                followed.printed = None;
                // the libraries of Octave are large; `test.sh` installs them where it can
                if program == "octave-cli" && !exists(program) {
                    skip("the scripts of the how-to pages for Octave (not installed)");
                    continue;
                }
                let mut script = Command::new(program);
                followed.of_script = succeed(script.args([argument, &text]), folder);
                followed.printed = Some(followed.of_script.clone());
            }
            Action::Example(text) => {
                assert!(examples().contains(&text), "no example has\n{text}");
            }
            Action::Expected(text) => {
                if let Some(printed) = &followed.printed {
                    followed.compared += 1;
                    assert!(printed.contains(&text), "{text} is not in\n{printed}");
                }
            }
        }
    }
    followed
}

/// Pictures of a how-to page are those that its commands make.
fn check_pictures(page: &str, folder: &Path) {
    let images = Path::new(TOP).join(HOW_TO.0).join("images");
    for part in page.split("](images/").skip(1) {
        let (name, _) = part.split_once(')').unwrap();
        let [made, shown] = [folder, &images].map(|place| place.join(name));
        assert!(made.exists(), "no command makes {name}");
        if std::env::var_os("LOOSELINK_WRITE").is_some() {
            fs::create_dir_all(shown.parent().unwrap()).unwrap();
            fs::copy(made, &shown).unwrap();
        }
        assert!(shown.exists(), "{}", shown.display());
    }
}

#[test]
fn how_to_pages_work_as_written() {
    let entries = fs::read_dir(Path::new(TOP).join(HOW_TO.0)).unwrap();
    let mut pages: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|e| e == "md"));
    pages.sort();
    assert!(pages.len() >= 8, "{} pages", pages.len());
    for path in pages {
        eprintln!("{}", path.display());
        let page = fs::read_to_string(&path).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let followed = follow(&page, HOW_TO.1, folder.path());
        assert!(followed.commands > 0, "a page without commands");
        check_pictures(&page, folder.path());
    }
}

#[test]
fn the_tutorial_works_as_written() {
    let page = fs::read_to_string(Path::new(TOP).join(TUTORIAL.0)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let Followed {
        commands,
        compared,
        of_script,
        ..
    } = follow(&page, TUTORIAL.1, folder);
    let plays = of_script.lines().filter(|line| line.contains(" N at "));
    assert!(commands >= 8 && compared == 1 && plays.count() == 6);
    // what the prose says of the runs
    let peak = |run: &str| {
        let summary = fs::read(folder.join(run).join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        assert_eq!(summary["warnings"].as_array().unwrap().len(), 0, "{run}");
        summary["extremes"]["wrist_pin.force"]["max"]
            .as_f64()
            .unwrap()
    };
    let says = |text: &str| assert!(page.contains(text), "the page does not say {text}");
    says(&format!("carries {:.0} N at most", peak("out/ideal")));
    says(&format!("carries {:.1} kN", 1e-3 * peak("out/loose")));
    let forces: Vec<f64> = of_script
        .lines()
        .map(|line| {
            line[8..]
                .trim_start()
                .split(' ')
                .next()
                .unwrap()
                .parse()
                .unwrap()
        })
        .collect();
    assert!(forces[2] < 2500.0 && forces[3] > 2500.0, "{forces:?}");
    says(&format!("up to {:.0} N", forces[5]));
    for file in ["ideal.svg", "loose.html", "loose.svg", "orbit.svg"] {
        assert!(folder.join(file).exists(), "{file}");
    }
}
