//! Suggestions for misspelt commands that clap does not make: it takes `rnu` for too far from `run`.

use clap::error::{ContextKind, ContextValue};
use clap::{Command, Error};
use looselink::document::nearest;

/// The same error of a command line, with the nearest command, where there is an unknown one and no suggestion yet.
pub fn added(mut error: Error, program: &Command) -> Error {
    let unknown = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(unknown)) => unknown,
        _ => return error,
    };
    let names = program.get_subcommands().map(Command::get_name);
    if error.get(ContextKind::SuggestedSubcommand).is_none()
        && let Some(near) = nearest(unknown, names)
    {
        let near = ContextValue::Strings(vec![near.to_owned()]);
        error.insert(ContextKind::SuggestedSubcommand, near);
    }
    error
}
