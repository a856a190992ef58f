//! Random mechanisms: valid scenes that nobody drew, and what must hold of every run.
//!
//! [`genes`] is a strategy of proptest, [`draw`] makes the text of a scene of them, [`judge`] runs it and looks at every
//! property; [`soak`] does so many times and keeps a tally.

mod actions;
mod constraints;
mod genes;
mod ledger;
mod mechanism;
mod newton_law;
mod outcome;
pub mod soak;
mod text;

pub use genes::{Genes, genes};
pub use outcome::{Breach, ChannelRows, RandomRun, RunOutcome, run};
pub use text::{RandomScene, draw};

use std::time::Duration;

/// Runs a scene and looks at every property; returns how it ended.
///
/// # Errors
/// The first property that does not hold.
pub fn judge(text: &str, guard: Option<Duration>) -> Result<RunOutcome, Breach> {
    let first = run(text, &[], guard)?;
    constraints::kept(&first)?;
    newton_law::forces(&first)?;
    newton_law::momentum(&first)?;
    ledger::identity(&first)?;
    repeatable(text, &first, guard)?;
    ledger::closes(text, &first, guard)?;
    Ok(first.outcome)
}

/// The same scene, run in another thread, gives the same bytes.
fn repeatable(text: &str, first: &RandomRun, guard: Option<Duration>) -> Result<(), Breach> {
    let again = std::thread::scope(|s| s.spawn(|| run(text, &[], guard)).join());
    let again = again.map_err(|_| Breach::new("no panic", "in a thread"))??;
    let same = again.rows.bits() == first.rows.bits()
        && again.outcome == first.outcome
        // what is not a number in the ledger of a run that has failed equals itself as text
        && format!("{:?}", again.report) == format!("{:?}", first.report);
    match same {
        true => Ok(()),
        false => Err(Breach::new(
            "a run repeats its bytes",
            "rows or report differ",
        )),
    }
}
