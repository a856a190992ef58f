//! The reference of the scene language, docs/scene.md, speaks of the language that the program reads.

use crate::support::run_scene;
use looselink::document::{NumberRange, Takes};
use looselink::registry::Registry;
use looselink::scene::Scene;
use looselink::scene::language::{self, language};
use looselink::simulate::Simulation;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md")
}

fn document() -> String {
    std::fs::read_to_string(path()).unwrap()
}

/// Blocks between fences, with the line each begins at; a fence of a kind that no test reads is a fault.
fn examples(document: &str) -> Vec<(usize, String)> {
    let (mut examples, mut open) = (Vec::new(), None);
    for (number, line) in document.lines().enumerate() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(info)) => {
                assert_eq!(info, "toml", "line {}", number + 1);
                open = Some((number + 1, String::new()));
            }
            (Some(_), Some(info)) => {
                assert_eq!(info, "", "line {}: a fence in a block", number + 1);
                examples.extend(open.take());
            }
            (Some((_, text)), None) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "the last block is open");
    examples
}

/// The scenes that the examples describe: one with a `format` is complete, any other changes the first. A key or a
/// table below one of the tables of a scene replaces the one of the same name.
fn scenes(document: &str) -> Vec<(usize, Table)> {
    let mut base: Option<Table> = None;
    let mut scenes = Vec::new();
    for (line, text) in examples(document) {
        let example: Table = text.parse().unwrap_or_else(|e| panic!("line {line}: {e}"));
        let scene = if example.contains_key("format") {
            example
        } else {
            let mut scene = base.clone().expect("the first example is complete");
            for (name, table) in example {
                let Value::Table(table) = table else {
                    panic!("line {line}: `{name}` is not a table");
                };
                let empty = Value::Table(Table::new());
                let old = scene.entry(name).or_insert(empty);
                old.as_table_mut().unwrap().extend(table);
            }
            scene
        };
        base.get_or_insert_with(|| scene.clone());
        scenes.push((line, scene));
    }
    scenes
}

fn parse(line: usize, scene: &Table) -> Scene {
    let text = toml::to_string(scene).unwrap();
    Scene::parse("docs/scene.md", &text, &[])
        .unwrap_or_else(|e| panic!("example of line {line}: {e} at {:?} of\n{text}", e.place()))
}

/// A table of the document: its heading and its rows, cell by cell.
struct DocumentSheet {
    line: usize,
    heading: Vec<String>,
    rows: Vec<Vec<String>>,
}

fn sheets(document: &str) -> Vec<DocumentSheet> {
    let mut sheets: Vec<DocumentSheet> = Vec::new();
    let mut inside = false;
    for (number, line) in document.lines().enumerate() {
        let Some(cells) = line.strip_prefix("| ").and_then(|l| l.strip_suffix(" |")) else {
            inside &= line.starts_with("|---");
            continue;
        };
        let cells = cells.split(" | ").map(|c| c.trim().to_owned()).collect();
        match (inside, sheets.last_mut()) {
            (true, Some(sheet)) => {
                assert_eq!(sheet.heading.len(), Vec::len(&cells), "line {}", number + 1);
                sheet.rows.push(cells);
            }
            _ => sheets.push(DocumentSheet {
                line: number + 1,
                heading: cells,
                rows: Vec::new(),
            }),
        }
        inside = true;
    }
    sheets
}

/// What stands in the first cell of a row between backticks.
fn quoted(row: &[String]) -> &str {
    let inner = row[0].strip_prefix('`').and_then(|c| c.strip_suffix('`'));
    inner.unwrap_or_else(|| panic!("{} is not `quoted`", row[0]))
}

/// The line before the table of a sheet.
fn marker(sheet: &language::Sheet) -> String {
    let table = match sheet.table {
        "" => "the scene",
        table => table,
    };
    match sheet.kind {
        Some([key, kind]) => format!("<!-- keys of {table}, {key} \"{kind}\" -->"),
        None => format!("<!-- keys of {table} -->"),
    }
}

/// The table of a sheet.
fn table(sheet: &language::Sheet) -> String {
    let mut text = "| key | unit | default | meaning |\n|---|---|---|---|\n".to_owned();
    if let Some([key, kind]) = sheet.kind {
        text += &format!("| `{key}` | - | required | `\"{kind}\"` |\n");
    }
    for key in &sheet.keys {
        let unit = Some(key.unit()).filter(|unit| !unit.is_empty());
        let list = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|w| format!("`\"{w}\"`")).collect();
            format!(": {}", words.join(", "))
        };
        let detail = match key.takes {
            Takes::Word(words) => list(words),
            Takes::Function { .. } => ", a [function of time](#functions-of-time)".to_owned(),
            Takes::Vector { shape, .. } | Takes::Rows { shape, .. } => format!(", as {shape}"),
            Takes::Number { range, .. } => match range {
                NumberRange::NonNegative => ", not negative".to_owned(),
                NumberRange::AtLeast(least) => format!("; at least {least}"),
                NumberRange::Within(above, most) => format!("; above {above} and at most {most}"),
                NumberRange::Between(least, most) => format!("; from {least} to {most}"),
                NumberRange::Any | NumberRange::Positive => String::new(),
            },
            _ => String::new(),
        };
        text += &format!(
            "| `{}` | {} | {} | {}{detail} |\n",
            key.name,
            unit.unwrap_or("-"),
            key.default.unwrap_or("required"),
            key.purpose,
        );
    }
    text
}

/// The document with the tables of the reader after their markers.
fn rewritten(document: &str, sheets: &[language::Sheet]) -> String {
    let tables: BTreeMap<_, _> = sheets.iter().map(|s| (marker(s), table(s))).collect();
    assert_eq!(
        tables.len(),
        sheets.len(),
        "two sheets have the same marker"
    );
    let mut lines = document.lines().peekable();
    let mut text = String::new();
    while let Some(line) = lines.next() {
        text += line;
        text.push('\n');
        if line.starts_with("<!-- keys of ") {
            text.push('\n');
            text += tables
                .get(line)
                .unwrap_or_else(|| panic!("the reader has no {line}"));
            lines.next_if_eq(&"");
            while lines.next_if(|l| l.starts_with('|')).is_some() {}
        }
    }
    for marker in tables.keys() {
        let count = document.lines().filter(|line| line == marker).count();
        assert_eq!(count, 1, "docs/scene.md: {marker}");
    }
    text
}

/// The words that a scene can choose from: kinds, laws, schemes, and those that keys take.
fn choices() -> BTreeSet<&'static str> {
    let registry = Registry::standard();
    let sheets = language(&registry);
    let kinds = sheets.iter().filter_map(|sheet| Some(sheet.kind?[1]));
    let keys = sheets.iter().flat_map(|sheet| &sheet.keys);
    let words = keys.flat_map(|key| match key.takes {
        Takes::Word(words) | Takes::BooleanOr(words) => words,
        _ => &[],
    });
    let laws = registry.laws.iter().map(|law| law.name);
    let schemes = registry.schemes.iter().map(|scheme| scheme.name);
    kinds
        .chain(words.copied())
        .chain(laws)
        .chain(schemes)
        .collect()
}

#[test]
fn every_example_of_the_language_runs() {
    let scenes = scenes(&document());
    for (line, scene) in &scenes {
        let (_, report) = run_scene(&parse(*line, scene));
        // the integrator's share at the steps of the examples, 1e-4 where they swing fastest; work that is left out of the
        // ledger is of the order of the energy itself
        if let Some(ledger) = report.ledger {
            let size = ledger.initial.abs() + ledger.work.abs();
            assert!(
                ledger.numerical.abs() < 1e-3 * size,
                "example of line {line}: {ledger:?}"
            );
        }
    }
    assert!(scenes.len() >= 49, "{} examples", scenes.len());
}

/// `LOOSELINK_WRITE=1 cargo test the_tables_of_the_language` writes the tables of docs/scene.md anew.
#[test]
fn the_tables_of_the_language_are_those_of_the_reader() {
    let document = document();
    let text = rewritten(&document, &language(&Registry::standard()));
    if std::env::var_os("LOOSELINK_WRITE").is_some() {
        std::fs::write(path(), text).unwrap();
    } else {
        assert_eq!(document, text);
    }
}

#[test]
fn every_choice_stands_in_the_language() {
    let (document, choices) = (document(), choices());
    for word in &choices {
        let stands = document.contains(&format!("`\"{word}\"`"));
        assert!(stands, "docs/scene.md does not describe {word:?}");
    }
    assert!(choices.len() > 40, "{} choices: {choices:?}", choices.len());
}

/// Every kind that a table's first key chooses is used by an example.
#[test]
fn every_choice_has_an_example() {
    let document = document();
    let examples: String = examples(&document).into_iter().map(|e| e.1).collect();
    let schemes = Registry::standard().schemes;
    for word in choices() {
        // defaults need no example, and schemes differ in their name alone
        let is_default = ["dynamic", "stop"].contains(&word);
        let is_example = examples.contains(&format!("\"{word}\"")) || is_default;
        assert!(
            is_example || schemes.iter().any(|s| s.name == word),
            "docs/scene.md has no example with {word:?}"
        );
    }
}

#[test]
fn channels_of_the_language_are_those_recorded() {
    let document = document();
    let mut described = BTreeMap::new();
    for sheet in sheets(&document) {
        if sheet.heading[..2] == ["channel", "unit"] {
            for row in &sheet.rows {
                let before = described.insert(quoted(row).to_owned(), row[1].clone());
                assert_eq!(before, None, "{} stands twice", row[0]);
            }
        }
    }
    let mut recorded = BTreeMap::new();
    for (line, mut table) in scenes(&document) {
        let output = table["output"].as_table_mut().unwrap();
        output.insert("channels".into(), Value::Array(vec!["*".into()]));
        let scene = parse(line, &table);
        for channel in Simulation::new(&scene).unwrap().channels() {
            let parts: Vec<&str> = channel.name.split('.').collect();
            let name = match parts[..] {
                ["points", _, _, quantity] => format!("points.BODY.POINT.{quantity}"),
                [name, quantity] if scene.body(name).is_some() => format!("BODY.{quantity}"),
                [name, quantity] if scene.joint(name).is_some() => format!("JOINT.{quantity}"),
                [name, quantity] if scene.forces.iter().any(|f| f.name == name) => {
                    format!("FORCE.{quantity}")
                }
                _ => channel.name.clone(),
            };
            recorded.insert(name, channel.unit.to_owned());
        }
    }
    assert_eq!(described, recorded);
}

/// The sheet that describes a table of a scene: the smallest one that has all of its keys and the kind that it names.
fn sheet_of<'a>(sheets: &'a [DocumentSheet], table: &Table) -> Option<&'a DocumentSheet> {
    let describes = |sheet: &&DocumentSheet| {
        let known = |key: &String| sheet.rows.iter().any(|r| quoted(r) == key);
        let first = &sheet.rows[0];
        let kind = table.get(quoted(first)).and_then(Value::as_str);
        let kind = kind.map_or("no kind".to_owned(), |kind| format!("`\"{kind}\"`"));
        sheet.heading[0] == "key"
            && table.keys().all(known)
            && (!first[3].contains("`\"") || first[3].contains(&kind))
    };
    sheets.iter().filter(describes).min_by_key(|s| s.rows.len())
}

/// Paths of all tables of a scene that a sheet describes, with that sheet.
fn walk<'a>(
    table: &Table,
    path: &mut Vec<String>,
    sheets: &'a [DocumentSheet],
    found: &mut Vec<(Vec<String>, &'a DocumentSheet)>,
) {
    found.extend(sheet_of(sheets, table).map(|sheet| (path.clone(), sheet)));
    for (key, value) in table {
        if let Value::Table(inner) = value {
            path.push(key.clone());
            walk(inner, path, sheets, found);
            path.pop();
        }
    }
}

/// A key that is called required is missed when it is taken out of an example, and one that has a default is not.
#[test]
fn required_keys_are_required_and_others_are_not() {
    let document = document();
    let sheets = sheets(&document);
    let (mut required, mut optional) = (BTreeSet::new(), BTreeSet::new());
    // a path and a function of time may both be a table of rows
    let keys = |sheet: &DocumentSheet| -> BTreeSet<String> {
        sheet.rows.iter().map(|r| quoted(r).to_owned()).collect()
    };
    let mut used = BTreeSet::new();
    for (line, scene) in scenes(&document) {
        let mut places = Vec::new();
        walk(&scene, &mut Vec::new(), &sheets, &mut places);
        for (path, sheet) in places {
            used.insert(keys(sheet));
            for row in &sheet.rows {
                let (key, default) = (quoted(row), row[2].as_str());
                let mut without = scene.clone();
                let table = path
                    .iter()
                    .fold(&mut without, |t, k| t[k].as_table_mut().unwrap());
                if table.remove(key).is_none() {
                    assert_ne!(default, "required", "line {line}: {path:?} has no {key}");
                    continue;
                }
                let text = toml::to_string(&without).unwrap();
                let error = Scene::parse("docs/scene.md", &text, &[]).err();
                let message = error.map_or(String::new(), |e| e.to_string());
                let missed = message.starts_with(&format!("missing key `{key}`"));
                let place = format!("line {}: {key} of {path:?}: {message}", sheet.line);
                match default {
                    "required" => assert!(missed, "{place}"),
                    // the words behind say when
                    _ if default.starts_with("required") => continue,
                    _ => assert!(!missed, "{place}"),
                }
                let seen = (sheet.line, key.to_owned());
                let _ = match default {
                    "required" => required.insert(seen),
                    _ => optional.insert(seen),
                };
            }
        }
    }
    for sheet in sheets.iter().filter(|s| s.heading[0] == "key") {
        assert!(used.contains(&keys(sheet)), "no example of {}", sheet.line);
    }
    assert!(required.len() > 100, "{} required keys", required.len());
    assert!(optional.len() > 25, "{} optional keys", optional.len());
}

#[test]
fn what_acts_on_nothing_is_refused() {
    let document = document();
    let (_, base) = examples(&document).swap_remove(0);
    let bob = r#"
[bodies.bob]
type = "point_mass"
mass = 0.1
[joints.load]
type = "revolute"
bearing = "rod.middle"
journal = "bob.center"
model = "ideal"
"#;
    for (addition, wanted) in [
        (
            "[forces.f]\ntype = 'torque'\npoint = 'ground.pivot'\nvalue = 1.0",
            "`forces.f` acts on the ground, which does not move",
        ),
        (
            "[drives.d]\ntype = 'point'\npoint = 'ground.rail'\nx = 0.3",
            "the motion of ground is known at every time, so its points cannot be driven",
        ),
        (
            "[drives.d]\ntype = 'angle'\njoint = 'load'\nangle = 0.3",
            "`drives.d.joint` needs the direction of bob, but a point mass has none",
        ),
        (
            "[forces.f]\ntype = 'spring_damper'\nfrom = 'crank.end'\nto = 'rod.start'
            stiffness = 1.0\ndamping = 0.0\nrest_length = 0.1",
            "force f is not defined at the start: a spring with a rest length has no direction where its ends coincide",
        ),
    ] {
        let text = format!("{base}{bob}{addition}");
        let error = match Scene::parse("docs/scene.md", &text, &[]) {
            Ok(scene) => Simulation::new(&scene).err(),
            Err(error) => Some(error),
        };
        assert_eq!(error.map(|e| e.to_string()).as_deref(), Some(wanted));
    }
}

#[test]
fn the_angle_of_a_driven_joint_counts_full_turns() {
    let scene = r#"
format = 1
title = "a wheel driven on a free arm"
simulation = { duration = 1.0 }
integrator = { method = "bathe", step = 1e-2, newton_tolerance = 1e-9 }
output = { interval = 1e-2, channels = ["hub.angle"] }
bodies.ground = { type = "ground", points.pivot = [0, 0] }
bodies.arm = { type = "rigid_body", mass = 1.0, inertia = 0.1, points = { pivot = [0, 0], hub = [0.5, 0] } }
bodies.wheel = { type = "rigid_body", mass = 0.1, inertia = 0.01, points.hub = [0, 0] }
joints.pivot = { type = "revolute", bearing = "ground.pivot", journal = "arm.pivot", model = "ideal" }
joints.hub = { type = "revolute", bearing = "arm.hub", journal = "wheel.hub", model = "ideal" }
drives.spin = { type = "angle", joint = "hub", angle = { type = "polynomial", coefficients = [0, 20] } }
initial.bodies.arm = { x = 0, y = 0, theta = 0 }
initial.bodies.wheel = { x = 0.5, y = 0, theta = 0, vx = 0, vy = 0, omega = 20 }
"#;
    let scene = Scene::parse("wheel", scene, &[]).unwrap_or_else(|e| panic!("{e}"));
    let (recording, _) = run_scene(&scene);
    // the drive holds the angle to rounding
    let last = *recording.get("hub.angle").last().unwrap();
    assert!((last - 20.0).abs() < 1e-9, "{last}");
}
