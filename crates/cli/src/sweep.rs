//! `looselink sweep`

use super::failure::CommandFailure;
use super::interrupt::Interrupt;
use super::print;
use super::progress::RunsDisplay;
use super::terminal::say;
use clap::Args;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;
use studies::sweep::{Shard, Store, Sweep, SweepError, SweepRow, SweepTarget, execute, merge};

/// Runs without results that are reported as they come.
const REPORTED: usize = 20;

#[derive(Debug, Args)]
pub struct Arguments {
    /// The study file.
    study: PathBuf,
    /// The folder that receives the rows, tables and pictures; it is created. The same command goes on with rows that are there.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Threads; by default as many as there are cores.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Make the i-th of n parts of the runs alone, and no table: for several machines that write to the same folder, or to
    /// folders whose files are brought together. `--merge` makes the table.
    #[arg(long, value_name = "i/n", conflicts_with_all = ["merge", "target", "force"])]
    shard: Option<Shard>,
    /// Make no run; write tables and pictures of the rows that are there, which must be all of them.
    #[arg(long, conflicts_with_all = ["threads", "force"])]
    merge: bool,
    /// Find the value of the one parameter at which a measure reaches this value, by bisection; replaces the design of the study.
    #[arg(long, value_name = "MEASURE=VALUE", value_parser = target)]
    target: Option<SweepTarget>,
    /// Begin anew; the sweep that is there is kept in `previous-result` inside the folder until the new one is complete.
    #[arg(long)]
    force: bool,
    /// Show no progress; runs without results are still shown.
    #[arg(long)]
    quiet: bool,
}

/// A target with the usual tolerance.
fn target(text: &str) -> Result<SweepTarget, String> {
    let parts = text.split_once('=');
    let parts = parts.and_then(|(measure, value)| Some((measure, value.trim().parse().ok()?)));
    match parts {
        Some((measure, value)) => Ok(SweepTarget::new(measure.trim(), value)),
        None => Err("write measure=value, for example `error=5e-5`, in SI units".to_owned()),
    }
}

/// Makes the runs that are missing, then tables and pictures.
pub fn sweep(arguments: &Arguments) -> Result<(), CommandFailure> {
    let interrupt = Interrupt::watch()?;
    let sweep = Sweep::load(&arguments.study, arguments.target.clone())?;
    if arguments.merge {
        let store = Store::to_merge(&arguments.out, &sweep)?;
        return write(arguments, &sweep, &store);
    }
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    interrupt.begin();
    let mut store = Store::open(&arguments.out, &sweep, shard, arguments.force)?;
    make(arguments, &sweep, &mut store, shard, interrupt.flag())?;
    match arguments.shard {
        None => write(arguments, &sweep, &store),
        Some(shard) => {
            if !arguments.quiet {
                say(&format!(
                    "shard {shard} is complete, {} runs; when all shards are, run the command with `--merge` instead of `--shard`",
                    store.made(shard)
                ));
            }
            Ok(())
        }
    }
}

fn make(
    arguments: &Arguments,
    sweep: &Sweep,
    store: &mut Store,
    shard: Shard,
    stop: &AtomicBool,
) -> Result<(), CommandFailure> {
    let cores = || available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let threads = arguments.threads.unwrap_or_else(cores);
    let there = store.made(shard);
    if there > 0 && !arguments.quiet {
        say(&format!("{there} runs are there already"));
    }
    let mut display = RunsDisplay::new(arguments.quiet);
    let mut faults = 0;
    let ended = execute(sweep, store, shard, threads, stop, &mut |progress| {
        if let Some(fault) = progress.fault() {
            faults += 1;
            match faults {
                1..=REPORTED => display.say(&fault),
                n if n == REPORTED + 1 => {
                    display.say("further runs without results: see the table")
                }
                _ => {}
            }
        }
        match sweep.runs() {
            Some(_) => display.show(progress.done, progress.left),
            None if arguments.quiet => {}
            None => say(&visited(sweep, progress.row)),
        }
    });
    display.finish();
    Ok(ended?)
}

/// A run of a bisection, of which nobody knows how many runs it takes.
fn visited(sweep: &Sweep, row: &SweepRow) -> String {
    let short = |x: f64| numbers::number(x, 4);
    let values = row.values.iter().zip(sweep.study.parameters.keys());
    let values = values.map(|(value, name)| {
        let value = value.number().map_or(value.to_string(), short);
        format!("{name} = {value}")
    });
    let measures = row.measures.iter().zip(sweep.study.measures.keys());
    let measures = measures.filter_map(|(m, name)| Some(format!("{name} = {}", short((*m)?))));
    values.chain(measures).collect::<Vec<_>>().join(", ")
}

fn write(arguments: &Arguments, sweep: &Sweep, store: &Store) -> Result<(), CommandFailure> {
    let merged = merge(sweep, store, &arguments.out);
    if !arguments.quiet && matches!(merged, Ok(_) | Err(SweepError::NoAnswer(_))) {
        let folder = arguments.out.display();
        say(&format!("tables and pictures in `{folder}`"));
    }
    print(merged?.page)
}
