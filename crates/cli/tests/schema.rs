//! The schema that editors check scenes against: it takes what the program reads, and refuses what it refuses.

use crate::command_line::looselink;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn schema() -> jsonschema::Validator {
    let output = looselink(&["schema"]);
    assert!(output.status.success());
    let schema: Value = serde_json::from_slice(&output.stdout).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
}

fn value(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

/// Texts of all scenes below a folder.
fn scenes(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let texts = entries.flat_map(|path| match path.extension() {
        _ if path.is_dir() => scenes(&path),
        Some(extension) if extension == "toml" => vec![fs::read_to_string(&path).unwrap()],
        _ => Vec::new(),
    });
    texts.collect()
}

#[test]
fn scenes_of_the_project_satisfy_the_schema() {
    let schema = schema();
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut count = 0;
    for folder in ["scenes", "verify/scenes"] {
        for text in scenes(&top.join(folder)) {
            if let Err(error) = schema.validate(&value(&text)) {
                panic!("{} of\n{text}\n{error}", error.instance_path());
            }
            count += 1;
        }
    }
    assert!(count > 40, "{count} scenes");
}

#[test]
fn faults_of_scenes_violate_the_schema() {
    let schema = schema();
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let text = fs::read_to_string(top.join("scenes/slider-crank/both.toml")).unwrap();
    assert!(schema.is_valid(&value(&text)));
    for (from, to) in [
        ("duration = ", "length = "),
        ("type = \"revolute\"", "type = \"hinge\""),
        ("model = \"flexible\"", "model = 3"),
        ("density = ", "density = -"),
        ("method = \"", "method = \"x"),
        ("[bodies.", "[body."),
    ] {
        assert!(text.contains(from), "{from}");
        let broken = value(&text.replace(from, to));
        assert!(!schema.is_valid(&broken), "{to}");
    }
}
