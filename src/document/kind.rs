//! Kinds of things that a table can describe: its `type`, or another key, says which.

use super::error::SceneError;
use super::fields::Fields;
use super::key::Key;

/// A kind of thing: its name, its keys, and how it is read.
#[derive(Debug)]
pub struct Kind<F: 'static> {
    /// What the key says.
    pub name: &'static str,
    /// Its other keys.
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
        Kind::by("type", table, &format!("the kind of {what}"), kinds)
    }

    /// As [`Kind::of`], for a table in which another key says which kind it is; `what` says what this key means.
    pub(crate) fn by(
        key: &'static str,
        table: &mut Fields,
        what: &str,
        kinds: &[&'static Kind<F>],
    ) -> Result<&'static Kind<F>, SceneError> {
        let choices: Vec<_> = kinds.iter().map(|kind| (kind.name, *kind)).collect();
        let names: Vec<_> = kinds.iter().map(|k| format!("{:?}", k.name)).collect();
        let purpose = format!("{what}: {}", names.join(", "));
        let kind = table.required(key, &purpose)?.choice(&choices)?;
        table.declare(&[key], kind.keys)?;
        Ok(kind)
    }
}
