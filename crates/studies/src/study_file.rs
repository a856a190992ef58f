//! Study files: TOML text, and faults with the line they stand at.

use crate::study_texts::refused;
use looselink::document::did_you_mean;
use looselink::scene::{SceneError, read_file};
use serde::de::DeserializeOwned;
use std::fmt;
use std::path::Path;
use toml::de::DeTable;

/// Why a study cannot be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum StudyError {
    /// A fault of the study file or of what it asks for.
    #[error("{0}")]
    Plain(String),
    /// A fault of its scene.
    #[error(transparent)]
    Scene(SceneError),
}

impl From<SceneError> for StudyError {
    /// A study can name any file as its scene.
    fn from(error: SceneError) -> StudyError {
        StudyError::Scene(error.without_contents())
    }
}

impl StudyError {
    /// A fault of the study file `path`.
    pub(crate) fn of(path: &Path, message: impl fmt::Display) -> StudyError {
        StudyError::Plain(format!("`{}`: {message}", path.display()))
    }

    /// A fault of a study with this text. The message begins with the key that it is about, in quotes; its line is named, unless
    /// the text is not that of a file.
    pub(crate) fn of_key(path: &Path, text: &str, message: &str) -> StudyError {
        let key = message.split('`').nth(1).unwrap_or_default();
        let line = line_of(text, key).map(|line| format!(", line {line}"));
        StudyError::at(path, &line.unwrap_or_default(), message)
    }

    /// A fault at some place, which only the text of a file has.
    fn at(path: &Path, place: &str, message: &str) -> StudyError {
        let place = if path.extension().is_some() {
            place
        } else {
            ""
        };
        StudyError::Plain(format!("`{}`{place}: {message}", path.display()))
    }
}

/// The line of a key, or of the table in which it would stand.
fn line_of(text: &str, path: &str) -> Option<usize> {
    let document = DeTable::parse(text).ok()?;
    let mut table = document.get_ref();
    let mut start = None;
    for name in path.split('.') {
        let Some((key, value)) = table.get_key_value(name) else {
            break;
        };
        start = Some(key.span().start);
        let Some(inner) = value.get_ref().as_table() else {
            break;
        };
        table = inner;
    }
    Some(text[..start?].matches('\n').count() + 1)
}

/// The text of a study or of its scene.
///
/// # Errors
/// A file that cannot be read, is larger than 8 MiB, or is not UTF-8 text.
pub(crate) fn text_of(path: &Path) -> Result<String, StudyError> {
    let unreadable = |cause: &dyn fmt::Display| {
        StudyError::Plain(format!("cannot read `{}`: {cause}", path.display()))
    };
    let bytes = read_file(path).map_err(|e| unreadable(&e))?;
    String::from_utf8(bytes).map_err(|e| unreadable(&e))
}

/// The tables and keys of a study.
///
/// # Errors
/// The first fault, with its line.
pub(crate) fn parsed<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, StudyError> {
    let table = DeTable::parse(text);
    if let Some(refused) = table.iter().find_map(|table| refused(table.get_ref(), "")) {
        let before = &text[..refused.byte];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        let place = format!(", line {line}, column {column}");
        return Err(StudyError::at(path, &place, &refused.message));
    }
    toml::from_str(text).map_err(|e| {
        let is_scene = table.is_ok_and(|table| table.get_ref().contains_key("bodies"));
        if is_scene {
            let message =
                "this is a scene; a study is a file of its own that names one with `scene`";
            return StudyError::of(path, message);
        }
        let hint = suggestion(e.message());
        StudyError::of(path, format!("{}{hint}", e.to_string().trim_end()))
    })
}

/// What was meant by a key that a message calls unknown; it quotes that key and then those that there are.
fn suggestion(message: &str) -> String {
    let mut quoted = message.split('`').skip(1).step_by(2);
    let is_unknown = message.starts_with("unknown field") || message.starts_with("unknown variant");
    match quoted.next() {
        Some(unknown) if is_unknown => did_you_mean(unknown, quoted),
        _ => String::new(),
    }
}
