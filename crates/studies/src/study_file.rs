//! Study files: TOML text, and faults with the line they stand at.

use looselink::document::did_you_mean;
use looselink::scene::{SceneError, read_file};
use serde::de::DeserializeOwned;
use std::fmt;
use std::path::Path;

/// Why a study cannot be made.
#[derive(Debug, Clone, thiserror::Error)]
pub enum StudyError {
    /// A fault of the study file or of what it asks for.
    #[error("{0}")]
    Plain(String),
    /// A fault of its scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

impl StudyError {
    /// A fault of the study file `path`.
    pub(crate) fn of(path: &Path, message: impl fmt::Display) -> StudyError {
        StudyError::Plain(format!("`{}`: {message}", path.display()))
    }
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
    toml::from_str(text).map_err(|e| {
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
