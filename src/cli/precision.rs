//! `looselink precision`

use super::failure::Failure;
use super::print;
use super::progress::say;
use clap::Args;
use looselink::precision::{Effort, Folder, Study, Survey, run};
use std::path::PathBuf;

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
    /// Only the first point of every curve, timed once: to see that a study works.
    #[arg(long)]
    smoke: bool,
    /// Replace results that stand in the folder.
    #[arg(long)]
    force: bool,
    /// Show no progress.
    #[arg(long)]
    quiet: bool,
}

/// Makes all runs of a study and writes what they found and what they took.
pub fn precision(arguments: &Arguments) -> Result<(), Failure> {
    let folder = Folder::new(&arguments.out, arguments.force)?;
    let study = Study::load(&arguments.study)?;
    let effort = Effort {
        repeats: if arguments.smoke {
            1
        } else {
            arguments.repeats.into()
        },
        smoke: arguments.smoke,
    };
    let mut tell = |name: &str| {
        if !arguments.quiet {
            say(name);
        }
    };
    let page = match study.statistics {
        Some(_) => folder.write_survey(&study, &Survey::run(&study, effort, &mut tell)?)?,
        None => folder.write(&study, &run(&study, effort, &mut tell)?)?,
    };
    print(&page)
}
