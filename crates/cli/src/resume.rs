//! `looselink resume`

use super::failure::CommandFailure;
use super::interrupt::Interrupt;
use super::run::{RunOptions, not_stored, to_the_end};
use super::terminal::say;
use clap::Args;
use folder::OutputError;
use looselink::output::{Results, StoredCheckpoint};
use looselink::registry::Registry;
use looselink::simulate::Simulation;
use std::path::PathBuf;
use view::kind;

#[derive(Debug, Args)]
pub struct Arguments {
    /// The folder of a run that was interrupted or killed.
    folder: PathBuf,
    #[command(flatten)]
    options: RunOptions,
}

/// Goes on with a run as if it had never stopped: its files are those of a run without interruption.
pub fn resume(arguments: &Arguments) -> Result<(), CommandFailure> {
    let interrupt = Interrupt::watch()?;
    let Arguments { folder, options } = arguments;
    let checkpoint = StoredCheckpoint::read(folder, kind()).map_err(|error| match error {
        OutputError::OfAnotherKind { held, .. } => CommandFailure::bad_input(format!(
            "`{}` holds {held}, and only runs are resumed; an interrupted sweep goes on by the same command",
            folder.display()
        )),
        error => error.into(),
    })?;
    let scene = checkpoint.scene(&Registry::standard())?;
    options.check(&scene)?;
    let mut simulation = Simulation::new(&scene)?;
    let t = checkpoint.t();
    interrupt.begin();
    let results = Results::resume(checkpoint, &scene, &mut simulation);
    let results = results.map_err(|error| not_stored(error, folder, true))?;
    if !options.quiet {
        say(&format!("resumed at t = {t} s"));
    }
    to_the_end(simulation, results, folder, true, options, interrupt)
}
