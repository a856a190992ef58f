//! `looselink schema`: the scene language as a JSON schema, for editors that check while one types.

use super::failure::CommandFailure;
use super::print;
use looselink::document::{Key, NumberRange, Takes};
use looselink::registry::Registry;
use looselink::scene::AUTO;
use looselink::scene::language::{Sheet, language};
use serde_json::{Map, Value, json};

/// Prints the schema.
pub fn show() -> Result<(), CommandFailure> {
    print(text())
}

/// The schema of scenes with the kinds of the program.
pub fn text() -> String {
    format!("{:#}\n", schema(&Registry::standard()))
}

/// The schema of scenes with the kinds of a registry.
fn schema(registry: &Registry) -> Value {
    let language = Language {
        sheets: language(registry),
        laws: registry.laws.iter().map(|law| law.name).collect(),
        schemes: registry
            .schemes
            .iter()
            .map(|scheme| scheme.name)
            .chain([AUTO])
            .collect(),
        formats: registry.formats.iter().map(|format| format.name).collect(),
    };
    let mut scene = language.object(&language.sheets[0]);
    scene["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    scene["title"] = json!("A scene of Looselink");
    scene["$defs"] = json!({
        "path": language.any("path"),
        "function": { "anyOf": [
            { "type": "number" },
            { "type": "string" },
            language.any("function of time"),
        ] },
    });
    scene
}

struct Language {
    sheets: Vec<Sheet>,
    laws: Vec<&'static str>,
    schemes: Vec<&'static str>,
    formats: Vec<&'static str>,
}

impl Language {
    /// What stands in a table of this place, of any kind.
    fn any(&self, table: &str) -> Value {
        let sheets = self.sheets.iter();
        let sheets =
            sheets.filter(|s| s.table == table || s.table.starts_with(&format!("{table} of ")));
        let mut kinds: Vec<Value> = sheets.map(|sheet| self.object(sheet)).collect();
        match kinds.len() {
            1 => kinds.swap_remove(0),
            _ => json!({ "anyOf": kinds }),
        }
    }

    /// A table with the keys of a sheet.
    fn object(&self, sheet: &Sheet) -> Value {
        let mut properties = Map::new();
        let mut required = Vec::new();
        if let Some([key, kind]) = sheet.kind {
            properties.insert(key.to_owned(), json!({ "const": kind }));
            required.push(key);
        }
        for key in &sheet.keys {
            let mut value = self.value(sheet.table, key);
            value["description"] = json!(key.purpose);
            properties.insert(key.name.to_owned(), value);
            required.extend(key.default.is_none().then_some(key.name));
        }
        json!({
            "type": "object",
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    }

    /// What a key takes.
    fn value(&self, table: &str, key: &Key) -> Value {
        match key.takes {
            Takes::Number { range, .. } => match range {
                NumberRange::Any => json!({ "type": "number" }),
                NumberRange::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
                NumberRange::NonNegative => json!({ "type": "number", "minimum": 0 }),
                NumberRange::AtLeast(least) => json!({ "type": "number", "minimum": least }),
                NumberRange::Within(above, most) => {
                    json!({ "type": "number", "exclusiveMinimum": above, "maximum": most })
                }
                NumberRange::Between(least, most) => {
                    json!({ "type": "number", "minimum": least, "maximum": most })
                }
            },
            Takes::Whole(least, most) => {
                json!({ "type": "integer", "minimum": least, "maximum": most })
            }
            Takes::Vector { shape, .. } => {
                let count = shape.split(',').count();
                json!({ "type": "array", "items": { "type": "number" }, "minItems": count, "maxItems": count })
            }
            Takes::Rows { .. } => json!({ "type": "array" }),
            Takes::List => json!({ "type": "array", "items": { "type": "string" } }),
            Takes::Word(words) => json!({ "enum": words }),
            Takes::BooleanOr(words) => {
                let words = words.iter().map(|word| json!(word));
                let all: Vec<_> = [json!(true), json!(false)]
                    .into_iter()
                    .chain(words)
                    .collect();
                json!({ "enum": all })
            }
            Takes::Name("normal laws") => json!({ "enum": self.laws }),
            Takes::Name("schemes") => json!({ "enum": self.schemes }),
            Takes::Name("formats") => json!({ "enum": self.formats }),
            Takes::Name(_) | Takes::Text => json!({ "type": "string" }),
            Takes::Point => json!({ "type": "string", "pattern": "^[^.]+\\.[^.]+$" }),
            Takes::Boolean => json!({ "type": "boolean" }),
            Takes::Function { .. } => json!({ "$ref": "#/$defs/function" }),
            Takes::Path => json!({ "$ref": "#/$defs/path" }),
            Takes::Table => self.table(table, key.name),
        }
    }

    /// A table below a table: with keys of its own, or with names that the user chooses.
    fn table(&self, above: &str, name: &str) -> Value {
        let table = match above {
            "" => name.to_owned(),
            above => format!("{above}.{name}"),
        };
        let named = format!("{table}.NAME");
        let has = |table: &str| self.sheets.iter().any(|sheet| sheet.table == table);
        match (has(&table), has(&named), name) {
            (true, ..) => self.any(&table),
            // a point is written as numbers, too
            (_, true, "points") => {
                let forms = [json!({ "type": ["array", "number"] }), self.any(&named)];
                json!({ "type": "object", "additionalProperties": { "anyOf": forms } })
            }
            (_, true, _) => json!({ "type": "object", "additionalProperties": self.any(&named) }),
            _ => json!({ "type": "object" }),
        }
    }
}
