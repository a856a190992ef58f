//! What the program itself writes: standard output, standard error, and the files of its commands.

use super::readers::{csv, html, json, markdown, squeezed, svg};
use super::{assert_harmless, corpus, quoted, titled};
use crate::command_line::{files, looselink, program};
use std::fs;
use std::path::Path;
use std::process::Output;

/// All texts that are accepted as titles, one after the other.
fn accepted() -> String {
    let texts = corpus().into_iter().filter(|case| case.refused.is_none());
    let texts: Vec<String> = texts.map(|case| case.text).collect();
    texts.join(" ")
}

/// All characters that are refused, and what stands around them.
fn refused() -> String {
    let texts = corpus().into_iter().filter(|case| case.refused.is_some());
    // no argument of a program holds it
    texts.map(|case| case.text.replace('\0', "")).collect()
}

#[track_caller]
fn shown(output: &Output, code: i32, case: &str) -> String {
    let shown = [&output.stdout[..], &output.stderr].concat();
    let shown = String::from_utf8(shown).unwrap();
    assert_eq!(output.status.code(), Some(code), "{case}: {shown}");
    assert_harmless(&shown, case);
    shown
}

/// Every command with a scene that has all accepted texts as its title, and with studies that have them in their names.
#[test]
fn every_command_shows_what_it_accepts() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let title = accepted();
    let (told, text) = (squeezed(&title), quoted(&title));
    fs::write(place("scene.toml"), titled(&text)).unwrap();
    let [scene, run, plot, frames, modes] =
        ["scene.toml", "run", "plot.svg", "frames", "modes"].map(place);
    let [ablation, study, sweep] = ["ablation", "study.toml", "sweep"].map(place);
    let command = |arguments: &[&str]| shown(&looselink(arguments), 0, &arguments.join(" "));
    assert!(squeezed(&command(&["check", &scene])).contains(&told));
    assert!(squeezed(&command(&["inspect", &scene])).contains(&told));
    command(&["inspect", &scene, "--json"]);
    command(&["run", &scene, "--out", &run, "--view"]);
    assert_eq!(json(&Path::new(&run).join("summary.json"))["title"], title);
    assert_eq!(
        html(&Path::new(&run).join("view.html")).1["runs"][0]["title"],
        title
    );
    csv(&Path::new(&run).join("channels.csv"));
    command(&["view", &run]);
    command(&["view", &run, "--frames", &frames, "--count", "2"]);
    svg(&Path::new(&frames).join("frame-0001.svg"));
    for chosen in [
        &["--channels", "*"][..],
        &["--phase", "journal.x", "journal.y"],
        &["--spectrum", "journal.x"],
    ] {
        command(&[&["plot", &run, "-o", &plot], chosen].concat());
        assert!(svg(Path::new(&plot)).contains(&told));
    }
    command(&["modes", &scene, "--at", "1.05e-3", "--view", &modes]);
    for page in files(Path::new(&modes)) {
        let data = html(&Path::new(&modes).join(page)).1;
        assert!(data["runs"][0]["title"].as_str().unwrap().ends_with(&title));
    }
    assert!(
        squeezed(&command(&[
            "ablate", &scene, "--runs", "1", "--out", &ablation
        ]))
        .contains(&told)
    );
    assert!(svg(&Path::new(&ablation).join("ablation.svg")).contains(&told));
    let measures = "[parameters.m]\nfields = [\"bodies.journal.mass\"]\nvalues = [0.05]\n[measures.x]\nof = \"last\"\nchannels = [\"journal.x\"]";
    fs::write(
        &study,
        format!("title = {text}\nscene = \"scene.toml\"\n{measures}\n"),
    )
    .unwrap();
    command(&["sweep", &study, "--out", &sweep]);
    assert_eq!(markdown(&Path::new(&sweep).join("sweep.md"))[0], told);
}

/// Paths, overrides, options and names that hold every refused character.
#[test]
fn arguments_are_shown_without_harm() {
    let folder = tempfile::tempdir().unwrap();
    let bad = refused();
    let scene = folder
        .path()
        .join("scene.toml")
        .to_str()
        .unwrap()
        .to_owned();
    fs::write(&scene, titled("\"x\"")).unwrap();
    let out = folder.path().join("out").to_str().unwrap().to_owned();
    let own = |name: &str| format!("{name}{bad}");
    // as long as a name of a file may be
    let short: String = bad
        .chars()
        .filter(|c| !c.is_ascii_alphabetic() && *c != '/')
        .collect();
    let file = folder.path().join(short).to_str().unwrap().to_owned();
    let study = own("x.toml");
    for arguments in [
        &[&*bad][..],
        &[&own("--")],
        &["run", &own("--")],
        &["help", &bad],
        &["check", &file],
        &["check", &scene, "--set", &bad],
        &["check", &scene, "--set", &own("title=")],
        &["check", &scene, "--set", &own("x=")],
        &["check", &scene, "--accuracy", &bad],
        &[
            "inspect",
            &scene,
            "--set",
            &format!("output.channels=[{}]", quoted("x\u{1b}")),
        ],
        &["run", &scene, "--out", &out, "--checkpoint", &bad],
        &["resume", &file],
        &["view", &file],
        &["view", &out, "-o", &bad],
        &["plot", &file, "--channels", &bad, "-o", "x.svg"],
        &["plot", &out, "--channels", "x", "-o", &bad],
        &["modes", &scene, "--contacts", &bad],
        &["ablate", &scene, "--body", &bad],
        &["precision", &study, "--out", &out],
        &["sweep", &study, "--out", &out],
        &["sweep", &study, "--out", &out, "--target", &bad],
        &["new", &bad, "x.toml"],
        &["completions", &bad],
    ] {
        let shown = shown(&looselink(arguments), 2, &arguments.join(" "));
        assert!(shown.contains("U+001B"), "{shown}");
    }
}

/// A folder may have any name that the system takes: a whole run into it shows the name without harm.
#[cfg(unix)]
#[test]
fn folders_of_any_name_are_used_and_shown() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder
        .path()
        .join("scene.toml")
        .to_str()
        .unwrap()
        .to_owned();
    fs::write(&scene, titled("\"x\"")).unwrap();
    let out = folder
        .path()
        .join("\u{1b}[31mred\u{7}\u{9b}2J\u{202e}")
        .to_str()
        .unwrap()
        .to_owned();
    for arguments in [
        &["run", &scene, "--out", &out, "--view"][..],
        &["view", &out],
        &[
            "plot",
            &out,
            "--channels",
            "*",
            "-o",
            &format!("{out}/x.svg"),
        ],
    ] {
        let shown = shown(&looselink(arguments), 0, "a folder");
        assert!(
            shown.contains("U+001B[31mredU+0007U+009B2JU+202E"),
            "{shown}"
        );
    }
    let (_, data) = html(&Path::new(&out).join("view.html"));
    assert_harmless(
        &data["runs"][0]["folder"].to_string(),
        "the folder in the page",
    );
    shown(
        &looselink(&["run", &scene, "--out", &out]),
        2,
        "a folder that is occupied",
    );
}

/// Colours of our own stay, those of others do not come.
#[test]
fn own_colors_survive() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    fs::write(&scene, titled("\"x\"\nx\u{202e} = 5 # \u{202e}")).unwrap();
    let colored = |arguments: &[&str]| {
        let mut command = program();
        command
            .env("FORCE_COLOR", "1")
            .env("CLICOLOR_FORCE", "1")
            .env_remove("NO_COLOR");
        let output = command.args(arguments).output().unwrap();
        String::from_utf8(output.stderr).unwrap()
    };
    for said in [
        colored(&[
            "check",
            scene.to_str().unwrap(),
            "--set",
            "title=\u{1b}[8m\u{1b}[2J",
        ]),
        colored(&["check", scene.to_str().unwrap()]),
        colored(&["check", "--\u{1b}[8m\u{1b}[2J"]),
    ] {
        let mut plain = said.clone();
        // the codes of colours and weights that miette and clap use; hidden text is none of them
        while let Some(at) = plain.find("\u{1b}[") {
            let end = at + plain[at..].find('m').unwrap();
            let code = plain[at + 2..end].to_owned();
            assert!(
                code.chars().all(|c| c.is_ascii_digit() || c == ';') && code != "8",
                "{said:?}"
            );
            plain.replace_range(at..=end, "");
        }
        assert!(plain != said, "{said:?}");
        assert_harmless(&plain, "colours");
    }
}

/// All that the program writes to the terminal goes through one file.
#[test]
fn one_file_writes_to_the_terminal() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for folder in [sources.clone(), sources.join("plot")] {
        for name in files(&folder)
            .into_iter()
            .filter(|name| name.ends_with(".rs"))
        {
            let text = fs::read_to_string(folder.join(&name)).unwrap();
            let writes = ["stdout(", "stderr(", "println!", "print!"];
            let found = writes.iter().any(|way| text.contains(way));
            assert_eq!(found, name == "terminal.rs", "{name}");
        }
    }
}
