//! `looselink precision`

use super::failure::Failure;
use super::print;
use super::progress::show;
use clap::Args;
use looselink::output::Folder;
use looselink::simulate::Notice;
use std::path::PathBuf;
use studies::machine::machine;
use studies::precision::{Effort, FILES, Study, Survey, page, run};

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
pub fn precision(arguments: &Arguments) -> Result<(), Failure> {
    let folder = Folder::new(&arguments.out, &FILES, arguments.force)?;
    let study = Study::load(&arguments.study)?;
    folder.prepare()?;
    let effort = Effort {
        repeats: if arguments.smoke {
            1
        } else {
            arguments.repeats.into()
        },
        smoke: arguments.smoke,
    };
    let mut tell = |notice: Notice| show(notice, arguments.quiet);
    let machine = machine();
    let (page, stored) = match study.statistics {
        Some(_) => {
            let survey = Survey::run(&study, effort, &mut tell)?;
            (survey.page(&study, &machine), survey.write(&study, &folder))
        }
        None => {
            let outcome = run(&study, effort, &mut tell)?;
            (page(&outcome, &machine), outcome.write(&study, &folder))
        }
    };
    // What was measured is shown also where it cannot be stored.
    print(&page)?;
    Ok(stored?)
}
