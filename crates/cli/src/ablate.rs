//! `looselink ablate`

use super::failure::CommandFailure;
use super::progress::show;
use super::{SceneArguments, print};
use clap::Args;
use folder::{Folder, json};
use serde::Serialize;
use std::path::PathBuf;
use studies::ablation::{AblationTiming, Observed, Repeatable, ablate as measure, kind};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The body whose displacement and acceleration are compared; by default the driven one, or else the last that moves.
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// Timed runs of every variant, after one that is not timed; by default up to five within a second.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    runs: Option<u32>,
    /// The folder that receives tables, numbers and a picture; it is created.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace an existing result; it is kept in `previous-result` inside the folder until the new one is complete.
    #[arg(long, requires = "out")]
    force: bool,
    /// Machine-readable output.
    #[arg(long)]
    json: bool,
    /// Show no progress; warnings are still shown.
    #[arg(long)]
    quiet: bool,
}

/// What `--json` prints.
#[derive(Serialize)]
struct AblationOutput<'a> {
    ablation: Repeatable<'a>,
    timing: AblationTiming,
}

/// Runs all variants of the scene; one that cannot be built is a row that says why.
pub fn ablate(arguments: &Arguments) -> Result<(), CommandFailure> {
    let new = |out: &PathBuf| Folder::claim(out, kind(), arguments.force);
    let folder = arguments.out.as_ref().map(new).transpose()?;
    let (scene, _) = arguments.scene.load()?;
    let body =
        Observed::choose(&scene, arguments.body.as_deref()).map_err(CommandFailure::bad_input)?;
    let runs = arguments.runs.map(|runs| runs as usize);
    let ablation = measure(&scene, body, runs, &mut |notice| {
        show(notice, arguments.quiet)
    });
    // What was measured is shown also where it cannot be stored.
    let stored = folder.map_or(Ok(()), |folder| ablation.write(folder));
    if arguments.json {
        print(json(&AblationOutput {
            ablation: ablation.repeatable(),
            timing: ablation.timing(),
        })?)?;
    } else {
        print(ablation.text())?;
    }
    Ok(stored?)
}
