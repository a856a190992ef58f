//! What a user wrote: TOML text as a tree that knows where everything stands, typed access to it, and errors that point at it.

mod characters;
mod error;
mod field;
mod fields;
mod key;
mod kind;
mod likeness;
mod names;
mod overrides;
mod text;
mod tree;
mod written;

pub(crate) use characters::{check_overrides, check_texts};
pub use error::{SceneError, Span};
pub(crate) use error::{Sources, quoted};
pub use field::Field;
pub use fields::Fields;
pub use key::{Key, NumberRange, Takes};
pub use kind::Kind;
pub(crate) use likeness::listed;
pub use likeness::{did_you_mean, nearest};
pub use names::derived;
pub(crate) use names::{RESERVED, check_name, named};
pub(crate) use overrides::apply as apply_overrides;
pub(crate) use tree::{Node, document, is_scene, no_scene};
pub(crate) use written::{decimal_comma, lookalike, quantity};
