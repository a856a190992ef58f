//! Results, and the version that they belong to.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Where and when results were measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of the workspace.
    pub version: String,
    /// Commit, the first twelve digits.
    pub commit: String,
    /// Day on which the campaign ended, as 2026-11-27.
    pub date: String,
    /// Processor, threads, system, compiler.
    pub machine: String,
    /// Seeds of what is drawn at random; "none" where nothing is.
    pub seeds: String,
    /// Duration of the campaign, all its parts together, where it was measured \[s\].
    pub seconds: Option<f64>,
}

/// Results and their origin.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record<T> {
    /// Where and when they were measured.
    pub origin: Origin,
    /// What was measured.
    pub results: T,
}

impl<T: DeserializeOwned> Record<T> {
    /// Reads a record.
    ///
    /// # Errors
    /// A file that cannot be read or that is no such record.
    pub fn read(path: &Path) -> Result<Record<T>> {
        let name = path.display().to_string();
        let text = fs::read_to_string(path)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {name}"))?;
        serde_json::from_str(&text).into_diagnostic().wrap_err(name)
    }
}

impl Record<Value> {
    /// Writes a record: the origin, then each result on a line of its own, so that versions can be compared line by line.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let lines =
            |open, lines: Vec<String>, close| format!("{open}\n{}\n{close}", lines.join(",\n"));
        let results = match &self.results {
            Value::Array(items) => lines("[", items.iter().map(Value::to_string).collect(), "]"),
            Value::Object(fields) => {
                let field = |(name, value): (&String, &Value)| match value {
                    Value::Array(items) if items.iter().any(|i| i.is_object() || i.is_array()) => {
                        let items = items.iter().map(Value::to_string).collect();
                        format!("{}: {}", Value::from(name.as_str()), lines("[", items, "]"))
                    }
                    value => format!("{}: {value}", Value::from(name.as_str())),
                };
                lines("{", fields.iter().map(field).collect(), "}")
            }
            other => other.to_string(),
        };
        let origin = serde_json::to_string_pretty(&self.origin).into_diagnostic()?;
        let text = format!("{{\"origin\": {origin},\n\"results\": {results}}}\n");
        // another program never sees half a record
        let draft = path.with_extension("draft");
        fs::write(&draft, text)
            .and_then(|()| fs::rename(&draft, path))
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::{Origin, Record};
    use serde_json::json;

    #[test]
    fn a_record_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.json");
        for results in [
            json!([{ "a": 1.5e-300 }, { "a": null }]),
            json!({ "rows": [[1, 2], [3, 4]], "plain": [1, 2], "text": "a \"b\"" }),
            json!(4),
        ] {
            let origin = Origin {
                version: "1.2.3".into(),
                commit: "0123456789ab".into(),
                date: "2026-01-31".into(),
                machine: "one".into(),
                seeds: "none".into(),
                seconds: Some(1.25),
            };
            let record = Record { origin, results };
            record.write(&path).unwrap();
            assert_eq!(Record::read(&path).unwrap(), record);
        }
    }
}
