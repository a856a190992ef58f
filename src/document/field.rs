//! Typed access to a value: every getter names the field and its place when something is wrong.

use super::error::{SceneError, Sources, Span, did_you_mean};
use super::tree::{Node, Value};
use indexmap::IndexMap;

/// A value being read.
#[derive(Clone)]
pub struct Field<'a> {
    pub(crate) sources: &'a Sources,
    /// Dotted path.
    pub path: String,
    /// Last part of the path.
    pub name: String,
    /// Where the name stands.
    pub key: Span,
    /// The value.
    pub(crate) node: &'a Node,
}

impl<'a> Field<'a> {
    /// A fault of this value.
    pub fn fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        SceneError::new(self.sources, self.node.span, message.into(), label.into())
    }

    /// Where the value stands.
    pub(crate) fn span(&self) -> Span {
        self.node.span
    }

    /// A fault of another place in the same scene.
    pub(crate) fn fault_at(
        &self,
        span: Span,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> SceneError {
        SceneError::new(self.sources, span, message.into(), label.into())
    }

    /// A fault of the key in front of this value.
    pub fn key_fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        SceneError::new(self.sources, self.key, message.into(), label.into())
    }

    pub(crate) fn wrong_type(&self, wanted: &str) -> SceneError {
        let kind = self.node.value.kind();
        self.fault(
            format!("`{}` must be {wanted}, not {kind}", self.path),
            kind,
        )
    }

    /// The value as the user wrote it.
    pub fn written(&self) -> String {
        self.sources.written(self.node.span).to_owned()
    }

    /// A finite number.
    pub fn number(&self) -> Result<f64, SceneError> {
        let x = match self.node.value {
            Value::Float(x) => x,
            Value::Integer(n) => n as f64,
            _ => return Err(self.wrong_type("a number")),
        };
        if x.is_finite() {
            Ok(x)
        } else {
            Err(self.must("be finite"))
        }
    }

    /// A fault of a number: what it must do.
    pub fn must(&self, requirement: &str) -> SceneError {
        self.fault(
            format!("`{}` must {requirement}, not {}", self.path, self.written()),
            format!("must {requirement}"),
        )
    }

    /// A number greater than zero.
    pub fn positive(&self) -> Result<f64, SceneError> {
        let x = self.number()?;
        if x > 0.0 {
            Ok(x)
        } else {
            Err(self.must("be greater than zero"))
        }
    }

    /// A number not less than zero.
    pub fn non_negative(&self) -> Result<f64, SceneError> {
        let x = self.number()?;
        if x >= 0.0 {
            Ok(x)
        } else {
            Err(self.must("not be negative"))
        }
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
            _ => Err(self.wrong_type("true or false")),
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

    /// One of a few words.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, SceneError> {
        let text = self.text()?;
        if let Some((_, value)) = choices.iter().find(|(word, _)| *word == text) {
            return Ok(*value);
        }
        let words: Vec<_> = choices.iter().map(|(word, _)| *word).collect();
        let hint = did_you_mean(text, words.iter().copied());
        let list = words
            .iter()
            .map(|w| format!("\"{w}\""))
            .collect::<Vec<_>>()
            .join(", ");
        Err(self
            .fault(
                format!("`{}` cannot be \"{text}\"{hint}", self.path),
                "not known",
            )
            .with_help(format!("known: {list}")))
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
        dangling(self.sources, self.node.span, kind, name, known)
    }

    /// A fault: this key names something that does not exist.
    pub(crate) fn dangling_key<'k>(
        &self,
        kind: &str,
        known: impl Iterator<Item = &'k str>,
    ) -> SceneError {
        dangling(self.sources, self.key, kind, &self.name, known)
    }

    /// The elements of an array.
    pub fn items(&self) -> Result<Vec<Field<'a>>, SceneError> {
        let Value::Array(items) = &self.node.value else {
            return Err(self.wrong_type("an array"));
        };
        let item = |(index, node): (usize, &'a Node)| Field {
            sources: self.sources,
            path: format!("{}.{index}", self.path),
            name: index.to_string(),
            key: node.span,
            node,
        };
        Ok(items.iter().enumerate().map(item).collect())
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
            return Err(self.fault(message, count));
        }
        let mut result = [0.0; N];
        for (x, item) in result.iter_mut().zip(self.items()?) {
            *x = item.number()?;
        }
        Ok(result)
    }

    /// True of a table.
    pub fn is_table(&self) -> bool {
        matches!(self.node.value, Value::Table(_))
    }
}

fn dangling<'k>(
    sources: &Sources,
    span: Span,
    kind: &str,
    name: &str,
    known: impl Iterator<Item = &'k str>,
) -> SceneError {
    let known: Vec<&str> = known.collect();
    let hint = did_you_mean(name, known.iter().copied());
    let error = SceneError::new(
        sources,
        span,
        format!("there is no {kind} `{name}`{hint}"),
        format!("no such {}", kind.split_whitespace().next().unwrap_or(kind)),
    );
    match known.is_empty() {
        true => error.with_help(format!("the scene has no {kind} at all")),
        false => error.with_help(format!("known: {}", known.join(", "))),
    }
}
