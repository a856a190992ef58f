//! What a step costs, how costs grow with the size of a mechanism, and what other codes need for the same error.

mod count;
mod family;
mod figures;
pub mod gate;
pub mod growth;
mod ida;
mod page;
mod rivals;
mod settings;
mod standings;
mod steps;

use crate::campaign::{Campaign, Renderer, results};
pub use family::Family;
use miette::{IntoDiagnostic, Result, ensure};
use records::{Journal, root};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The campaign.
pub const CAMPAIGN: Campaign = Campaign {
    name: "benchmarks",
    minutes: 60,
    seeds: "none",
    measure,
};

/// The page and its pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["benchmarks", "accuracy"],
    render: page::render,
};

/// What the campaign finds.
#[derive(Serialize, Deserialize)]
struct Measured {
    steps: Vec<steps::StepCost>,
    sizes: Vec<growth::SizeCost>,
    rivals: rivals::Rivals,
}

/// Timed runs of a step, and of a point of a curve.
const REPEATS: usize = 5;

fn measure(journal: &Journal) -> Result<Value> {
    let (root, program) = (root(), build(&root())?);
    let step = |row: &steps::StepRow| {
        journal.item(&format!("a step of {}", row.name), || {
            row.cost(&root, &program)
        })
    };
    let steps = steps::read(&root)?;
    results(Measured {
        steps: steps.iter().map(step).collect::<Result<_>>()?,
        sizes: growth::all(journal)?,
        rivals: rivals::measure(&root, &program, REPEATS, journal)?,
    })
}

/// The program `looselink` of the same build as this one.
///
/// # Errors
/// When it is not there.
fn program() -> Result<PathBuf> {
    let own = std::env::current_exe().into_diagnostic()?;
    let path = own.with_file_name("looselink");
    ensure!(
        path.exists(),
        help = "`cargo build --workspace` makes it",
        "there is no program looselink beside {}",
        own.display()
    );
    // the path that Valgrind names
    path.canonicalize().into_diagnostic()
}

/// The program `looselink` as users have it.
fn build(root: &Path) -> Result<PathBuf> {
    let mut cargo = Command::new("cargo");
    cargo.args([
        "build",
        "--quiet",
        "--release",
        "--locked",
        "-p",
        "looselink-cli",
    ]);
    let status = cargo.current_dir(root).status().into_diagnostic()?;
    ensure!(status.success(), "looselink cannot be built");
    program()
}
