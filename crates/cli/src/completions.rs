//! `looselink completions`: a script by which a shell completes commands, options and templates.

use super::failure::CommandFailure;
use super::print;
use clap::{Args, CommandFactory};
use clap_complete::{Shell, generate};

#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell.
    shell: Shell,
}

/// Prints the script.
pub fn completions(arguments: &Arguments) -> Result<(), CommandFailure> {
    let mut script = Vec::new();
    let mut command = super::Arguments::command();
    generate(arguments.shell, &mut command, "looselink", &mut script);
    print(script)
}
