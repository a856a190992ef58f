//! The command line of Looselink.

mod cli;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main(&cli::Arguments::parse())
}
