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
        let declared = table.declare(&[key], kind.keys);
        declared.map_err(|error| match table.stranger() {
            Some(stranger) => of_others(error, key, stranger, kinds),
            None => error,
        })?;
        Ok((kind, table))
    }
}

/// The fault of a key that a kind does not have, with the kinds that have it: perhaps one of them was meant.
fn of_others<F>(
    error: SceneError,
    key: &str,
    stranger: &str,
    kinds: &[&'static Kind<F>],
) -> SceneError {
    let has = |kind: &&&'static Kind<F>| kind.keys.iter().any(|own| own.name == stranger);
    let others = kinds.iter().filter(has).map(|kind| kind.name);
    match quoted(others) {
        none if none.is_empty() => error,
        others => error.with_help(format!("`{stranger}` is a key of {key} {others}")),
    }
}
