//! Tests of the command line.

mod command_line;
mod precision;
mod process;
mod schema;
