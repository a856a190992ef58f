//! A study as a table in Markdown: what was found, and what it took.

use super::errors::NORMS;
use super::{Outcome, Pace};
use crate::machine::{Machine, Timing};
use crate::warning_list;

/// What the processor times of a table are.
pub(super) const TIMES: &str = "Processor time of the integration on one core, without reading and compiling \
    the scene: the median over the number of runs in column `runs`, after one that is not timed; `timing.json` has every single time.";

/// Errors, times and work of all runs.
pub fn table(outcome: &Outcome) -> String {
    let counted = |timing: &Timing| timing.instructions.is_some();
    let counted = outcome.timings.iter().flatten().any(counted);
    let mut heads = vec![
        "method",
        "step or accuracy",
        "position",
        "achieved / requested",
        "acceleration",
        "impulse",
        "energy",
        "processor time",
        "least",
        "runs",
        "steps",
        "rejected steps",
        "location trials",
        "factorisations",
    ];
    if counted {
        heads.push("instructions");
    }
    let row = |cells: Vec<String>| {
        let missing = heads.len().saturating_sub(cells.len());
        format!("| {} |{}\n", cells.join(" | "), " |".repeat(missing))
    };
    let heading = heads.iter().map(|head| (*head).to_owned()).collect();
    let mut out = row(heading) + "|" + &"---|".repeat(heads.len()) + "\n";
    let norms = |errors: &super::Errors| NORMS.map(|(_, unit, of)| numbers::si(of(errors), unit));
    for (run, timing) in outcome.runs.iter().zip(&outcome.timings) {
        let mut cells = vec![run.curve.clone(), run.pace.to_string()];
        match &run.result {
            Ok(measured) => {
                let [position, others @ ..] = norms(&measured.errors);
                let asked = match run.pace {
                    Pace::Step(_) | Pace::Tolerance(_) => String::new(),
                    Pace::Accuracy { position, .. } => {
                        numbers::digits(measured.errors.position / position)
                    }
                };
                cells.extend([position, asked]);
                cells.extend(others);
                let of =
                    |number: fn(&Timing) -> String| timing.as_ref().map_or(String::new(), number);
                cells.extend([
                    of(|t| numbers::si(t.median, "s")),
                    of(|t| numbers::si(t.least, "s")),
                    of(|t| t.seconds.len().to_string()),
                ]);
                let w = measured.work;
                let work = [
                    w.steps,
                    w.rejected_steps,
                    w.location_trials,
                    w.factorisations,
                ];
                cells.extend(work.map(|n| n.to_string()));
                if counted {
                    cells.push(of(|t| match t.instructions {
                        Some(n) => numbers::digits(n as f64),
                        None => "–".to_owned(),
                    }));
                }
            }
            Err(error) => cells.push(format!("failed: {error}")),
        }
        out += &row(cells);
    }
    let [position, acceleration, impulse, _] = norms(&outcome.floor);
    let floor = [
        "floor",
        "reference, difference of its two steps",
        &position,
        "",
        &acceleration,
        &impulse,
    ];
    out + &row(floor.map(str::to_owned).to_vec())
}

/// A page with the diagrams and the table, and where it was measured.
pub fn page(outcome: &Outcome, machine: &Machine) -> String {
    format!(
        "# {}\n\n![Work and precision](precision.png)\n\n{}\n{TIMES} {machine}.\n{}",
        outcome.title,
        table(outcome),
        warning_list(&outcome.warnings())
    )
}
