//! Kinds of things that a table can describe: its `type`, or another key, says which.

use super::error::{SceneError, quoted};
use super::field::Field;
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
    /// The kind that the `type` of a table names, and the table with the keys of this kind.
    pub(crate) fn of<'a>(
        field: &Field<'a>,
        what: &str,
        kinds: &[&'static Kind<F>],
    ) -> Result<(&'static Kind<F>, Fields<'a>), SceneError> {
        Kind::by("type", field, &format!("the kind of {what}"), kinds)
    }

    /// As [`Kind::of`], for a table in which another key says which kind it is; `what` says what this key means.
    pub(crate) fn by<'a>(
        key: &'static str,
        field: &Field<'a>,
        what: &str,
        kinds: &[&'static Kind<F>],
    ) -> Result<(&'static Kind<F>, Fields<'a>), SceneError> {
        let mut table = field.fields()?;
        let choices: Vec<_> = kinds.iter().map(|kind| (kind.name, *kind)).collect();
        let names = quoted(kinds.iter().map(|kind| kind.name));
        let purpose = format!("{what}: {names}");
        let kind = table.required(key, &purpose)?.choice(&choices)?;
        table.declare(&[key], kind.keys)?;
        Ok((kind, table))
    }
}
