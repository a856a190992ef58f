//! Titles, names and other texts of scenes.

use super::readers::{csv, html, json};
use super::{assert_harmless, corpus, quoted, scene, titled};
use folder::Folder;
use looselink::model::Model;
use looselink::output::Results;
use looselink::scene::Scene;
use looselink::simulate::{ContactEvent, Control, Observer, Progress, Simulation};
use looselink::system::State;
use messages::{Colors, scene_fault};
use std::path::Path;
use view::{StoredRun, page};

/// Reads a scene and compiles it; the fault as it is shown.
fn read(text: &str, overrides: &[String]) -> Result<(Scene, Simulation), String> {
    let read = Scene::parse("scene.toml", text, overrides);
    let compiled = read.and_then(|scene| Ok((scene.clone(), Simulation::new(&scene)?)));
    compiled.map_err(|error| {
        let (_, line, column) = error.place().unwrap();
        let shown = scene_fault(&error, Colors::None);
        let file = if error.change().is_some() {
            "--set"
        } else {
            "scene.toml"
        };
        assert!(
            shown.contains(&format!("{file}:{line}:{column}")),
            "{shown}"
        );
        assert_harmless(&shown, &error.to_string());
        shown
    })
}

#[test]
fn titles_are_refused_by_their_character_or_accepted() {
    for case in corpus() {
        let title = quoted(&case.text);
        let own = read(&titled(&title), &[]);
        let given = read(&scene(), &[format!("title={title}")]);
        for read in [own, given] {
            match (&case.refused, read) {
                (None, Ok((scene, _))) => assert_eq!(scene.title, case.text),
                (Some(code), Err(shown)) => {
                    assert!(
                        shown.contains(&format!("`title` holds {code}, ")),
                        "{shown}"
                    );
                }
                (refused, read) => panic!("{:?}: {refused:?} {:?}", case.text, read.err()),
            }
        }
    }
}

/// As they are in the file, where TOML itself refuses some of them.
#[test]
fn raw_characters_are_refused_by_their_line() {
    for case in corpus() {
        let Some(code) = case.refused.filter(|code| code != "U+000A") else {
            continue;
        };
        let shown = read(&titled(&format!("'{}'", case.text)), &[]).unwrap_err();
        assert!(shown.contains(&code), "{shown}");
        let change = format!("title='{}'", case.text);
        let shown = read(&scene(), &[change]).unwrap_err();
        assert!(shown.contains(&code), "{shown}");
    }
}

/// Names of scenes are of few characters; the others are refused where they stand.
#[test]
fn names_are_refused_or_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let mut recorded = 0;
    for case in corpus() {
        let name = quoted(&case.text);
        let body = scene().replace("bodies.journal", &format!("bodies.{name}"));
        let body = body.replace(
            "\"journal.center\"",
            &quoted(&format!("{}.center", case.text)),
        );
        let body = body.replace("\"journal.*\"", &quoted(&format!("{}.*", case.text)));
        let joint = scene().replace("[joints.pin]", &format!("[joints.{name}]"));
        let joint = joint.replace("\"pin.*\"", &quoted(&format!("{}.*", case.text)));
        let plain = |text: &str| {
            !text.is_empty()
                && text
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
        };
        for (k, text) in [body, joint].iter().enumerate() {
            match read(text, &[]) {
                Ok((scene, simulation)) if plain(&case.text) => {
                    recorded += 1;
                    let out = folder.path().join(recorded.to_string());
                    simulate(&scene, simulation, &out);
                    let heads = csv(&out.join("channels.csv")).swap_remove(0);
                    let head = format!("{}.{}", case.text, ["x [m]", "fx [N]"][k]);
                    assert!(heads.contains(&head), "{heads:?}");
                    let onsets = csv(&out.join("onsets.csv"));
                    assert_eq!(onsets[1][1], ["pin", &case.text][k]);
                    let run = StoredRun::load(&out).unwrap();
                    let names = run.result.channels.iter().map(|channel| &channel.name);
                    let own = names.filter(|name| name.starts_with(&case.text));
                    assert!(own.count() > 5);
                }
                Err(shown) if !plain(&case.text) => {
                    assert!(
                        shown.contains("is not a valid name") || shown.contains(" holds U+"),
                        "{shown}"
                    );
                }
                other => panic!("{:?}: {:?}", case.text, other.err()),
            }
        }
        let own_point = format!("points.bearing = [0.0, 0.0]\npoints.{name} = [0.0, 0.0]");
        let material = format!("[materials.{name}]\ndensity = 1.0\n[bodies.ground]");
        for (from, to) in [
            ("points.bearing = [0.0, 0.0]", own_point),
            ("[bodies.ground]", material),
        ] {
            let read = read(&scene().replace(from, &to), &[]);
            assert_eq!(read.is_ok(), plain(&case.text), "{to}: {:?}", read.err());
        }
        // names of what is not there
        let channel = format!("channels = [{}", quoted(&format!("journal.{}", case.text)));
        let is_pattern = case.text.contains('*') && case.refused.is_none();
        let assumption = format!("format = 1\nassumptions = {{ {name} = \"why\" }}");
        for (from, to, is_fine) in [
            ("channels = [\"journal.*\"", channel, is_pattern),
            ("format = 1", assumption, false),
            ("model = \"clearance\"", format!("model = {name}"), false),
            ("\"ground.bearing\"", name.clone(), false),
        ] {
            let read = read(&scene().replace(from, &to), &[]);
            assert_eq!(read.is_ok(), is_fine, "{to}");
        }
        // why a value is assumed may take several lines
        let reason = format!("format = 1\nassumptions = {{ title = {name} }}");
        let read = read(&scene().replace("format = 1", &reason), &[]);
        let lines = case.refused.as_deref() == Some("U+000A");
        assert_eq!(
            read.is_ok(),
            case.refused.is_none() || lines,
            "{:?}",
            case.text
        );
    }
    assert!(recorded >= 6);
}

/// Stores a run of a scene.
fn simulate(scene: &Scene, mut simulation: Simulation, out: &Path) {
    struct Stored(Results);
    impl Observer for Stored {
        fn row(&mut self, values: &[f64]) -> std::io::Result<()> {
            self.0.row(values)
        }
        fn state(&mut self, model: &Model, at: &State) -> std::io::Result<()> {
            self.0.state(model, at)
        }
        fn contact(&mut self, contact: &ContactEvent) -> std::io::Result<()> {
            self.0.contact(contact)
        }
        fn step(&mut self, _: &Progress) -> std::io::Result<Control> {
            Ok(Control::Continue)
        }
    }
    let folder = Folder::claim(out, view::kind(), false).unwrap();
    let mut stored = Stored(Results::begin(folder, scene, &simulation).unwrap());
    simulation.run(&mut stored).unwrap();
    stored.0.finish(&simulation.report()).unwrap();
}

/// The page of a run has the elements of any other page, whatever its title.
#[test]
fn pages_show_titles_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let (plain, mut elements) = (folder.path().join("view.html"), Vec::new());
    for (k, case) in corpus()
        .into_iter()
        .filter(|case| case.refused.is_none())
        .enumerate()
    {
        let (scene, simulation) = read(&titled(&quoted(&case.text)), &[]).unwrap();
        let out = folder.path().join(k.to_string());
        simulate(&scene, simulation, &out);
        assert_eq!(json(&out.join("summary.json"))["title"], case.text);
        std::fs::write(&plain, page(&[StoredRun::load(&out).unwrap()])).unwrap();
        let (found, data) = html(&plain);
        assert_eq!(data["runs"][0]["title"], case.text);
        if k == 0 {
            elements = found.clone();
        }
        assert_eq!(found, elements, "{}", case.text);
    }
}
