//! The slips of `slips.toml`: what newcomers type wrong is told, in a word that they need.

use crate::command_line::{TOP, program};
use serde::Deserialize;
use std::fs;
use std::path::Path;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    slips: Vec<Slip>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Slip {
    name: String,
    scene: String,
    #[serde(default)]
    set: Vec<String>,
    #[serde(default)]
    replace: Vec<[String; 2]>,
    command: String,
    told: Option<String>,
    valid: Option<String>,
}

fn slips() -> Vec<Slip> {
    let list: List = toml::from_str(include_str!("slips.toml")).unwrap();
    list.slips
}

impl Slip {
    /// The text of its scene.
    fn text(&self) -> String {
        let file = match self.scene.ends_with(".toml") {
            true => self.scene.clone(),
            false => format!("crates/cli/templates/{}.toml", self.scene),
        };
        let text = fs::read_to_string(Path::new(TOP).join(file)).unwrap();
        self.replace.iter().fold(text, |text, [from, to]| {
            assert_eq!(text.matches(from).count(), 1, "{}: `{from}`", self.name);
            text.replace(from, to)
        })
    }

    /// What its command says, and its exit code.
    fn said(&self, folder: &Path) -> (String, i32) {
        let file = folder.join("scene.toml");
        fs::write(&file, self.text()).unwrap();
        let mut command = program();
        command.arg(&self.command).arg(&file);
        if self.command == "run" {
            command.args(["--quiet", "--force", "--set", "simulation.duration=0.02"]);
            command.arg("--out").arg(folder.join("out"));
        }
        for change in &self.set {
            command.args(["--set", change]);
        }
        let output = command.output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8(said).unwrap();
        (said, output.status.code().unwrap())
    }
}

/// What the program says of its own accord: the lines of the scene that it quotes are what the user wrote.
fn own_words(said: &str) -> String {
    let quoted = |line: &&str| !line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    let own: Vec<&str> = said.lines().filter(quoted).collect();
    own.join("\n").to_lowercase()
}

#[test]
fn slips_of_newcomers_are_told() {
    let slips = slips();
    assert_eq!(slips.len(), 40);
    let valid = slips.iter().filter(|slip| slip.valid.is_some()).count();
    assert!(valid <= 8, "{valid} slips are called valid");
    let folder = tempfile::tempdir().unwrap();
    let mut missed = Vec::new();
    for slip in &slips {
        let (said, code) = slip.said(folder.path());
        let right = match &slip.told {
            None => code == 0 && slip.valid.is_some() && !said.contains("warning:"),
            Some(word) => own_words(&said).contains(&word.to_lowercase()) && [0, 2].contains(&code),
        };
        if !right {
            missed.push(format!(
                "{} ({:?}), exit {code}:\n{said}",
                slip.name, slip.told
            ));
        }
    }
    let told = slips.len() - missed.len();
    assert!(
        missed.is_empty(),
        "{told} of {} are as they should be; not these:\n\n{}",
        slips.len(),
        missed.join("\n")
    );
}
