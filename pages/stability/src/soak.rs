//! Thousands of random mechanisms.

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use miette::{IntoDiagnostic, Result, miette};
use records::RunningCampaign;
use stability::random::soak::SoakTally;
use std::path::{Path, PathBuf};

/// What a soak is asked for.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Number of scenes.
    #[arg(long, default_value_t = 10_000)]
    count: u64,
    /// Number of the first scene.
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// The scenes are another set for every seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The folder that receives failing scenes.
    #[arg(long, default_value = "out/soak")]
    out: PathBuf,
    /// Where the tally goes instead of the record of the project.
    #[arg(long)]
    tally: Option<PathBuf>,
}

/// A line of progress for so many scenes, where there is no terminal.
const LINES: u64 = 500;

/// Runs the scenes; a failing one is an error.
pub fn soak(arguments: &Arguments) -> Result<()> {
    // a tally elsewhere is no record of the project
    let campaign = match arguments.tally {
        Some(_) => None,
        None => Some(RunningCampaign::begin("soak")?),
    };
    // a panic is a failure that is written down; its message is not for the terminal
    std::panic::set_hook(Box::new(|_| {}));
    let style = ProgressStyle::with_template("{bar:30} {pos}/{len}  {msg}").into_diagnostic()?;
    let bar = ProgressBar::new(arguments.count).with_style(style);
    let mut tally = SoakTally::new(arguments.seed);
    for index in arguments.first..arguments.first + arguments.count {
        tally.run(index, &arguments.out).into_diagnostic()?;
        bar.set_message(format!("{} failures", tally.failures.len()));
        bar.inc(1);
        // a bar shows itself on terminals only
        if bar.is_hidden() && tally.scenes.is_multiple_of(LINES) {
            let failures = tally.failures.len();
            eprintln!(
                "{} of {}, {failures} failures",
                tally.scenes, arguments.count
            );
        }
    }
    bar.finish();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("records/soak.json");
    let path = arguments.tally.as_ref().unwrap_or(&own);
    let text = serde_json::to_string_pretty(&tally).into_diagnostic()?;
    std::fs::write(path, text + "\n").into_diagnostic()?;
    if let Some(campaign) = campaign {
        campaign.finish()?;
    }
    match tally.failures.len() {
        0 => Ok(()),
        n => Err(miette!(
            "{n} scenes fail; they are in {}",
            arguments.out.display()
        )),
    }
}
