//! Characters that no text may hold: wherever it is shown, it could do something other than show itself.

use super::error::{SceneError, Sources, Span};
use super::tree::{Node, Value};
use super::written::first_harmful;

/// Refuses them in overrides, whose texts are kept as they are written.
pub(crate) fn check_overrides(sources: &Sources) -> Result<(), SceneError> {
    let mut overrides = sources.overrides().enumerate();
    let found = overrides.find_map(|(number, text)| Some((number + 1, first_harmful(text)?)));
    match found {
        None => Ok(()),
        Some((source, (place, c))) => {
            let message = format!("this override holds {c}");
            Err(refused(sources, Span::new(source, place), message))
        }
    }
}

/// Refuses them in all keys and texts of a document.
pub(crate) fn check_texts(sources: &Sources, root: &Node) -> Result<(), SceneError> {
    match found(root) {
        None => Ok(()),
        Some(Found { span, c, mut path }) => {
            path.reverse();
            let message = format!("`{}` holds {c}", path.join("."));
            Err(refused(sources, span, message))
        }
    }
}

fn refused(sources: &Sources, span: Span, message: String) -> SceneError {
    let error = SceneError::new(sources, span, message, "here");
    error.with_help("titles, names and other texts are shown on terminals, in pictures and in tables, which such characters break")
}

/// Where one was found; of its path the last part comes first.
struct Found {
    span: Span,
    c: String,
    path: Vec<String>,
}

fn found(node: &Node) -> Option<Found> {
    let below = |name: &str, node| {
        let mut found = found(node)?;
        found.path.push(name.to_owned());
        Some(found)
    };
    let at = |span, text: &str| {
        let (_, c) = first_harmful(text)?;
        let path = Vec::new();
        Some(Found { span, c, path })
    };
    match &node.value {
        Value::Text(text) => at(node.span, text),
        Value::Array(items) => {
            let mut items = items.iter().enumerate();
            items.find_map(|(index, item)| below(&index.to_string(), item))
        }
        Value::Table(table) => table.iter().find_map(|(name, node)| {
            let mut key = at(node.key, name);
            key.iter_mut().for_each(|key| key.path.push(name.clone()));
            key.or_else(|| below(name, node))
        }),
        _ => None,
    }
}
