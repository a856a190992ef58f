//! TOML text as a small tree in which every key and every value knows where it stands.

use super::error::{SceneError, Sources, Span};
use super::likeness::nearest;
use super::written;
use indexmap::IndexMap;
use std::borrow::Cow;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Error};
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// A value and its place; a table that has a header stands at the header.
#[derive(Debug)]
pub(crate) struct Node {
    /// Where its key stands; the place of the value where there is no key, as in an array.
    pub key: Span,
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
pub(crate) type Table = IndexMap<String, Node>;

/// A scene needs five levels (`contacts.pin.friction.law`); the bound, which holds in a header and once more below it, keeps every
/// recursion shallow.
const DEPTH: usize = 32;

/// What a file should have been that is none.
const IS_SCENE: &str = "a scene begins with `format = 1`";

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
            Value::Table(table) => table.get(key),
            Value::Array(items) => items.get(key.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// As [`Node::child`], to be changed.
    pub(super) fn child_mut(&mut self, key: &str) -> Option<&mut Node> {
        match &mut self.value {
            Value::Table(table) => table.get_mut(key),
            Value::Array(items) => items.get_mut(key.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// The keys of a table, none for anything else.
    pub(super) fn keys(&self) -> Vec<&str> {
        match &self.value {
            Value::Table(table) => table.keys().map(String::as_str).collect(),
            _ => Vec::new(),
        }
    }

    /// What to say of a child that is not there; `above` is the path to it, with a dot at its end.
    pub(crate) fn lacks(&self, above: &str, key: &str) -> String {
        let near = nearest(key, self.keys());
        let hint = near.map_or(String::new(), |near| {
            format!("; did you mean `{above}{near}`?")
        });
        format!("the scene has no `{above}{key}`{hint}")
    }
}

/// True of a document that says which version of the scene language it is written in.
pub(crate) fn is_scene(root: &Node) -> bool {
    let format = root.child("format").map(|format| &format.value);
    matches!(format, Some(Value::Integer(_)))
}

/// The fault of a document that does not.
pub(crate) fn no_scene(sources: &Sources) -> SceneError {
    let begin = Span::new(0, 0..0);
    let error = SceneError::new(
        sources,
        begin,
        "it has no `format = 1`, so it is no scene",
        "here",
    );
    error.with_help(IS_SCENE)
}

/// Reads the scene text (source 0).
pub(crate) fn document(sources: &Sources) -> Result<Node, SceneError> {
    let place = TextPlace {
        sources,
        source: 0,
        offset: 0,
    };
    place.check_depth(sources.text(0))?;
    let root = DeTable::parse(sources.text(0)).map_err(|e| place.syntax(&e))?;
    let table = place.table(root.into_inner())?;
    let span = place.span(0..0);
    if table.is_empty() {
        let error = SceneError::new(sources, span, "the scene is empty", "nothing here");
        return Err(error.with_help(IS_SCENE));
    }
    Ok(Node {
        key: span,
        span,
        value: Value::Table(table),
    })
}

/// Reads one value that stands at `offset` of source number `source`.
pub(super) fn value(
    sources: &Sources,
    source: usize,
    offset: usize,
    text: &str,
) -> Result<Node, SceneError> {
    let place = TextPlace {
        sources,
        source,
        offset,
    };
    place.check_depth(text)?;
    place.value(DeValue::parse(text).map_err(|e| place.syntax(&e))?)
}

struct TextPlace<'a> {
    sources: &'a Sources,
    source: usize,
    offset: usize,
}

impl TextPlace<'_> {
    fn span(&self, range: Range<usize>) -> Span {
        Span::new(
            self.source,
            self.offset + range.start..self.offset + range.end,
        )
    }

    fn error(&self, range: Range<usize>, message: &str, label: &str) -> SceneError {
        SceneError::new(self.sources, self.span(range), message, label)
    }

    fn syntax(&self, error: &Error) -> SceneError {
        let range = self.visible(error.span().unwrap_or(0..0));
        let written = self.sources.written(self.span(range.clone()));
        let holds = |line: &str| {
            let (place, c) = written::first_harmful(line)?;
            Some((place, format!("this line holds {c}")))
        };
        let said = self.in_line(range.start, holds);
        let meant = |line: &str| written::meant(line, self.offset == 0);
        let said = said.or_else(|| self.in_line(range.start, meant));
        let said = said.or_else(|| self.in_line(range.start, written::first_lookalike));
        let message = format!("not valid TOML: {}", error.message());
        let discreet = self.error(range.clone(), &message, "here");
        let error = match said {
            Some((place, message)) => self.error(place, &message, "here"),
            None if error.message() == "duplicate key" => {
                let message = format!("the key `{written}` is given twice");
                self.error(range, &message, "already given")
            }
            None => discreet.clone(),
        };
        error.or(discreet.with_help(IS_SCENE))
    }

    /// What is said of the line of this byte, and where.
    fn in_line(
        &self,
        byte: usize,
        said: impl Fn(&str) -> Option<(Range<usize>, String)>,
    ) -> Option<(Range<usize>, String)> {
        let text = &self.sources.text(self.source)[self.offset..];
        let start = text.get(..byte)?.rfind('\n').map_or(0, |n| n + 1);
        let line = text[start..].lines().next()?;
        let (place, message) = said(line)?;
        Some((start + place.start..start + place.end, message))
    }

    /// An error where brackets and dotted keys nest too deeply. They are counted before the text is parsed, because even dropping what
    /// a parser has made of them can overflow the stack.
    fn check_depth(&self, text: &str) -> Result<(), SceneError> {
        // levels of the open brackets, each with those of the key before it
        let mut open = Vec::new();
        let (mut depth, mut dots) = (0, 0);
        for token in Source::new(text).lex() {
            match token.kind() {
                TokenKind::LeftSquareBracket | TokenKind::LeftCurlyBracket => {
                    open.push(dots + 1);
                    depth += dots + 1;
                    dots = 0;
                }
                TokenKind::RightSquareBracket | TokenKind::RightCurlyBracket => {
                    depth -= open.pop().unwrap_or(0);
                    dots = 0;
                }
                TokenKind::Comma | TokenKind::Newline => dots = 0,
                TokenKind::Dot => dots += 1,
                _ => {}
            }
            if depth + dots > DEPTH {
                let range = token.span().start()..token.span().end();
                return Err(self.error(range, "this is nested too deeply for a scene", "here"));
            }
        }
        Ok(())
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

    fn value(&self, spanned: Spanned<DeValue<'_>>) -> Result<Node, SceneError> {
        let range = spanned.span();
        let fault = |message, label| Err(self.error(range.clone(), message, label));
        let value = match spanned.into_inner() {
            DeValue::String(text) => Value::Text(text.into_owned()),
            DeValue::Integer(number) => {
                match i64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(n) => Value::Integer(n),
                    Err(_) => return fault("this integer is too large", "does not fit 64 bits"),
                }
            }
            DeValue::Float(number) => match number.as_str().parse() {
                Ok(x) => Value::Float(x),
                Err(_) => return fault("this is not a number", "here"),
            },
            DeValue::Boolean(x) => Value::Boolean(x),
            DeValue::Datetime(_) => Value::Date,
            DeValue::Array(items) => {
                let items = items.into_iter().map(|item| self.value(item));
                Value::Array(items.collect::<Result<_, _>>()?)
            }
            DeValue::Table(table) => Value::Table(self.table(table)?),
        };
        let span = self.span(range);
        Ok(Node {
            key: span,
            span,
            value,
        })
    }

    fn table(&self, table: DeTable<'_>) -> Result<Table, SceneError> {
        let mut entries: Vec<_> = table.into_iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let read = |(key, item): (Spanned<Cow<str>>, _)| {
            let node = Node {
                key: self.span(key.span()),
                ..self.value(item)?
            };
            Ok((key.into_inner().into_owned(), node))
        };
        entries.into_iter().map(read).collect()
    }
}
