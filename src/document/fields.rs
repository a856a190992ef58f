//! Access to a table: keys that must or may be there, and no others.

use super::error::{SceneError, Sources};
use super::field::Field;
use super::key::Key;
use super::likeness::{did_you_mean, nearest};
use super::tree::{Node, Table, Value};

/// A table being read.
pub struct Fields<'a> {
    /// The table as a value: the header, or the braces of an inline table.
    pub(crate) whole: Field<'a>,
    table: &'a Table,
    /// The keys it may have, once they are declared.
    known: Vec<&'static str>,
    /// Those of them that are declared as data.
    keys: Vec<&'static Key>,
}

impl<'a> Fields<'a> {
    /// The scene itself.
    pub(crate) fn root(sources: &'a Sources, node: &'a Node) -> Result<Fields<'a>, SceneError> {
        let field = Field {
            sources,
            path: String::new(),
            name: String::new(),
            node,
            declared: None,
        };
        field.fields()
    }

    /// Declares the keys of a kind, after those that say which kind it is.
    ///
    /// # Errors
    /// Any other key.
    pub(crate) fn declare(
        &mut self,
        before: &[&'static str],
        keys: impl IntoIterator<Item = &'static Key>,
    ) -> Result<(), SceneError> {
        self.keys = keys.into_iter().collect();
        let own = self.keys.iter().map(|key| key.name);
        self.known = before.iter().copied().chain(own).collect();
        match self.stranger() {
            Some(key) => Err(self.unknown(key, &self.known)),
            None => Ok(()),
        }
    }

    /// The first key that is not declared.
    pub(super) fn stranger(&self) -> Option<&str> {
        let mut written = self.table.keys().map(String::as_str);
        written.find(|key| !self.known.contains(key))
    }

    /// The dotted path of the table.
    pub fn path(&self) -> &str {
        &self.whole.path
    }

    /// A fault of the table, at its name.
    pub fn fault(&self, message: impl Into<String>, label: impl Into<String>) -> SceneError {
        self.whole.key_fault(message, label)
    }

    fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name).copied()
    }

    /// The value of a declared key that must be there.
    ///
    /// # Errors
    /// It is missing.
    pub fn field(&self, name: &'static str) -> Result<Field<'a>, SceneError> {
        let Some(key) = self.key(name) else {
            panic!("`{name}` is read but not declared");
        };
        self.required(name, &key.description())
    }

    /// A declared number, in its range.
    ///
    /// # Errors
    /// It is missing, no number, or out of its range.
    pub fn number(&self, name: &'static str) -> Result<f64, SceneError> {
        self.field(name)?.number()
    }

    /// A declared number that may be left out, in its range.
    ///
    /// # Errors
    /// It is no number, or out of its range.
    pub fn optional_number(&self, name: &'static str) -> Result<Option<f64>, SceneError> {
        self.optional(name).map(|field| field.number()).transpose()
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
        let field = self.field(name)?;
        field.numbers(field.shape())
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
        field.map(|field| field.numbers(field.shape())).transpose()
    }

    /// The place of a declared word among the words of its key.
    ///
    /// # Errors
    /// It is missing, or another word.
    pub fn word(&self, name: &'static str) -> Result<usize, SceneError> {
        self.field(name)?.word()
    }

    /// As [`Fields::word`], for a word that may be left out.
    ///
    /// # Errors
    /// It is another word.
    pub fn optional_word(&self, name: &'static str) -> Result<Option<usize>, SceneError> {
        self.optional(name).map(|field| field.word()).transpose()
    }

    fn unknown(&self, key: &str, known: &[&str]) -> SceneError {
        let hint = did_you_mean(key, known.iter().copied());
        let message = format!("unknown key `{key}` in {}{hint}", self.place());
        let place = self.table[key].key;
        let error = SceneError::new(self.whole.sources, place, message, "unknown key");
        error.with_help(format!("keys of this table: {}", known.join(", ")))
    }

    fn place(&self) -> &str {
        match self.path() {
            "" => "the scene",
            path => path,
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
        // Before the table's keys are declared a misspelt discriminating key is reported as such.
        let misspelt = |k: &&String| self.known.is_empty() && nearest(k, [key]).is_some();
        if let Some(stranger) = self.table.keys().find(misspelt) {
            return Err(self.unknown(stranger, &[key]));
        }
        let message = format!("missing key `{key}` in {}", self.place());
        let error = self.whole.fault(message, format!("needs `{key}`"));
        Err(error.with_help(format!("`{key}` is {purpose}")))
    }

    /// The value of a key that may be left out.
    pub fn optional(&self, name: &'static str) -> Option<Field<'a>> {
        debug_assert!(
            self.known.is_empty() || self.known.contains(&name),
            "`{name}` is read but not declared"
        );
        let node = self.table.get(name)?;
        Some(self.whole.part(name, node, self.key(name)))
    }

    /// All entries, for tables whose keys the user chooses.
    pub(crate) fn entries(&self) -> impl Iterator<Item = Field<'a>> + use<'a, '_> {
        let entries = self.table.iter();
        entries.map(|(name, node)| self.whole.part(name, node, None))
    }
}

impl<'a> Field<'a> {
    /// The fields of a table.
    pub(crate) fn fields(&self) -> Result<Fields<'a>, SceneError> {
        let Value::Table(table) = &self.node.value else {
            return Err(self.wrong_type("a table"));
        };
        Ok(Fields {
            whole: self.clone(),
            table,
            known: Vec::new(),
            keys: Vec::new(),
        })
    }
}
