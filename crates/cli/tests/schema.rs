//! The schema that editors check scenes against has the keys of the language. What it takes and refuses, python/tests tries.

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

/// All scenes below a folder.
fn scenes_below(folder: &Path) -> Vec<Value> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let scenes = entries.flat_map(|path| match path.extension() {
        _ if path.is_dir() => scenes_below(&path),
        Some(extension) if extension == "toml" => {
            let text = fs::read_to_string(&path).unwrap();
            vec![toml::from_str(&text).unwrap()]
        }
        _ => Vec::new(),
    });
    scenes.collect()
}

/// A key of a sheet: its table, the kind that the sheet describes, and its name.
type Key<'a> = (&'a str, Option<[&'a str; 2]>, String);

/// Adds the keys of a table of this name in the language and of those below it; names that the user chooses are called NAME
/// there.
fn use_keys<'a>(sheets: &'a [Sheet], name: &str, value: &Value, used: &mut BTreeSet<Key<'a>>) {
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
    for (key, below) in table {
        used.extend(sheet.map(|sheet| (sheet.table, sheet.kind, key.clone())));
        let takes = sheet.and_then(|s| s.keys.iter().find(|k| k.name == key));
        let name = match (takes.map(|key| key.takes), name) {
            (Some(Takes::Path), _) => "path".to_owned(),
            (Some(Takes::Function { .. }), _) => "function of time".to_owned(),
            (Some(_), "") => key.clone(),
            (Some(_), name) => format!("{name}.{key}"),
            (None, name) => format!("{name}.NAME"),
        };
        use_keys(sheets, &name, below, used);
    }
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

/// The examples of the reference, which tests/language.rs runs.
fn examples(reference: &str) -> impl Iterator<Item = Value> {
    let blocks = reference.split("```toml\n").skip(1);
    let texts = blocks.map(|block| block.split("```").next().unwrap_or_default());
    texts.map(|text| toml::from_str(text).unwrap())
}

#[test]
fn every_key_is_in_the_schema_in_the_reference_and_in_a_scene() {
    let sheets = language(&Registry::standard());
    let mut described = BTreeSet::new();
    objects(&serde_json::from_str(&printed()).unwrap(), &mut described);
    let reference = fs::read_to_string(Path::new(TOP).join("docs/scene.md")).unwrap();
    let mut used = BTreeSet::new();
    for folder in ["scenes", "verify/scenes", "crates/cli/templates"] {
        for scene in scenes_below(&Path::new(TOP).join(folder)) {
            use_keys(&sheets, "", &scene, &mut used);
        }
    }
    for example in examples(&reference) {
        use_keys(&sheets, "", &example, &mut used);
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
