//! Typed access to a value: every getter names the field and its place when something is wrong.

use super::error::{SceneError, Sources, Span, quoted};
use super::key::{Key, NumberRange, Takes};
use super::likeness::{did_you_mean, listed};
use super::tree::{Node, Value};
use super::written::{comma_in_number, meant};
use indexmap::IndexMap;
use texts::described;

/// A value being read.
#[derive(Clone)]
pub struct Field<'a> {
    pub(crate) sources: &'a Sources,
    /// Dotted path; empty for the scene itself.
    pub path: String,
    /// Last part of the path.
    pub name: String,
    /// The value.
    pub(crate) node: &'a Node,
    /// Its key, where that is declared as data.
    pub(super) declared: Option<&'static Key>,
}

impl<'a> Field<'a> {
    /// A part of this value.
    pub(super) fn part(
        &self,
        name: &str,
        node: &'a Node,
        declared: Option<&'static Key>,
    ) -> Field<'a> {
        let path = match self.path.as_str() {
            "" => name.to_owned(),
            path => format!("{path}.{name}"),
        };
        Field {
            sources: self.sources,
            path,
            name: name.to_owned(),
            node,
            declared,
        }
    }

    /// A fault of this value.
    pub fn fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        SceneError::new(self.sources, self.node.span, message, label)
    }

    /// A fault of the key in front of this value.
    pub fn key_fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        SceneError::new(self.sources, self.node.key, message, label)
    }

    /// Where the value stands.
    pub(crate) fn span(&self) -> Span {
        self.node.span
    }

    pub(super) fn wrong_type(&self, wanted: &str) -> SceneError {
        let kind = self.node.value.kind();
        self.fault(
            format!("`{}` must be {wanted}, not {kind}", self.path),
            kind,
        )
    }

    /// The unit of its key; empty where it has none.
    pub fn unit(&self) -> &'static str {
        self.declared.map_or("", Key::unit)
    }

    /// The value as the user wrote it.
    pub fn written(&self) -> String {
        self.sources.written(self.node.span).to_owned()
    }

    /// A finite number, in the range of its key.
    pub fn number(&self) -> Result<f64, SceneError> {
        let x = match self.node.value {
            Value::Float(x) => x,
            Value::Integer(n) => n as f64,
            _ => return Err(self.no_number()),
        };
        let range = match self.declared.map(|key| key.takes) {
            Some(Takes::Number { range, .. }) => range,
            _ => NumberRange::Any,
        };
        match range.violated(x) {
            _ if !x.is_finite() => Err(self.must("be finite")),
            Some(requirement) => Err(self.must(&requirement)),
            None => Ok(x),
        }
    }

    /// A fault of a value that is no number: of a text that might be one, with what is meant.
    fn no_number(&self) -> SceneError {
        let error = self.wrong_type("a number");
        let Value::Text(text) = &self.node.value else {
            return error;
        };
        match (text.parse::<f64>(), meant(text, false)) {
            (Ok(_), _) => error.with_help(format!("write it without quotes: {text}")),
            (Err(_), Some((_, said))) if text.starts_with(|c: char| !c.is_alphabetic()) => {
                error.with_help(said)
            }
            _ => error,
        }
    }

    /// A fault of a number: what it must do.
    pub fn must(&self, requirement: &str) -> SceneError {
        self.fault(
            format!("`{}` must {requirement}, not {}", self.path, self.written()),
            format!("must {requirement}"),
        )
    }

    /// A whole number.
    pub fn integer(&self) -> Result<i64, SceneError> {
        match self.node.value {
            Value::Integer(n) => Ok(n),
            _ => Err(self.wrong_type("an integer")),
        }
    }

    /// `true` or `false`.
    pub fn boolean(&self) -> Result<bool, SceneError> {
        match self.node.value {
            Value::Boolean(x) => Ok(x),
            _ => {
                let error = self.wrong_type("true or false");
                Err(match &self.node.value {
                    Value::Text(text) if text.parse::<bool>().is_ok() => {
                        error.with_help(format!("write it without quotes: {text}"))
                    }
                    _ => error,
                })
            }
        }
    }

    /// `true`, `false` or one of the words of its key, whose place is returned.
    pub(crate) fn boolean_or_word(&self) -> Result<Result<bool, usize>, SceneError> {
        let Some(Takes::BooleanOr(words)) = self.declared.map(|key| key.takes) else {
            panic!("`{}` takes no word beside true and false", self.name);
        };
        match self.node.value {
            Value::Boolean(x) => Ok(Ok(x)),
            Value::Text(_) => {
                let places = words.iter().enumerate();
                let places: Vec<_> = places.map(|(i, word)| (*word, i)).collect();
                let place = self.choice(&places);
                let also = "or true or false, without quotes";
                place.map(Err).map_err(|error| error.with_help(also))
            }
            _ => Err(self.wrong_type(&format!("true, false or {}", quoted(words.iter().copied())))),
        }
    }

    /// Text that is not empty.
    pub fn text(&self) -> Result<&'a str, SceneError> {
        match &self.node.value {
            Value::Text(text) if text.trim().is_empty() => {
                Err(self.fault(format!("`{}` must not be empty", self.path), "empty"))
            }
            Value::Text(text) => Ok(text),
            _ => Err(self.wrong_type("a string")),
        }
    }

    /// Text in one line that is not empty.
    pub(crate) fn line(&self) -> Result<&'a str, SceneError> {
        match self.text()? {
            text if text.contains('\n') => {
                let message = format!("`{}` holds {}", self.path, described('\n'));
                let error = self.fault(message, "must be one line");
                Err(error.with_help("it stands in messages, above pictures and in captions"))
            }
            text => Ok(text),
        }
    }

    /// One of a few words.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, SceneError> {
        let text = self.text()?;
        if let Some((_, value)) = choices.iter().find(|(word, _)| *word == text) {
            return Ok(*value);
        }
        let words = choices.iter().map(|(word, _)| *word);
        let hint = did_you_mean(text, words.clone());
        let message = format!("`{}` cannot be \"{text}\"{hint}", self.path);
        let error = self.fault(message, "not known");
        Err(error.with_help(format!("known: {}", quoted(words))))
    }

    /// The place of a word among those of its key.
    pub(super) fn word(&self) -> Result<usize, SceneError> {
        let Some(Takes::Word(words)) = self.declared.map(|key| key.takes) else {
            panic!("`{}` takes no word", self.name);
        };
        let places = words.iter().enumerate();
        self.choice(&places.map(|(i, word)| (*word, i)).collect::<Vec<_>>())
    }

    /// The thing of this name, and its index.
    ///
    /// # Errors
    /// There is none.
    pub fn lookup<'m, T>(
        &self,
        kind: &str,
        known: &'m IndexMap<String, T>,
    ) -> Result<(usize, &'m T), SceneError> {
        let text = self.text()?;
        match known.get_full(text) {
            Some((index, _, value)) => Ok((index, value)),
            None => Err(self.dangling(kind, text, known.keys().map(String::as_str))),
        }
    }

    /// A fault: this value names something that does not exist.
    pub(crate) fn dangling<'k>(
        &self,
        kind: &str,
        name: &str,
        known: impl Iterator<Item = &'k str>,
    ) -> SceneError {
        self.missing(self.node.span, kind, name, known)
    }

    /// A fault: this key names something that does not exist.
    pub(crate) fn dangling_key<'k>(
        &self,
        kind: &str,
        known: impl Iterator<Item = &'k str>,
    ) -> SceneError {
        self.missing(self.node.key, kind, &self.name, known)
    }

    fn missing<'k>(
        &self,
        span: Span,
        kind: &str,
        name: &str,
        known: impl Iterator<Item = &'k str>,
    ) -> SceneError {
        let known: Vec<&str> = known.collect();
        let hint = did_you_mean(name, known.iter().copied());
        let message = format!("there is no {kind} `{name}`{hint}");
        let label = format!("no such {}", kind.split_whitespace().next().unwrap_or(kind));
        let error = SceneError::new(self.sources, span, message, label);
        error.with_help(match (known.is_empty(), kind.contains(' ')) {
            (true, true) => "it has none".to_owned(),
            (true, false) => format!("the scene has no {kind}s: add `[{kind}s.{name}]`"),
            (false, _) => listed(name, &known),
        })
    }

    /// The elements of an array.
    pub fn items(&self) -> Result<Vec<Field<'a>>, SceneError> {
        let Value::Array(items) = &self.node.value else {
            return Err(self.wrong_type("an array"));
        };
        let items = items.iter().enumerate();
        let items = items.map(|(index, node)| self.part(&index.to_string(), node, None));
        Ok(items.collect())
    }

    /// An array of N numbers; `shape` shows them.
    pub fn numbers<const N: usize>(&self, shape: &str) -> Result<[f64; N], SceneError> {
        let Value::Array(items) = &self.node.value else {
            return Err(self.wrong_type(shape));
        };
        if items.len() != N {
            let count = match items.len() {
                1 => "1 value".to_owned(),
                n => format!("{n} values"),
            };
            let message = format!("`{}` must be {shape}, not {count}", self.path);
            let error = self.fault(message, count);
            // [0,35, 0] has three numbers
            let written = self.written();
            let said = (items.len() > N)
                .then(|| comma_in_number(&written))
                .flatten();
            return Err(match said {
                Some(said) => error.with_help(said),
                None => error,
            });
        }
        let mut result = [0.0; N];
        for (x, item) in result.iter_mut().zip(self.items()?) {
            *x = item.number()?;
        }
        Ok(result)
    }

    /// What the numbers of its key are called, or those of each row.
    pub(crate) fn shape(&self) -> &'static str {
        match self.declared.map(|key| key.takes) {
            Some(Takes::Vector { shape, .. } | Takes::Rows { shape, .. }) => shape,
            _ => panic!("`{}` takes no vector", self.name),
        }
    }

    /// True of text.
    pub fn is_text(&self) -> bool {
        matches!(self.node.value, Value::Text(_))
    }

    /// True of a table.
    pub fn is_table(&self) -> bool {
        matches!(self.node.value, Value::Table(_))
    }
}
