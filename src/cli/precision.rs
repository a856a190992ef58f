//! `looselink precision`

use super::failure::Failure;
use super::print;
use clap::Args;
use looselink::precision::{
    Effort, Machine, Outcome, Study, Timing, figure, machine, run, table, timing_table,
};
use serde::Serialize;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub struct Arguments {
    /// The study file.
    study: PathBuf,
    /// The folder that receives the results; it is created.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Timed runs of every point, after a first one that is not timed.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// Only the first point of every curve, timed once: to see that a study works.
    #[arg(long)]
    smoke: bool,
    /// Replace results that stand in the folder.
    #[arg(long)]
    force: bool,
    /// Show no progress.
    #[arg(long)]
    quiet: bool,
}

/// What `timing.json` holds.
#[derive(Serialize)]
struct Times<'a> {
    machine: &'a Machine,
    runs: Vec<Time<'a>>,
}

#[derive(Serialize)]
struct Time<'a> {
    curve: &'a str,
    pace: looselink::precision::Pace,
    seconds: Option<Timing>,
}

/// Makes all runs of a study and writes what they found and what they took.
pub fn precision(arguments: &Arguments) -> Result<(), Failure> {
    let study = Study::load(&arguments.study)?;
    let out = &arguments.out;
    let names = ["precision.json", "timing.json", "precision.md"];
    if let Some(there) = names.iter().find(|name| out.join(name).exists())
        && !arguments.force
    {
        return Err(Failure::bad_input(format!(
            "`{}` holds a result already (`{there}`); choose another folder, or replace it with --force",
            out.display()
        )));
    }
    let effort = Effort {
        repeats: if arguments.smoke {
            1
        } else {
            arguments.repeats.into()
        },
        smoke: arguments.smoke,
    };
    let outcome = run(&study, effort, &mut |name| {
        if !arguments.quiet {
            // a study does not fail because nobody listens
            let _ = writeln!(std::io::stderr(), "{name}");
        }
    })?;
    write(out, &study, &outcome)
}

fn write(out: &Path, study: &Study, outcome: &Outcome) -> Result<(), Failure> {
    let refused =
        |e: std::io::Error| Failure::system(format!("cannot write `{}`: {e}", out.display()));
    std::fs::create_dir_all(out).map_err(refused)?;
    let machine = machine();
    let runs = outcome.runs.iter().zip(&outcome.timings);
    let times = Times {
        machine: &machine,
        runs: runs
            .map(|(run, seconds)| Time {
                curve: &run.curve,
                pace: run.pace,
                seconds: *seconds,
            })
            .collect(),
    };
    let tables = format!(
        "# {}\n\n![Work and precision](precision.png)\n\n{}\n{}",
        outcome.title,
        table(outcome),
        timing_table(outcome, &machine)
    );
    for (name, text) in [
        ("precision.json", json(outcome)?),
        ("timing.json", json(&times)?),
        ("precision.md", tables.clone()),
    ] {
        std::fs::write(out.join(name), text).map_err(refused)?;
    }
    plot::save(&figure(study, outcome), out, "precision")
        .map_err(|e| Failure::system(format!("{e:?}")))?;
    print(&tables)
}

fn json(value: &impl Serialize) -> Result<String, Failure> {
    match serde_json::to_string_pretty(value) {
        Ok(text) => Ok(text + "\n"),
        Err(e) => Err(Failure::system(e.to_string())),
    }
}
