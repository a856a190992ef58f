//! Access to a table: keys that must or may be there, and no others.

use super::document::{Node, Table, Value};
use super::error::{SceneError, Sources, Span, did_you_mean, nearest};
use super::field::Field;

/// A table being read.
pub(super) struct Fields<'a> {
    pub sources: &'a Sources,
    /// Dotted path; empty for the scene itself.
    pub path: String,
    /// The header, or the braces of an inline table.
    pub span: Span,
    pub table: &'a Table,
    /// The keys it may have, once they are declared.
    pub known: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    /// The scene itself.
    pub(super) fn root(sources: &'a Sources, node: &'a Node) -> Result<Fields<'a>, SceneError> {
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
    pub(super) fn only(&mut self, known: &[&'static str]) -> Result<(), SceneError> {
        self.known = known.to_vec();
        match self.table.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(self.unknown(key, known.iter().copied())),
            None => Ok(()),
        }
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
    pub(super) fn required(
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
    pub(super) fn optional(&self, key: &'static str) -> Option<Field<'a>> {
        debug_assert!(
            self.known.is_empty() || self.known.contains(&key),
            "`{key}` is read but not declared"
        );
        let (name, entry) = self.table.get_key_value(key)?;
        Some(self.field(name, entry.key, &entry.node))
    }

    /// All entries, for tables whose keys the user chooses.
    pub(super) fn entries(&self) -> impl Iterator<Item = Field<'a>> + use<'a, '_> {
        self.table
            .iter()
            .map(|(name, entry)| self.field(name, entry.key, &entry.node))
    }

    fn field(&self, name: &str, key: Span, node: &'a Node) -> Field<'a> {
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
    pub(super) fn fields(&self) -> Result<Fields<'a>, SceneError> {
        let Value::Table(table) = &self.node.value else {
            return Err(self.wrong_type("a table"));
        };
        Ok(Fields {
            sources: self.sources,
            path: self.path.clone(),
            span: self.node.span,
            table,
            known: Vec::new(),
        })
    }
}
