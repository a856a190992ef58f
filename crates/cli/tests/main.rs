//! Tests of the command line.

mod command_line;
mod completions;
mod earlier;
mod hostile;
mod limits;
mod modes;
mod named_files;
mod new;
mod plot;
mod precision;
mod process;
mod schema;
mod slips;
mod suggestions;
mod tutorial;
mod view;
