//! Access to a table: keys that must or may be there, and no others.

use super::error::{SceneError, Sources, Span, did_you_mean, nearest};
use super::field::Field;
use super::key::{Key, Range, Takes};
use super::tree::{Node, Table, Value};

/// A table being read.
pub struct Fields<'a> {
    pub(crate) sources: &'a Sources,
    /// Dotted path; empty for the scene itself.
    pub(crate) path: String,
    /// The header, or the braces of an inline table.
    pub(crate) span: Span,
    /// Where its name stands.
    key: Span,
    table: &'a Table,
    /// The keys it may have, once they are declared.
    known: Vec<&'static str>,
    /// Those of them that are declared as data.
    keys: &'static [Key],
}

impl<'a> Fields<'a> {
    /// The scene itself.
    pub(crate) fn root(sources: &'a Sources, node: &'a Node) -> Result<Fields<'a>, SceneError> {
        let field = Field {
            sources,
            path: String::new(),
            name: String::new(),
            key: node.span,
            node,
        };
        field.fields()
    }

    /// Declares the keys this table may have; any other is a fault.
    pub(crate) fn only(&mut self, known: &[&'static str]) -> Result<(), SceneError> {
        self.known = known.to_vec();
        match self.table.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(self.unknown(key, known.iter().copied())),
            None => Ok(()),
        }
    }

    /// Declares the keys of a kind, after those that say which kind it is.
    ///
    /// # Errors
    /// Any other key.
    pub(crate) fn declare(
        &mut self,
        before: &[&'static str],
        keys: &'static [Key],
    ) -> Result<(), SceneError> {
        self.keys = keys;
        let own = keys.iter().map(|key| key.name);
        let known: Vec<_> = before.iter().copied().chain(own).collect();
        self.only(&known)
    }

    /// The dotted path of the table.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// A fault of the table, at its name.
    pub fn fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        SceneError::new(self.sources, self.key, message.into(), label.into())
    }

    fn key(&self, name: &'static str) -> &'static Key {
        let mut keys = self.keys.iter();
        keys.find(|key| key.name == name)
            .unwrap_or_else(|| panic!("`{name}` is read but not declared"))
    }

    /// The value of a declared key that must be there.
    ///
    /// # Errors
    /// It is missing.
    pub fn field(&self, name: &'static str) -> Result<Field<'a>, SceneError> {
        self.required(name, &self.key(name).description())
    }

    /// A declared number, in its range.
    ///
    /// # Errors
    /// It is missing, no number, or out of its range.
    pub fn number(&self, name: &'static str) -> Result<f64, SceneError> {
        self.field(name)
            .and_then(|field| self.in_range(&field, name))
    }

    /// A declared number that may be left out, in its range.
    ///
    /// # Errors
    /// It is no number, or out of its range.
    pub fn optional_number(&self, name: &'static str) -> Result<Option<f64>, SceneError> {
        let field = self.optional(name);
        field.map(|field| self.in_range(&field, name)).transpose()
    }

    /// `true` or `false`, which may be left out.
    ///
    /// # Errors
    /// It is neither.
    pub fn optional_boolean(&self, name: &'static str) -> Result<Option<bool>, SceneError> {
        self.optional(name).map(|field| field.boolean()).transpose()
    }

    /// A declared vector.
    ///
    /// # Errors
    /// It is missing, or no list of as many numbers.
    pub fn vector<const N: usize>(&self, name: &'static str) -> Result<[f64; N], SceneError> {
        self.field(name)?.numbers(self.shape(name))
    }

    /// A declared vector that may be left out.
    ///
    /// # Errors
    /// It is no list of as many numbers.
    pub fn optional_vector<const N: usize>(
        &self,
        name: &'static str,
    ) -> Result<Option<[f64; N]>, SceneError> {
        let field = self.optional(name);
        let numbers = field.map(|field| field.numbers(self.shape(name)));
        numbers.transpose()
    }

    fn shape(&self, name: &'static str) -> &'static str {
        match self.key(name).takes {
            Takes::Vector { shape, .. } => shape,
            _ => panic!("`{name}` takes no vector"),
        }
    }

    fn in_range(&self, field: &Field, name: &'static str) -> Result<f64, SceneError> {
        match self.key(name).takes {
            Takes::Number {
                range: Range::Positive,
                ..
            } => field.positive(),
            Takes::Number {
                range: Range::NonNegative,
                ..
            } => field.non_negative(),
            _ => field.number(),
        }
    }

    /// The place of a declared word among the words of its key.
    ///
    /// # Errors
    /// It is missing, or another word.
    pub fn word(&self, name: &'static str) -> Result<usize, SceneError> {
        self.field(name)
            .and_then(|field| self.place_of_word(&field, name))
    }

    /// As [`Fields::word`], for a word that may be left out.
    ///
    /// # Errors
    /// It is another word.
    pub fn optional_word(&self, name: &'static str) -> Result<Option<usize>, SceneError> {
        let field = self.optional(name);
        field
            .map(|field| self.place_of_word(&field, name))
            .transpose()
    }

    fn place_of_word(&self, field: &Field, name: &'static str) -> Result<usize, SceneError> {
        let Takes::Word(words) = self.key(name).takes else {
            panic!("`{name}` takes no word");
        };
        let choices: Vec<_> = words
            .iter()
            .enumerate()
            .map(|(i, word)| (*word, i))
            .collect();
        field.choice(&choices)
    }

    fn unknown(
        &self,
        key: &str,
        known: impl IntoIterator<Item = &'static str> + Clone,
    ) -> SceneError {
        let hint = did_you_mean(key, known.clone());
        let message = format!("unknown key `{key}` in {}{hint}", self.place());
        let list: Vec<_> = known.into_iter().collect();
        SceneError::new(
            self.sources,
            self.table[key].key,
            message,
            "unknown key".into(),
        )
        .with_help(format!("keys of this table: {}", list.join(", ")))
    }

    fn place(&self) -> &str {
        if self.path.is_empty() {
            "the scene"
        } else {
            &self.path
        }
    }

    /// The value of a key that must be there; `purpose` says what it is.
    pub(crate) fn required(
        &self,
        key: &'static str,
        purpose: &str,
    ) -> Result<Field<'a>, SceneError> {
        if let Some(field) = self.optional(key) {
            return Ok(field);
        }
        // Before `only` the table's keys are not declared yet: a misspelt discriminating key is reported as such.
        let stranger = self
            .table
            .keys()
            .find(|k| self.known.is_empty() && nearest(k, [key]).is_some());
        if let Some(stranger) = stranger {
            return Err(self.unknown(stranger, [key]));
        }
        let message = format!("missing key `{key}` in {}", self.place());
        Err(
            SceneError::new(self.sources, self.span, message, format!("needs `{key}`"))
                .with_help(format!("`{key}` is {purpose}")),
        )
    }

    /// The value of a key that may be left out.
    pub fn optional(&self, key: &'static str) -> Option<Field<'a>> {
        debug_assert!(
            self.known.is_empty() || self.known.contains(&key),
            "`{key}` is read but not declared"
        );
        let (name, entry) = self.table.get_key_value(key)?;
        Some(self.entry(name, entry.key, &entry.node))
    }

    /// All entries, for tables whose keys the user chooses.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Field<'a>> + use<'a, '_> {
        self.table
            .iter()
            .map(|(name, entry)| self.entry(name, entry.key, &entry.node))
    }

    fn entry(&self, name: &str, key: Span, node: &'a Node) -> Field<'a> {
        let path = if self.path.is_empty() {
            name.to_owned()
        } else {
            format!("{}.{name}", self.path)
        };
        Field {
            sources: self.sources,
            path,
            name: name.to_owned(),
            key,
            node,
        }
    }
}

impl<'a> Field<'a> {
    /// The fields of a table.
    pub(crate) fn fields(&self) -> Result<Fields<'a>, SceneError> {
        let Value::Table(table) = &self.node.value else {
            return Err(self.wrong_type("a table"));
        };
        Ok(Fields {
            sources: self.sources,
            path: self.path.clone(),
            span: self.node.span,
            key: self.key,
            table,
            known: Vec::new(),
            keys: &[],
        })
    }
}
