//! TOML text as a small tree in which every key and every value knows where it stands.

use super::error::{SceneError, Sources, Span};
use indexmap::IndexMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};

/// A value and its place; a table that has a header stands at the header.
#[derive(Debug)]
pub(crate) struct Node {
    pub span: Span,
    pub value: Value,
}

/// A TOML value.
#[derive(Debug)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date,
    Array(Vec<Node>),
    Table(Table),
}

/// Keys in the order of the text.
pub(crate) type Table = IndexMap<String, Entry>;

/// A value with the place of its key.
#[derive(Debug)]
pub(crate) struct Entry {
    pub key: Span,
    pub node: Node,
}

/// A scene needs five levels (`contacts.pin.friction.law`); the bound keeps every recursion shallow.
const DEPTH: usize = 32;

impl Value {
    /// What the user would call it, with its article.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Value::Text(_) => "a string",
            Value::Integer(_) => "an integer",
            Value::Float(_) => "a number",
            Value::Boolean(_) => "a boolean",
            Value::Date => "a date",
            Value::Array(_) => "an array",
            Value::Table(_) => "a table",
        }
    }
}

impl Node {
    /// The child with this key or, of an array, this index.
    pub(crate) fn child(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Table(table) => table.get(key).map(|entry| &entry.node),
            Value::Array(items) => items.get(key.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// The keys of a table, none for anything else.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &str> {
        let table = match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        };
        table.into_iter().flat_map(|t| t.keys().map(String::as_str))
    }
}

/// Reads the scene text (source 0).
pub(crate) fn document(sources: &Sources) -> Result<Node, SceneError> {
    let text = sources.text(0);
    let place = Place {
        sources,
        source: 0,
        offset: 0,
    };
    let root = DeTable::parse(text).map_err(|e| place.syntax(&e))?;
    let node = place.table(root.into_inner(), 0..0, 0)?;
    if node.keys().next().is_none() {
        return Err(place
            .error(0..0, "the scene is empty", "nothing here")
            .with_help("a scene begins with `format = 1`"));
    }
    Ok(node)
}

/// Reads one value that stands at `offset` of source number `source`.
pub(crate) fn value(
    sources: &Sources,
    source: usize,
    offset: usize,
    text: &str,
) -> Result<Node, SceneError> {
    let place = Place {
        sources,
        source,
        offset,
    };
    place.value(DeValue::parse(text).map_err(|e| place.syntax(&e))?, 0)
}

struct Place<'a> {
    sources: &'a Sources,
    source: usize,
    offset: usize,
}

impl Place<'_> {
    fn span(&self, range: Range<usize>) -> Span {
        Span::new(
            self.source,
            self.offset + range.start..self.offset + range.end,
        )
    }

    fn error(&self, range: Range<usize>, message: &str, label: &str) -> SceneError {
        SceneError::new(self.sources, self.span(range), message.into(), label.into())
    }

    fn syntax(&self, error: &Error) -> SceneError {
        let range = self.visible(error.span().unwrap_or(0..0));
        let written = self.sources.written(self.span(range.clone()));
        match error.message() {
            "duplicate key" => self.error(
                range,
                &format!("the key `{written}` is given twice"),
                "already given",
            ),
            message => self.error(range, &format!("not valid TOML: {message}"), "here"),
        }
    }

    /// A fault between two characters is shown by the line it stands in or, at the end, follows.
    fn visible(&self, range: Range<usize>) -> Range<usize> {
        let text = &self.sources.text(self.source)[self.offset..];
        if !range.is_empty() {
            return range;
        }
        let end = text
            .get(..range.start)
            .map_or(0, |before| before.trim_end().len());
        let start = text[..end].rfind('\n').map_or(0, |n| n + 1);
        let line = text[start..].lines().next().unwrap_or("");
        let indent = line.len() - line.trim_start().len();
        start + indent..start + line.trim_end().len().max(indent)
    }

    fn value(&self, spanned: Spanned<DeValue<'_>>, depth: usize) -> Result<Node, SceneError> {
        let range = spanned.span();
        if depth > DEPTH {
            return Err(self.error(range, "this is nested too deeply for a scene", "here"));
        }
        let value = match spanned.into_inner() {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Integer(number) => {
                match i64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(n) => Value::Integer(n),
                    Err(_) => {
                        return Err(self.error(
                            range,
                            "this integer is too large",
                            "does not fit 64 bits",
                        ));
                    }
                }
            }
            DeValue::Float(number) => match number.as_str().parse() {
                Ok(x) => Value::Float(x),
                Err(_) => return Err(self.error(range, "this is not a number", "here")),
            },
            DeValue::Boolean(x) => Value::Boolean(x),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(mut items) => Value::Array(
                items
                    .iter_mut()
                    .map(|item| {
                        self.value(
                            std::mem::replace(item, Spanned::new(0..0, DeValue::Boolean(false))),
                            depth + 1,
                        )
                    })
                    .collect::<Result<_, _>>()?,
            ),
            DeValue::Table(table) => return self.table(table, range, depth),
        };
        Ok(Node {
            span: self.span(range),
            value,
        })
    }

    fn table(
        &self,
        table: DeTable<'_>,
        range: Range<usize>,
        depth: usize,
    ) -> Result<Node, SceneError> {
        let mut entries: Vec<_> = table.into_iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let mut result = Table::with_capacity(entries.len());
        for (key, item) in entries {
            let entry = Entry {
                key: self.span(key.span()),
                node: self.value(item, depth + 1)?,
            };
            result.insert(key.into_inner().into_owned(), entry);
        }
        Ok(Node {
            span: self.span(range),
            value: Value::Table(result),
        })
    }
}
