//! `path=value` overrides, applied to the tree before anything is read from it.

use super::error::{SceneError, Sources, Span, nearest};
use super::tree::{Entry, Node, Table, Value, value};

/// Applies every override in order; a later one wins.
pub(crate) fn apply(sources: &Sources, root: &mut Node) -> Result<(), SceneError> {
    let count = sources.overrides().count();
    (1..=count).try_for_each(|source| apply_one(sources, source, root))
}

/// One component of a path.
struct Part {
    name: String,
    span: Span,
}

fn apply_one(sources: &Sources, source: usize, root: &mut Node) -> Result<(), SceneError> {
    let text = sources.text(source);
    let whole = Span::new(source, 0..text.len());
    let malformed = |span, message: &str, label: &str| {
        SceneError::new(sources, span, message.into(), label.into())
            .with_help("write `path=value`, for example `integrator.step=1e-6`")
    };
    let Some(equals) = unquoted(text, '=').next() else {
        return Err(malformed(whole, "an override needs `=`", "no `=` here"));
    };
    let path = parts(text, equals, source);
    if let Some(empty) = path.iter().find(|part| part.name.is_empty()) {
        return Err(malformed(
            empty.span,
            "the path of this override has an empty part",
            "a name is missing",
        ));
    }
    let new = written_value(sources, source, equals + 1)?;

    let (last, parents) = path.split_last().expect("a path has at least one part");
    let mut node = root;
    for (depth, part) in parents.iter().enumerate() {
        if node.child(&part.name).is_none() {
            return Err(no_such_table(sources, node, &path[..=depth]));
        }
        node = child_mut(node, &part.name).expect("just seen");
    }
    match &mut node.value {
        Value::Table(table) => {
            replace(table, last, new);
            Ok(())
        }
        Value::Array(items) => {
            let len = items.len();
            match last
                .name
                .parse::<usize>()
                .ok()
                .and_then(|index| items.get_mut(index))
            {
                Some(item) => {
                    *item = new;
                    Ok(())
                }
                None => Err(malformed(
                    last.span,
                    &format!(
                        "`{}` has the indices 0 to {}, not `{}`",
                        join(parents),
                        len.saturating_sub(1),
                        last.name
                    ),
                    "no such element",
                )),
            }
        }
        other => {
            let message = format!("`{}` is {} and has no parts", join(parents), other.kind());
            Err(malformed(last.span, &message, "cannot be set"))
        }
    }
}

fn replace(table: &mut Table, last: &Part, node: Node) {
    let entry = Entry {
        key: last.span,
        node,
    };
    table.insert(last.name.clone(), entry);
}

fn child_mut<'n>(node: &'n mut Node, key: &str) -> Option<&'n mut Node> {
    match &mut node.value {
        Value::Table(table) => table.get_mut(key).map(|entry| &mut entry.node),
        Value::Array(items) => items.get_mut(key.parse::<usize>().ok()?),
        _ => None,
    }
}

fn no_such_table(sources: &Sources, parent: &Node, path: &[Part]) -> SceneError {
    let (missing, above) = path.split_last().expect("a path has at least one part");
    let known: Vec<&str> = parent.keys().collect();
    let hint = match nearest(&missing.name, known.iter().copied()) {
        Some(near) if above.is_empty() => format!("; did you mean `{near}`?"),
        Some(near) => format!("; did you mean `{}.{near}`?", join(above)),
        None => String::new(),
    };
    let message = format!("the scene has no `{}`{hint}", join(path));
    let error = SceneError::new(sources, missing.span, message, "not in the scene".into());
    if known.is_empty() {
        return error;
    }
    error.with_help(format!("known here: {}", known.join(", ")))
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
fn parts(text: &str, equals: usize, source: usize) -> Vec<Part> {
    let path = &text[..equals];
    let mut from = 0;
    let mut result = Vec::new();
    for to in unquoted(path, '.').chain([equals]) {
        let written = &path[from..to];
        let name = written.trim();
        let start = from + written.len() - written.trim_start().len();
        result.push(Part {
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
        return Err(SceneError::new(
            sources,
            span,
            "an override needs a value".into(),
            "nothing behind `=`".into(),
        ));
    }
    let bare = trimmed.starts_with(|c: char| c.is_alphabetic() || c == '_');
    match value(sources, source, start, trimmed) {
        Err(_) if bare => Ok(Node {
            span,
            value: Value::Text(trimmed.to_owned()),
        }),
        other => other,
    }
}

fn join(path: &[Part]) -> String {
    path.iter()
        .map(|part| part.name.as_str())
        .collect::<Vec<_>>()
        .join(".")
}
