//! Says on the pages which records are of an earlier state of the sources, or checks that they say so.

use clap::Parser;
use miette::{IntoDiagnostic, Result, miette};
use records::{check, digests, root, write_notes};

/// Brings the notes on the state of the records up to date, in all pages; repeats no campaign.
#[derive(Parser)]
struct Arguments {
    /// Compares the notes with the sources instead of writing them.
    #[arg(long)]
    check: bool,
    /// Prints the digests of what a record depends on, for a campaign that is no Rust program.
    #[arg(long, value_name = "RECORD", conflicts_with = "check")]
    digests: Option<String>,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    if let Some(name) = arguments.digests {
        let digests = digests(&root(), &name)?;
        println!(
            "{}",
            serde_json::to_string_pretty(&digests).into_diagnostic()?
        );
        return Ok(());
    }
    if !arguments.check {
        write_notes(&root())?;
    }
    let findings = check(&root())?;
    for line in &findings.outdated {
        println!("{line}");
    }
    if findings.failures.is_empty() {
        println!("every page says of which state its records are");
        return Ok(());
    }
    Err(miette!(
        help = "cargo run -p records",
        "pages do not say of which state their records are\n{}",
        findings.failures.join("\n")
    ))
}
