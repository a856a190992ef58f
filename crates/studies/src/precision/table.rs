//! A study as a table in Markdown: what was found, and what it took.

use super::errors::NORMS;
use super::{Compared, Errors, Found, RunTiming, StudyOutcome, StudyPace};
use numbers::{digits, si};
use texts::markdown::cell;

impl<C: Compared> Found<C> {
    /// A table with these columns behind those of curve and pace: `cells` of every run that reached its end, then the lines of
    /// the reference.
    pub(super) fn tabulate(
        &self,
        heads: &[&str],
        cells: impl Fn(StudyPace, &C::Measured, &RunTiming) -> Vec<String>,
        reference: impl IntoIterator<Item = Vec<String>>,
    ) -> String {
        let heads = [&["method", "step or accuracy"], heads].concat();
        let row = |cells: Vec<String>| {
            let missing = heads.len() - cells.len();
            let cells: Vec<String> = cells.iter().map(|text| cell(text)).collect();
            format!("| {} |{}\n", cells.join(" | "), " |".repeat(missing))
        };
        let runs = self.runs.iter().zip(&self.timings).map(|(run, timing)| {
            let found = match (&run.result, timing) {
                (Ok(measured), Some(timing)) => cells(run.pace, measured, timing),
                (Ok(_), None) => unreachable!("a run that reached its end was timed"),
                (Err(error), _) => vec![format!("failed: {error}")],
            };
            [vec![run.curve.clone(), run.pace.to_string()], found].concat()
        });
        let rows = runs.chain(reference).map(row);
        let rule = format!("|{}\n", "---|".repeat(heads.len()));
        format!(
            "| {} |\n{rule}{}",
            heads.join(" | "),
            rows.collect::<String>()
        )
    }
}

/// Errors, times and work of all runs.
pub(super) fn table(outcome: &StudyOutcome) -> String {
    let counted = |timing: &RunTiming| timing.instructions.is_some();
    let counted = outcome.timings.iter().flatten().any(counted);
    let mut heads = vec![
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
    let norms = |errors: &Errors| NORMS.map(|(_, unit, of)| si(of(errors), unit));
    let [position, acceleration, impulse, _] = norms(&outcome.reference.floor);
    let floor = ["floor", "reference, difference of its two steps"].map(str::to_owned);
    let floor = [
        &floor[..],
        &[position, String::new(), acceleration, impulse],
    ]
    .concat();
    outcome.tabulate(
        &heads,
        |pace, measured, timing| {
            let [position, acceleration, impulse, energy] = norms(&measured.errors);
            let asked = match pace {
                StudyPace::Step(_) | StudyPace::Tolerance(_) => String::new(),
                StudyPace::Accuracy { position, .. } => {
                    let motion = measured.errors.motion;
                    motion.map_or(String::new(), |error| digits(error / position))
                }
            };
            let work = measured.work;
            let mut cells = vec![
                position,
                asked,
                acceleration,
                impulse,
                energy,
                si(timing.median, "s"),
                si(timing.least, "s"),
                timing.seconds.len().to_string(),
                work.steps.to_string(),
                work.rejected_steps.to_string(),
                work.location_trials.to_string(),
                work.factorisations.to_string(),
            ];
            if counted {
                let count = timing.instructions.map(|n| digits(n as f64));
                cells.push(count.unwrap_or_else(|| "–".to_owned()));
            }
            cells
        },
        [floor],
    )
}
