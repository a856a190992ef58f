//! docs/tutorial.md does what it says: its pieces make the scene, its commands run, its numbers come out.

use crate::command_line::TOP;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// What a reader does, in the order of the page.
enum Action {
    /// Appends to the scene.
    Scene(String),
    /// Types a command.
    Command(String),
    /// Runs a script.
    Script(String),
    /// Compares what the script has printed.
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
                "toml" => Action::Scene(text),
                "python" => Action::Script(text),
                "text" => Action::Expected(text),
                other => panic!("a block of {other}"),
            });
        } else if let Some(command) = line.strip_prefix("    looselink ") {
            actions.push(Action::Command(command.to_owned()));
        }
    }
    actions
}

#[track_caller]
fn succeed(command: &mut Command, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_looselink"));
    let path = std::env::var("PATH").unwrap();
    let path = format!("{}:{path}", program.parent().unwrap().display());
    let output = command.current_dir(folder).env("PATH", path).output();
    let output = output.unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{stderr}");
    output
}

#[test]
fn the_tutorial_works_as_written() {
    let page = fs::read_to_string(Path::new(TOP).join("docs/tutorial.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (mut scene, mut printed) = (String::new(), String::new());
    let (mut commands, mut compared) = (0, 0);
    for action in actions(&page) {
        match action {
            Action::Scene(text) => {
                scene += &format!("{text}\n");
                fs::write(folder.join("crank.toml"), &scene).unwrap();
            }
            Action::Command(command) => {
                commands += 1;
                let words = command.split_whitespace();
                succeed(Command::new("looselink").args(words), folder);
            }
            Action::Script(text) => {
                let output = succeed(Command::new("python3").args(["-c", &text]), folder);
                printed = String::from_utf8(output.stdout).unwrap();
            }
            Action::Expected(text) => {
                compared += 1;
                assert!(printed.contains(&text), "{text} is not in\n{printed}");
            }
        }
    }
    assert!(commands >= 8 && compared == 1 && printed.lines().count() == 6);
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
    let forces: Vec<f64> = printed
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
