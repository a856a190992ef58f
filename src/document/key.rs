//! The keys of a table as data: the reader, its messages, the reference and the schema all come from them.

use super::error::quoted;

/// A key of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub takes: Takes,
    /// What holds without it; a required key has none.
    pub default: Option<&'static str>,
    /// What it means, in one line.
    pub purpose: &'static str,
}

/// The values that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Takes {
    /// A number.
    Number {
        /// Its unit; empty where it has none.
        unit: &'static str,
        /// Where it must lie.
        range: NumberRange,
    },
    /// A whole number from the first to the second.
    Whole(i64, i64),
    /// Numbers in brackets.
    Vector {
        /// The unit of each; empty where they have none.
        unit: &'static str,
        /// What they are called, such as `[x, y]`.
        shape: &'static str,
    },
    /// One of some words.
    Word(&'static [&'static str]),
    /// The name of something in this table of the scene, such as `materials`.
    Name(&'static str),
    /// A point as `"body.point"`.
    Point,
    /// A function of time.
    Function {
        /// The unit of its value.
        unit: &'static str,
    },
    /// Rows of numbers in brackets.
    Rows {
        /// Their units.
        unit: &'static str,
        /// What they are called, such as `[t, value]`.
        shape: &'static str,
    },
    /// A list of texts or names.
    List,
    /// One line of text.
    Text,
    /// true or false.
    Boolean,
    /// true, false or one of some words.
    BooleanOr(&'static [&'static str]),
    /// A path.
    Path,
    /// A table; of points, of keys of its own.
    Table,
}

/// Where a number must lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberRange {
    /// Anywhere.
    Any,
    /// Above zero.
    Positive,
    /// Not below zero.
    NonNegative,
    /// Not below this number.
    AtLeast(f64),
    /// Above the first number and not above the second.
    Within(f64, f64),
    /// From the first number to the second.
    Between(f64, f64),
}

impl NumberRange {
    /// What a number outside of the range must do.
    pub(super) fn violated(self, x: f64) -> Option<String> {
        match self {
            NumberRange::Positive if x <= 0.0 => Some("be greater than zero".into()),
            NumberRange::NonNegative if x < 0.0 => Some("not be negative".into()),
            NumberRange::AtLeast(least) if x < least => Some(format!("be at least {least}")),
            NumberRange::Within(above, most) if x <= above || x > most => {
                Some(format!("lie above {above} and not above {most}"))
            }
            NumberRange::Between(least, most) if x < least || x > most => {
                Some(format!("lie between {least} and {most}"))
            }
            _ => None,
        }
    }
}

impl Key {
    /// A required key.
    pub const fn new(name: &'static str, takes: Takes, purpose: &'static str) -> Key {
        Key {
            name,
            takes,
            default: None,
            purpose,
        }
    }

    /// A required number.
    pub const fn number(name: &'static str, unit: &'static str, purpose: &'static str) -> Key {
        let range = NumberRange::Any;
        Key::new(name, Takes::Number { unit, range }, purpose)
    }

    /// A required number above zero.
    pub const fn positive(name: &'static str, unit: &'static str, purpose: &'static str) -> Key {
        let range = NumberRange::Positive;
        Key::new(name, Takes::Number { unit, range }, purpose)
    }

    /// A required number not below zero.
    pub const fn non_negative(
        name: &'static str,
        unit: &'static str,
        purpose: &'static str,
    ) -> Key {
        let range = NumberRange::NonNegative;
        Key::new(name, Takes::Number { unit, range }, purpose)
    }

    /// A required number in a range, without unit.
    pub const fn within(name: &'static str, range: NumberRange, purpose: &'static str) -> Key {
        Key::new(name, Takes::Number { unit: "", range }, purpose)
    }

    /// A required vector, whose numbers are called as `shape` says.
    pub const fn vector(
        name: &'static str,
        unit: &'static str,
        shape: &'static str,
        purpose: &'static str,
    ) -> Key {
        Key::new(name, Takes::Vector { unit, shape }, purpose)
    }

    /// A required word, one of some.
    pub const fn word(
        name: &'static str,
        words: &'static [&'static str],
        purpose: &'static str,
    ) -> Key {
        Key::new(name, Takes::Word(words), purpose)
    }

    /// A required name of something in a table of the scene.
    pub const fn name_in(name: &'static str, table: &'static str, purpose: &'static str) -> Key {
        Key::new(name, Takes::Name(table), purpose)
    }

    /// A required function of time.
    pub const fn function(name: &'static str, unit: &'static str, purpose: &'static str) -> Key {
        Key::new(name, Takes::Function { unit }, purpose)
    }

    /// A required table.
    pub const fn table(name: &'static str, purpose: &'static str) -> Key {
        Key::new(name, Takes::Table, purpose)
    }

    /// A required point.
    pub const fn point(name: &'static str, purpose: &'static str) -> Key {
        Key::new(name, Takes::Point, purpose)
    }

    /// The same key, which may be left out; `default` says what holds then.
    #[must_use]
    pub const fn or(self, default: &'static str) -> Key {
        Key {
            default: Some(default),
            ..self
        }
    }

    /// Its unit; empty where it has none.
    pub fn unit(&self) -> &'static str {
        match self.takes {
            Takes::Number { unit, .. }
            | Takes::Vector { unit, .. }
            | Takes::Rows { unit, .. }
            | Takes::Function { unit } => unit,
            _ => "",
        }
    }

    /// What it is, for the message that it is missing.
    pub(crate) fn description(&self) -> String {
        let purpose = self.purpose;
        match self.takes {
            Takes::Point => format!("{purpose}, as \"body.point\""),
            Takes::Function { unit } => format!("{purpose} as a function of time [{unit}]"),
            Takes::Word(words) => {
                format!("{purpose}: {}", quoted(words.iter().copied()))
            }
            _ if self.unit().is_empty() => purpose.to_owned(),
            _ => format!("{purpose} [{}]", self.unit()),
        }
    }
}
