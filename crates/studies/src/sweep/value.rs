//! A value that a sweep gives to a field of a scene.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What a field can be set to; integers are told from other numbers, because a scene tells them too.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum FieldValue {
    /// `true` or `false`.
    Flag(bool),
    /// A whole number, such as a number of elements.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A word, such as the name of a model.
    Word(String),
}

impl FieldValue {
    /// As a number; none for words and flags.
    pub fn number(&self) -> Option<f64> {
        match self {
            FieldValue::Whole(n) => Some(*n as f64),
            FieldValue::Number(x) => Some(*x),
            FieldValue::Flag(_) | FieldValue::Word(_) => None,
        }
    }
}

impl fmt::Display for FieldValue {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            FieldValue::Flag(flag) => write!(f, "{flag}"),
            FieldValue::Whole(n) => write!(f, "{n}"),
            FieldValue::Number(x) => f.write_str(&numbers::exact(*x)),
            FieldValue::Word(word) => f.write_str(word),
        }
    }
}
