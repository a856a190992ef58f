//! Records campaigns, and renders the pages and pictures of their results.

use clap::{Parser, Subcommand};
use evidence::benchmarks::{Family, gate, growth};
use evidence::campaign::{self, Campaign, RENDERERS, find};
use evidence::output::{Data, Output};
use evidence::worktree;
use miette::{Result, ensure, miette};
use records::root;
use std::path::PathBuf;

/// Measures what the pages claim, and makes the pages.
#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Runs campaigns in a worktree of a commit and writes evidence/data.
    Record {
        /// One campaign, instead of all.
        campaign: Option<String>,
        /// The commit, instead of the one that is checked out.
        #[arg(long, value_name = "COMMIT")]
        at: Option<String>,
        /// Continues campaigns that were interrupted, at the commit at which they began.
        #[arg(long)]
        resume: bool,
    },
    /// Makes every tracked page and picture from evidence/data, and the pages of the site with the long tables. Once all campaigns are
    /// recorded, pictures that nothing gives any more are deleted.
    Render {
        /// Writes nothing; exit code 1 where a tracked file is not what its data give.
        #[arg(long)]
        check: bool,
    },
    /// Counts the instructions of the steps in evidence/steps.toml and writes evidence/counts.json.
    Count {
        /// Fails where a count differs by more than 2 % from that recorded, instead of recording it.
        #[arg(long)]
        check: bool,
    },
    /// What the campaign `benchmarks` calls: measures one mechanism in a process of its own and prints its costs.
    #[command(hide = true)]
    Size {
        family: Family,
        bodies: usize,
        repeats: u16,
    },
    /// What `record` calls in its worktree.
    #[command(hide = true)]
    Measure {
        campaign: String,
        commit: String,
        journal: PathBuf,
        record: PathBuf,
        #[arg(long)]
        resume: bool,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().command {
        Command::Record {
            campaign,
            at,
            resume,
        } => {
            let chosen: Vec<&Campaign> = match campaign {
                Some(name) => vec![find(&name)?],
                None => campaign::all().collect(),
            };
            worktree::record(&chosen, at.as_deref(), resume)
        }
        Command::Render { check } => render(check),
        Command::Count { check: true } => gate::check(&root()),
        Command::Count { check: false } => gate::record(&root()),
        Command::Size {
            family,
            bodies,
            repeats,
        } => growth::print(family, bodies, repeats),
        Command::Measure {
            campaign,
            commit,
            journal,
            record,
            resume,
        } => worktree::measure(find(&campaign)?, &commit, &journal, &record, resume),
    }
}

fn render(check: bool) -> Result<()> {
    let root = root();
    let (data, mut output) = (Data::of(&root), Output::new(&root));
    let mut complete = true;
    for renderer in RENDERERS {
        match renderer.records.iter().find(|name| !data.has(name)) {
            Some(missing) => {
                ensure!(!check, "the record of {missing} is missing");
                eprintln!("not rendered, since {missing} is not recorded");
                complete = false;
            }
            None => (renderer.render)(&data, &mut output)?,
        }
    }
    if complete {
        let records = RENDERERS.iter().flat_map(|renderer| renderer.records);
        let recorded = data.recorded(records.copied())?;
        output.page_of_pages("EVIDENCE.md", "evidence.md", &recorded)?;
        output.find_stale(&root)?;
    }
    output.write_site(&root.join("target/tables"))?;
    if !check {
        let changed = output.write(&root)?;
        println!("{} files, {} changed", output.tracked.len(), changed.len());
        return Ok(());
    }
    let differing = output.differing(&root);
    match differing.is_empty() {
        true => Ok(()),
        false => Err(miette!(
            help = "`cargo run --release -p evidence -- render` writes them",
            "these files are not what evidence/data and evidence/templates give:\n{}",
            differing.join("\n")
        )),
    }
}
