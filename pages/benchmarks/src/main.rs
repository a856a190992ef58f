//! What a step costs, how costs grow with size, and what other codes need; writes BENCHMARKS.md.

mod baseline;
mod count;
mod family;
mod figures;
mod gate;
mod growth;
mod list;
mod meshes;
mod page;
mod rivals;
mod standings;
mod steps;

use clap::{Parser, Subcommand, ValueEnum};
use family::Family;
use growth::SizeCost;
use meshes::MeshCost;
use miette::{IntoDiagnostic, Result, WrapErr};
use records::RunningCampaign;
use rivals::Rivals;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use steps::StepCost;
use studies::machine::machine;

/// Counts instructions, measures growth with size and rivals, and writes BENCHMARKS.md.
#[derive(Parser)]
struct Arguments {
    /// Timed runs of every step.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// Measures this part alone.
    #[arg(long)]
    only: Option<PagePart>,
    #[command(subcommand)]
    command: Option<Benchmark>,
}

/// Parts of the page.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PagePart {
    Steps,
    Growth,
    Rivals,
}

#[derive(Subcommand)]
enum Benchmark {
    /// Counts the instructions of the steps and compares them with those recorded.
    Count {
        /// Fails where a count differs by more than 2 %, instead of recording the counts.
        #[arg(long)]
        check: bool,
    },
    /// Measures one mechanism in this process and prints its costs.
    Size {
        /// Its kind.
        family: Family,
        /// Number of bodies.
        bodies: usize,
        /// Timed runs.
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
        repeats: u16,
    },
    /// Writes the page from what is recorded.
    Page,
}

/// What is recorded.
#[derive(Default, Serialize, Deserialize)]
pub struct Measured {
    /// Where and with what.
    pub machine: String,
    /// Commit of the earlier state.
    pub baseline: String,
    /// Counts and times of steps.
    pub steps: Vec<StepCost>,
    /// Costs of mechanisms of many sizes.
    pub sizes: Vec<SizeCost>,
    /// Times at one error, by number of elements.
    pub meshes: Vec<MeshCost>,
    /// Ours and other codes.
    #[serde(flatten)]
    pub rivals: Rivals,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let root = records::root();
    match arguments.command {
        None => measure(&root, arguments.repeats.into(), arguments.only),
        Some(Benchmark::Count { check: true }) => gate::check(&root),
        Some(Benchmark::Count { check: false }) => gate::record(&root),
        Some(Benchmark::Size {
            family,
            bodies,
            repeats,
        }) => {
            let cost = growth::measure(family, bodies, repeats)?;
            println!("{}", serde_json::to_string(&cost).into_diagnostic()?);
            Ok(())
        }
        Some(Benchmark::Page) => {
            write(&root, &read(&root)?)?;
            records::write_notes(&root)
        }
    }
}

/// Measures everything or one part; the other parts stay as they are recorded.
fn measure(root: &Path, repeats: usize, only: Option<PagePart>) -> Result<()> {
    let campaign = match only {
        None => Some(RunningCampaign::begin("benchmarks")?),
        Some(_) => None,
    };
    let mut measured = match only {
        None => Measured::default(),
        Some(_) => read(root)?,
    };
    let wanted = |part: PagePart| only.is_none_or(|only| only == part);
    let program = program(root)?;
    measured.machine = machine().to_string();
    if wanted(PagePart::Steps) {
        let counts = gate::count(root, &program)?;
        measured.baseline = list::StepList::read(root)?.baseline;
        measured.steps = steps::measure(root, &program, &counts, repeats)?;
    }
    if wanted(PagePart::Growth) {
        measured.sizes = growth::all()?;
        measured.meshes = meshes::measure(root, repeats)?;
    }
    if wanted(PagePart::Rivals) {
        measured.rivals = rivals::measure(root, &program, repeats)?;
    }
    let text = serde_json::to_string_pretty(&measured).into_diagnostic()?;
    std::fs::write(record(root), text + "\n").into_diagnostic()?;
    write(root, &measured)?;
    match campaign {
        Some(campaign) => campaign.finish(),
        None => records::write_notes(root),
    }
}

/// The present program.
fn program(root: &Path) -> Result<PathBuf> {
    baseline::build(root, &root.join("target"))
}

fn record(root: &Path) -> PathBuf {
    root.join("pages/benchmarks/benchmarks.json")
}

fn read(root: &Path) -> Result<Measured> {
    let text = std::fs::read_to_string(record(root))
        .into_diagnostic()
        .wrap_err("`cargo run --release -p benchmarks` writes the record")?;
    serde_json::from_str(&text).into_diagnostic()
}

/// Writes the page and its figures.
fn write(root: &Path, measured: &Measured) -> Result<()> {
    let folder = root.join("pages/benchmarks/figures");
    plot::save(&figures::steps(measured), &folder, "steps")?;
    plot::save(&figures::growth(measured), &folder, "growth")?;
    plot::save(&figures::rivals(measured), &folder, "rivals")?;
    std::fs::write(root.join("BENCHMARKS.md"), page::page(root, measured)?)
        .into_diagnostic()
        .wrap_err("cannot write BENCHMARKS.md")
}
