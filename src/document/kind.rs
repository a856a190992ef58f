//! Kinds of things that a table can describe: its `type` says which.

use super::error::SceneError;
use super::fields::Fields;
use super::key::Key;

/// A kind of thing: its name, its keys, and how it is read.
#[derive(Debug)]
pub struct Kind<F: 'static> {
    /// `type`
    pub name: &'static str,
    /// Its keys beside `type`.
    pub keys: &'static [Key],
    /// Reads it.
    pub read: F,
}

impl<F> Kind<F> {
    /// The kind that the `type` of a table names; declares its keys.
    pub(crate) fn of(
        table: &mut Fields,
        what: &str,
        kinds: &[&'static Kind<F>],
    ) -> Result<&'static Kind<F>, SceneError> {
        let choices: Vec<_> = kinds.iter().map(|kind| (kind.name, *kind)).collect();
        let names: Vec<_> = kinds.iter().map(|k| format!("{:?}", k.name)).collect();
        let purpose = format!("the kind of {what}: {}", names.join(", "));
        let kind = table.required("type", &purpose)?.choice(&choices)?;
        table.declare(&["type"], kind.keys)?;
        Ok(kind)
    }
}
