//! A study as tables in Markdown: what was found, and what it took.

use super::errors::NORMS;
use super::{Outcome, Pace};
use crate::machine::Machine;
use crate::simulate::warning_list;
use std::fmt::Write;

const WRITES: &str = "a string takes any text";

/// Errors and work of all runs.
pub fn table(outcome: &Outcome) -> String {
    let mut out = String::from(
        "| method | step or accuracy | position | achieved / asked | acceleration | impulse | energy | steps | repeated | location trials | factorisations |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let cells = |errors: &super::Errors| NORMS.map(|(_, unit, of)| plot::si(of(errors), unit));
    for run in &outcome.runs {
        write!(out, "| {} | {} |", run.curve, run.pace).expect(WRITES);
        match &run.result {
            Ok(measured) => {
                let [position, acceleration, impulse, energy] = cells(&measured.errors);
                let asked = match run.pace {
                    Pace::Step(_) | Pace::Tolerance(_) => String::new(),
                    Pace::Accuracy { position, .. } => {
                        plot::digits(measured.errors.position / position)
                    }
                };
                let w = measured.work;
                writeln!(
                    out,
                    " {position} | {asked} | {acceleration} | {impulse} | {energy} | {} | {} | {} | {} |",
                    w.steps, w.rejected_steps, w.location_trials, w.factorisations
                )
            }
            Err(error) => writeln!(out, " failed: {error} | | | | | | | | |"),
        }
        .expect(WRITES);
    }
    let [position, acceleration, impulse, _] = cells(&outcome.floor);
    writeln!(
        out,
        "| floor | reference, coarse against fine | {position} | | {acceleration} | {impulse} | | | | | |"
    )
    .expect(WRITES);
    out
}

/// A page with the diagrams and both tables.
pub fn page(outcome: &Outcome, machine: &Machine) -> String {
    format!(
        "# {}\n\n![Work and precision](precision.png)\n\n{}\n{}{}",
        outcome.title,
        table(outcome),
        timing_table(outcome, machine),
        warning_list(&outcome.warnings())
    )
}

/// Processor times of all runs, and where they were measured.
fn timing_table(outcome: &Outcome, machine: &Machine) -> String {
    let mut out = String::from(
        "| method | step or accuracy | position error | median | least | runs | instructions |\n|---|---|---|---|---|---|---|\n",
    );
    for (run, timing) in outcome.runs.iter().zip(&outcome.timings) {
        let (Some(timing), Ok(measured)) = (timing, &run.result) else {
            continue;
        };
        writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} |",
            run.curve,
            run.pace,
            plot::si(measured.errors.position, "m"),
            plot::si(timing.median, "s"),
            plot::si(timing.least, "s"),
            timing.repeats,
            timing
                .instructions
                .map_or("–".to_owned(), |n| plot::digits(n as f64))
        )
        .expect(WRITES);
    }
    writeln!(
        out,
        "\nProcessor time of the integration on one core, reading and compiling of the scene left out. {machine}."
    )
    .expect(WRITES);
    out
}
