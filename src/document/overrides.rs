//! `path=value` overrides, applied to the tree before anything is read from it.

use super::error::{SceneError, Sources, Span};
use super::likeness::listed;
use super::tree::{Node, Value, value};

/// Applies every override in order; a later one wins.
pub(crate) fn apply(sources: &Sources, root: &mut Node) -> Result<(), SceneError> {
    let count = sources.overrides().count();
    (1..=count).try_for_each(|source| apply_one(sources, source, root))
}

/// One component of a path.
struct PathPart {
    name: String,
    span: Span,
}

fn apply_one(sources: &Sources, source: usize, root: &mut Node) -> Result<(), SceneError> {
    let text = sources.text(source);
    let malformed = |span, message: &str, label: &str| {
        SceneError::new(sources, span, message, label)
            .with_help("write `path=value`, for example `integrator.step=1e-6`")
    };
    let Some(equals) = unquoted(text, '=').next() else {
        let whole = Span::new(source, 0..text.len());
        return Err(malformed(whole, "an override needs `=`", "no `=` here"));
    };
    let path = parts(text, equals, source);
    if let Some(empty) = path.iter().find(|part| part.name.is_empty()) {
        let message = "the path of this override has an empty part";
        return Err(malformed(empty.span, message, "a name is missing"));
    }
    let new = written_value(sources, source, equals + 1)?;

    let (last, parents) = path.split_last().expect("a path has at least one part");
    let (mut node, mut above) = (root, String::new());
    for PathPart { name, span } in parents {
        if node.child(name).is_none() {
            let message = node.lacks(&above, name);
            let error = SceneError::new(sources, *span, message, "not in the scene");
            return Err(match node.keys() {
                known if known.is_empty() => error,
                known => {
                    let known = listed(name, &known);
                    let whole = format!("a new table is set as a whole: `{above}{name}={{...}}`");
                    error.with_help(known).with_help(whole)
                }
            });
        }
        node = node.child_mut(name).expect("just seen");
        above = format!("{above}{name}.");
    }
    let parent = above.strip_suffix('.').unwrap_or_default();
    let (message, label) = match (&mut node.value, last.name.parse::<usize>()) {
        (Value::Table(table), _) => {
            let key = last.span;
            table.insert(last.name.clone(), Node { key, ..new });
            return Ok(());
        }
        (Value::Array(items), Ok(index)) if index < items.len() => {
            items[index] = new;
            return Ok(());
        }
        (Value::Array(items), _) => (
            format!(
                "`{parent}` has the indices 0 to {}, not `{}`",
                items.len().saturating_sub(1),
                last.name
            ),
            "no such element",
        ),
        (other, _) => (
            format!("`{parent}` is {} and has no parts", other.kind()),
            "cannot be set",
        ),
    };
    Err(malformed(last.span, &message, label))
}

/// Positions of `wanted` outside double quotes.
fn unquoted(text: &str, wanted: char) -> impl Iterator<Item = usize> {
    let mut quoted = false;
    text.char_indices().filter_map(move |(at, c)| {
        quoted ^= c == '"';
        (c == wanted && !quoted).then_some(at)
    })
}

/// The dotted path in front of byte `equals`; a part that contains a dot is written in double quotes.
fn parts(text: &str, equals: usize, source: usize) -> Vec<PathPart> {
    let path = &text[..equals];
    let mut from = 0;
    let mut result = Vec::new();
    for to in unquoted(path, '.').chain([equals]) {
        let written = &path[from..to];
        let name = written.trim();
        let start = from + written.len() - written.trim_start().len();
        result.push(PathPart {
            name: name.trim_matches('"').to_owned(),
            span: Span::new(source, start..start + name.len()),
        });
        from = to + 1;
    }
    result
}

/// The value behind byte `start`: TOML, or a bare word that stands for a string.
fn written_value(sources: &Sources, source: usize, start: usize) -> Result<Node, SceneError> {
    let text = &sources.text(source)[start..];
    let trimmed = text.trim();
    let start = start + text.len() - text.trim_start().len();
    let span = Span::new(source, start..start + trimmed.len());
    if trimmed.is_empty() {
        let message = "an override needs a value";
        return Err(SceneError::new(
            sources,
            span,
            message,
            "nothing behind `=`",
        ));
    }
    let bare = trimmed.starts_with(|c: char| c.is_alphabetic() || c == '_');
    match value(sources, source, start, trimmed) {
        Err(_) if bare => Ok(Node {
            key: span,
            span,
            value: Value::Text(trimmed.to_owned()),
        }),
        other => other,
    }
}
