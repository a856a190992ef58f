//! `looselink precision`

use super::failure::CommandFailure;
use super::print;
use super::progress::show;
use clap::Args;
use folder::Folder;
use std::path::PathBuf;
use studies::machine::machine;
use studies::precision::{
    Compared, Effort, Found, MotionReference, StatisticsReference, Study, kind,
};

#[derive(Debug, Args)]
pub struct Arguments {
    /// The study file.
    study: PathBuf,
    /// The folder that receives the results; it is created.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Timed runs of every point, after a first one that is not timed.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// Run only the first point of every curve and time it once, to check that the study works.
    #[arg(long)]
    smoke: bool,
    /// Replace an existing result; it is kept in `previous-result` inside the folder until the new one is complete.
    #[arg(long)]
    force: bool,
    /// Show no progress; warnings are still shown.
    #[arg(long)]
    quiet: bool,
}

/// Makes all runs of a study and writes what they found and what they took.
pub fn precision(arguments: &Arguments) -> Result<(), CommandFailure> {
    let folder = Folder::claim(&arguments.out, kind(), arguments.force)?;
    let study = Study::load(&arguments.study)?;
    match study.statistics {
        Some(_) => make::<StatisticsReference>(arguments, &study, folder),
        None => make::<MotionReference>(arguments, &study, folder),
    }
}

fn make<C: Compared>(
    arguments: &Arguments,
    study: &Study,
    folder: Folder,
) -> Result<(), CommandFailure> {
    let smoke = arguments.smoke;
    let effort = Effort {
        repeats: if smoke { 1 } else { arguments.repeats.into() },
        smoke,
    };
    let found: Found<C> = Found::run(study, effort, &mut |notice| show(notice, arguments.quiet))?;
    let machine = machine();
    let stored = found.write(study, &machine, folder);
    // What was measured is shown also where it cannot be stored.
    print(found.page(study, &machine))?;
    Ok(stored?)
}
