//! The schema that editors check scenes against: it takes what the program reads, and refuses what it refuses.

use crate::command_line::{TOP, expect, looselink};
use looselink::document::Takes;
use looselink::registry::Registry;
use looselink::scene::language::{Sheet, language};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn printed() -> String {
    let output = looselink(&["schema"]);
    expect(&output, 0, "");
    String::from_utf8(output.stdout).unwrap()
}

fn schema() -> jsonschema::Validator {
    let schema: Value = serde_json::from_str(&printed()).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
}

fn value(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

/// All scenes below a folder, with their paths.
fn scenes_below(folder: &Path) -> Vec<(String, Value)> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let scenes = entries.flat_map(|path| match path.extension() {
        _ if path.is_dir() => scenes_below(&path),
        Some(extension) if extension == "toml" => {
            let text = fs::read_to_string(&path).unwrap();
            vec![(path.display().to_string(), value(&text))]
        }
        _ => Vec::new(),
    });
    scenes.collect()
}

/// All scenes that come with the program.
fn scenes() -> Vec<(String, Value)> {
    let folders = ["scenes", "verify/scenes", "crates/cli/templates"];
    let below = |folder| scenes_below(&Path::new(TOP).join(folder));
    folders.into_iter().flat_map(below).collect()
}

/// A table of a scene whose keys the language declares: where it is, and the sheet that declares them.
struct Declared<'a> {
    path: Vec<String>,
    sheet: &'a Sheet,
}

/// Adds a table of this name in the language and those below it; names that the user chooses are called NAME there.
fn declared<'a>(
    sheets: &'a [Sheet],
    name: &str,
    value: &Value,
    path: &mut Vec<String>,
    found: &mut Vec<Declared<'a>>,
) {
    let Some(table) = value.as_object() else {
        return;
    };
    let describes = |sheet: &&Sheet| {
        let known = |key: &String| {
            let kind = sheet.kind.is_some_and(|[kind, _]| kind == key);
            kind || sheet.keys.iter().any(|k| k.name == key)
        };
        (sheet.table == name || sheet.table.starts_with(&format!("{name} of ")))
            && sheet.kind.is_none_or(|[key, kind]| value[key] == kind)
            && table.keys().all(known)
    };
    // states of a point mass have some of the keys of other bodies
    let sheets_of_this = sheets.iter().filter(describes);
    let sheet = sheets_of_this.min_by_key(|sheet| sheet.keys.len());
    found.extend(sheet.map(|sheet| Declared {
        path: path.clone(),
        sheet,
    }));
    for (key, below) in table {
        let takes = sheet.and_then(|s| s.keys.iter().find(|k| k.name == key));
        let name = match (takes.map(|key| key.takes), name) {
            (Some(Takes::Path), _) => "path".to_owned(),
            (Some(Takes::Function { .. }), _) => "function of time".to_owned(),
            (Some(_), "") => key.clone(),
            (Some(_), name) => format!("{name}.{key}"),
            (None, name) => format!("{name}.NAME"),
        };
        path.push(key.clone());
        declared(sheets, &name, below, path, found);
        path.pop();
    }
}

fn all_declared<'a>(sheets: &'a [Sheet], scene: &Value) -> Vec<Declared<'a>> {
    let mut found = Vec::new();
    declared(sheets, "", scene, &mut Vec::new(), &mut found);
    found
}

/// The table at a path.
fn at<'v>(scene: &'v mut Value, path: &[String]) -> &'v mut serde_json::Map<String, Value> {
    let table = path.iter().fold(scene, |value, key| &mut value[key]);
    table.as_object_mut().unwrap()
}

/// `LOOSELINK_WRITE=1 cargo test -p looselink-cli the_schema_of_the_repository` writes it anew.
#[test]
fn the_schema_of_the_repository_is_that_of_the_program() {
    let path = Path::new(TOP).join("docs/scene.schema.json");
    if std::env::var_os("LOOSELINK_WRITE").is_some() {
        fs::write(path, printed()).unwrap();
    } else {
        assert_eq!(fs::read_to_string(path).unwrap(), printed());
    }
}

#[test]
fn scenes_of_the_project_satisfy_the_schema() {
    let (schema, scenes) = (schema(), scenes());
    for (path, scene) in &scenes {
        if let Err(error) = schema.validate(scene) {
            panic!("{} of {path}: {error}", error.instance_path());
        }
    }
    assert!(scenes.len() > 45, "{} scenes", scenes.len());
}

#[test]
fn faults_of_scenes_violate_the_schema() {
    let schema = schema();
    let text = fs::read_to_string(Path::new(TOP).join("scenes/slider-crank/both.toml")).unwrap();
    assert!(schema.is_valid(&value(&text)));
    for (from, to) in [
        ("duration = ", "length = "),
        ("type = \"revolute\"", "type = \"hinge\""),
        ("model = \"flexible\"", "model = 3"),
        ("density = ", "density = -"),
        ("method = \"", "method = \"x"),
        ("[bodies.", "[body."),
        ("exponent = 1.5", "exponent = 0.9"),
        ("restitution = 0.9", "restitution = -0.1"),
        ("restitution = 0.9", "restitution = 1.1"),
        ("poissons_ratio = 0.3", "poissons_ratio = 0.6"),
        ("poissons_ratio = 0.3", "poissons_ratio = -1"),
        ("channels = [", "channels = [1, "),
    ] {
        assert!(text.contains(from), "{from}");
        let broken = value(&text.replacen(from, to, 1));
        assert!(!schema.is_valid(&broken), "{to}");
    }
}

/// Every key of every table of every scene, misspelt.
#[test]
fn a_misspelt_key_violates_the_schema() {
    let (schema, sheets) = (schema(), language(&Registry::standard()));
    let (mut misspelt, mut kinds) = (0, BTreeSet::new());
    for (file, scene) in scenes() {
        for Declared { path, sheet } in all_declared(&sheets, &scene) {
            kinds.insert((sheet.table, sheet.kind));
            for key in at(&mut scene.clone(), &path).keys() {
                let mut wrong = scene.clone();
                let table = at(&mut wrong, &path);
                let value = table.remove(key).unwrap();
                table.insert(format!("{key}x"), value);
                assert!(!schema.is_valid(&wrong), "{file}: {path:?} with {key}x");
                misspelt += 1;
            }
        }
    }
    assert_eq!(kinds.len(), sheets.len(), "{kinds:?}");
    assert!(misspelt > 2000, "{misspelt} keys");
}

/// Keys of all objects of a schema, with the kind that they describe.
fn objects(schema: &Value, found: &mut BTreeSet<(Option<String>, BTreeSet<String>)>) {
    if let Some(properties) = schema["properties"].as_object() {
        let kind = properties.values().find_map(|p| p["const"].as_str());
        found.insert((
            kind.map(str::to_owned),
            properties.keys().cloned().collect(),
        ));
    }
    match schema {
        Value::Object(parts) => parts.values().for_each(|part| objects(part, found)),
        Value::Array(parts) => parts.iter().for_each(|part| objects(part, found)),
        _ => {}
    }
}

#[test]
fn every_key_is_in_the_schema_in_the_reference_and_in_a_scene() {
    let sheets = language(&Registry::standard());
    let mut described = BTreeSet::new();
    objects(&serde_json::from_str(&printed()).unwrap(), &mut described);
    let reference = fs::read_to_string(Path::new(TOP).join("docs/scene.md")).unwrap();
    let mut used = BTreeSet::new();
    for (_, mut scene) in scenes() {
        for Declared { path, sheet } in all_declared(&sheets, &scene.clone()) {
            let keys = at(&mut scene, &path).keys();
            used.extend(keys.map(|key| (sheet.table, sheet.kind, key.clone())));
        }
    }
    let mut unused = Vec::new();
    for sheet in &sheets {
        let keys = sheet.keys.iter().map(|key| key.name.to_owned());
        let kind = sheet.kind.iter().map(|[key, _]| (*key).to_owned());
        let keys: BTreeSet<String> = keys.chain(kind).collect();
        for key in &keys {
            let row = format!("| `{key}` |");
            assert!(reference.contains(&row), "docs/scene.md has no {row}");
            if !used.contains(&(sheet.table, sheet.kind, key.clone())) {
                unused.push((sheet.table, sheet.kind, key.clone()));
            }
        }
        let object = (sheet.kind.map(|[_, kind]| kind.to_owned()), keys);
        assert!(described.contains(&object), "not in the schema: {object:?}");
    }
    assert!(unused.is_empty(), "in no scene: {unused:#?}");
}
