//! The predicates of the statements: the verdict, and the values of the templates in statements.toml.

mod contact;
mod introduction;
mod model;
mod motion;

use crate::evidence::Evidence;
use crate::verdict::{CriterionVerdict, above, below, within};
use minijinja::Value;

/// A verdict with the values of its templates.
pub type Decision = (CriterionVerdict, Value);
/// The key of a statement and its predicate.
pub type Decide = (&'static str, fn(&Evidence) -> Decision);

/// All predicates.
pub fn all() -> impl Iterator<Item = Decide> {
    let lists: [&[Decide]; 4] = [
        &introduction::DECISIONS,
        &model::DECISIONS,
        &motion::DECISIONS,
        &contact::DECISIONS,
    ];
    lists.into_iter().flatten().copied()
}

/// The predicate of a statement.
pub fn find(key: &str) -> Option<fn(&Evidence) -> Decision> {
    all()
        .find(|(known, _)| *known == key)
        .map(|(_, decide)| decide)
}

fn holds(condition: bool) -> CriterionVerdict {
    CriterionVerdict::of(condition)
}

/// A number between two others.
fn between(x: f64, low: f64, high: f64) -> CriterionVerdict {
    holds((low..=high).contains(&x))
}
