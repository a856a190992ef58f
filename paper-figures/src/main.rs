//! Regenerates Figs. 5 to 9 of the paper and decides its statements by computed quantities.

mod campaign;
mod fig05;
mod fig06;
mod fig07;
mod fig08;
mod fig09;
mod figures;
mod kinematics;
mod measures;
mod numbers;
mod reproduction;
mod runs;
mod scans;
mod scans_list;
mod scans_page;
mod signal;
mod statement;
mod statements_acceleration;
mod statements_contact;
mod statements_error;
mod statements_setup;

use campaign::{Campaign, Settings};
use clap::{Parser, Subcommand};
use miette::{IntoDiagnostic, Result, WrapErr};
use numbers::Numbers;
use plot::Figure;
use records::Run;
use std::fs;
use std::path::Path;

/// Regenerates the figures of the paper and REPRODUCTION.md; with `scans`, the parameter scans and SCANS.md.
#[derive(Parser)]
#[command(args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    settings: Settings,
}

#[derive(Subcommand)]
enum Command {
    /// Scans one parameter at a time around the printed and assumed values.
    Scans {
        /// Step (s) of all scans but that of the step itself.
        #[arg(long, default_value_t = 1e-5)]
        step: f64,
    },
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    match arguments.command {
        Some(Command::Scans { step }) => scan(step),
        None => reproduce(arguments.settings),
    }
}

fn reproduce(settings: Settings) -> Result<()> {
    let run = Run::begin("reproduction")?;
    let mut numbers = Numbers::default();
    let campaign = Campaign::run(settings)?;
    let figures = figures::all(&campaign, &mut numbers);
    let page = reproduction::page(&campaign, &mut numbers);
    write(&figures, "REPRODUCTION.md", &page, "numbers.json", &numbers)?;
    run.finish()
}

fn scan(step: f64) -> Result<()> {
    let run = Run::begin("scans")?;
    let mut numbers = Numbers::default();
    let scans = scans::run(step)?;
    let names: Vec<String> = scans.iter().map(|s| format!("scans-{}", s.slug)).collect();
    let figures: Vec<(&str, Figure)> = names
        .iter()
        .map(String::as_str)
        .zip(scans.iter().map(|s| scans_page::figure(s, step)))
        .collect();
    let page = scans_page::page(&scans, step, &mut numbers);
    write(&figures, "SCANS.md", &page, "scans.json", &numbers)?;
    run.finish()
}

/// Writes figures, a page and the numbers in both.
fn write(
    figures: &[(&str, Figure)],
    name: &str,
    page: &str,
    data: &str,
    numbers: &Numbers,
) -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = root.join("figures");
    figures::save_all(figures, &folder)?;
    let path = root.join(name);
    fs::write(&path, page)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    numbers.save(&folder.join(data))
}
