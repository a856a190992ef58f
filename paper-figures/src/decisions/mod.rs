//! The predicates of the statements: the verdict, and the values that only this statement's templates in statements.toml use.

mod contact;
mod introduction;
mod model;
mod motion;

use crate::evidence::Evidence;
use crate::verdict::CriterionVerdict;
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
