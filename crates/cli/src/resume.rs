//! `looselink resume`

use super::failure::CommandFailure;
use super::progress::say;
use super::run::{RunOptions, all_files, not_stored, stop_on_interrupt, to_the_end};
use super::view;
use clap::Args;
use looselink::output::{Folder, Results, StoredCheckpoint};
use looselink::registry::Registry;
use looselink::simulate::Simulation;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct Arguments {
    /// The folder of a run that was interrupted or killed.
    folder: PathBuf,
    #[command(flatten)]
    options: RunOptions,
}

/// Goes on with a run as if it had never stopped: its files are those of a run without interruption.
pub fn resume(arguments: &Arguments) -> Result<(), CommandFailure> {
    let stop = stop_on_interrupt()?;
    let Arguments { folder, options } = arguments;
    let mut options = options.clone();
    let replaced = Folder::new(folder, &all_files(), true)?;
    let checkpoint = StoredCheckpoint::read(&replaced)?;
    let scene = checkpoint.scene(&Registry::standard())?;
    options.check(&scene)?;
    let mut simulation = Simulation::new(&scene)?;
    // a page of the part so far would be out of date
    options.view |= folder.join(view::PAGE).exists();
    let t = checkpoint.t();
    let results = Results::resume(replaced, &scene, &mut simulation, checkpoint);
    let results = results.map_err(|error| not_stored(error, folder, true))?;
    if !options.quiet {
        say(&format!("resumed at t = {t} s"));
    }
    to_the_end(simulation, results, folder, true, &options, stop)
}
