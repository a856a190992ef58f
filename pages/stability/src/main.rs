//! Makes the maps and the checks of hard cases and writes STABILITY.md.

mod alarms;
mod soak;

use clap::{Parser, Subcommand};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::RunningCampaign;
use stability::cases::CASES;
use stability::map::{MadeMap, Map, files};
use stability::outcome::OutcomeClass;
use stability::page;
use stability::random::soak::scene;
use stability::records::{Records, write_long};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the hard cases and writes STABILITY.md.
#[derive(Debug, Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Makes one map and shows what was said of every run that is not accurate.
    Map {
        /// The beginning of its name, such as 01.
        name: String,
    },
    /// Makes the checks that take minutes, such as ten million steps, and records them for the page.
    Long,
    /// Runs many random scenes and writes the tally to pages/stability/records/soak.json.
    Soak(soak::Arguments),
    /// Runs every dynamic scene with every method, six steps and twelve intervals of rows, and judges what is stopped as unstable.
    Alarms {
        /// Paths below `scenes/`, without the ending, such as hard/chatter; all when there are none.
        scenes: Vec<String>,
    },
    /// Prints one scene of a soak.
    Scene {
        /// The seed of the soak.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// Its number.
        index: u64,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().command {
        None => write_page(),
        Some(Command::Map { name }) => show_map(&name),
        Some(Command::Long) => long(),
        Some(Command::Alarms { scenes }) => alarms::alarms(&records::root(), &scenes),
        Some(Command::Soak(arguments)) => soak::soak(&arguments),
        Some(Command::Scene { seed, index }) => {
            print!("{}", scene(seed, index).text);
            Ok(())
        }
    }
}

fn make(path: &Path) -> Result<MadeMap> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let started = Instant::now();
    let made = Map::load(path)
        .into_diagnostic()?
        .make(&name)
        .into_diagnostic()?;
    let pictures = records::root().join("pages/stability/figures");
    plot::save(&made.figure(), &pictures, &name)?;
    let seconds = started.elapsed().as_secs_f64();
    eprintln!("{name}: {} runs in {seconds:.1} s", made.cells.len());
    Ok(made)
}

fn write_page() -> Result<()> {
    let campaign = RunningCampaign::begin("maps")?;
    let started = Instant::now();
    let paths = files().into_diagnostic()?;
    let made = paths
        .iter()
        .map(|path| make(path))
        .collect::<Result<Vec<MadeMap>>>()?;
    let mut checks = Vec::new();
    for case in &CASES {
        eprintln!("case {}: {}", case.number, case.title);
        checks.push((case.checks)());
    }
    let records = Records::read().into_diagnostic()?;
    let minutes = started.elapsed().as_secs_f64() / 60.0;
    let text = page::page(&made, &checks, &records, minutes);
    let path = records::root().join("STABILITY.md");
    std::fs::write(&path, text)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    campaign.finish()
}

fn show_map(name: &str) -> Result<()> {
    let paths = files().into_diagnostic()?;
    let named = |path: &&PathBuf| {
        path.file_name()
            .is_some_and(|file| file.to_string_lossy().starts_with(name))
    };
    let path = paths.iter().find(named);
    let path =
        path.ok_or_else(|| miette!("no map in pages/stability/maps begins with {name:?}"))?;
    let made = make(path)?;
    for cell in made
        .cells
        .iter()
        .filter(|c| c.outcome != OutcomeClass::Accurate)
    {
        let [method, parameter, step] = cell.at;
        println!(
            "{}, {} {:e}, step {:e} s: {}, error {}: {}",
            made.map.methods[method],
            made.map.parameter.label,
            made.map.parameter.values[parameter],
            made.map.steps[step],
            cell.outcome.name(),
            cell.error.map_or("-".to_owned(), |e| format!("{e:.2e}")),
            cell.said
        );
    }
    Ok(())
}

fn long() -> Result<()> {
    let campaign = RunningCampaign::begin("long")?;
    let mut found = Vec::new();
    for case in &CASES {
        let Some(checks) = case.long else { continue };
        eprintln!("case {}: {}", case.number, case.title);
        let made = checks();
        for check in &made {
            eprintln!("  {}: {}", check.criterion, check.number());
        }
        found.push((case.number, made));
    }
    write_long(&found).into_diagnostic()?;
    campaign.finish()
}
