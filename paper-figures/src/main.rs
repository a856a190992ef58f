//! Regenerates Figs. 5 to 9 of the paper and decides its statements by computed quantities.

mod campaign;
mod ensembles;
mod ensembles_page;
mod evidence;
mod exponents;
mod fig05;
mod fig06;
mod fig07;
mod fig08;
mod fig09;
mod figures;
mod interval;
mod kinematics;
mod measures;
mod methods;
mod numbers;
mod record;
mod reproduction;
mod runs;
mod scans;
mod scans_list;
mod scans_page;
mod shuffles;
mod signal;
mod statement;
mod statements_acceleration;
mod statements_contact;
mod statements_error;
mod statements_introduction;
mod statements_model;
mod statements_setup;
mod timings;
mod warned;

use campaign::{Campaign, Settings};
use clap::{Parser, Subcommand};
use evidence::Evidence;
use miette::{IntoDiagnostic, Result, WrapErr};
use numbers::Numbers;
use plot::Figure;
use record::EnsembleRecord;
use records::RunningCampaign;
use std::fs;
use std::path::Path;

/// Regenerates the figures of the paper and REPRODUCTION.md from its runs and the record of `ensembles`.
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
    /// Makes the ensembles of starts, the Lyapunov exponents and the comparisons of meshes and methods, and writes
    /// their record, ENSEMBLES.md and its pictures.
    Ensembles {
        /// Makes no run, and writes ENSEMBLES.md and its pictures from the record that is there.
        #[arg(long)]
        page: bool,
    },
    /// Scans one parameter at a time around the printed and assumed values, and writes SCANS.md and its pictures.
    Scans,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    match arguments.command {
        Some(Command::Ensembles { page: true }) => {
            show(&record::load(ENSEMBLES)?)?;
            records::write_notes(&records::root())
        }
        Some(Command::Ensembles { page: false }) => gather(),
        Some(Command::Scans) => scan(),
        None => reproduce(arguments.settings),
    }
}

/// Name of the record of the ensembles.
const ENSEMBLES: &str = "ensembles.json";
/// Name of the record of times.
const TIMINGS: &str = "timings.json";

fn reproduce(settings: Settings) -> Result<()> {
    let running = RunningCampaign::begin("reproduction")?;
    // before the runs, so that a missing record is reported at once
    let (record, timings) = (record::load(ENSEMBLES)?, record::load(TIMINGS)?);
    let mut numbers = Numbers::default();
    let campaign = Campaign::run(settings)?;
    let figures = figures::all(&campaign, &mut numbers);
    let evidence = Evidence::of(&campaign, &record, &timings);
    let page = reproduction::page(&evidence, &mut numbers);
    write(&figures, "REPRODUCTION.md", &page)?;
    numbers.save(&record::file("numbers.json"))?;
    running.finish()
}

fn gather() -> Result<()> {
    let running = RunningCampaign::begin("ensembles")?;
    let timings = timings::run()?;
    let record = ensembles::run()?;
    record::save(&record, ENSEMBLES)?;
    record::save(&timings, TIMINGS)?;
    show(&record)?;
    running.finish()
}

fn show(record: &EnsembleRecord) -> Result<()> {
    let figures = ensembles_page::figures(record);
    write(&figures, "ENSEMBLES.md", &ensembles_page::page(record))
}

fn scan() -> Result<()> {
    let running = RunningCampaign::begin("scans")?;
    let record = record::load(ENSEMBLES)?;
    let mut numbers = Numbers::default();
    let scans = scans::run()?;
    let names: Vec<String> = scans.iter().map(|s| format!("scans-{}", s.slug)).collect();
    let figures: Vec<(&str, Figure)> = names
        .iter()
        .map(String::as_str)
        .zip(scans.iter().map(scans_page::figure))
        .collect();
    let page = scans_page::page(&scans, &record, &mut numbers);
    write(&figures, "SCANS.md", &page)?;
    numbers.save(&record::file("scans.json"))?;
    running.finish()
}

/// Writes figures and a page.
fn write(figures: &[(&str, Figure)], name: &str, page: &str) -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    figures::save_all(figures, &root.join("figures"))?;
    let path = root.join(name);
    fs::write(&path, page)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}
