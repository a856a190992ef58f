//! Random mechanisms: valid scenes that nobody drew, and what must hold of every run.
//!
//! [`genes`] is a strategy of proptest, [`draw`] makes the text of a scene of them, [`judge`] runs it and looks at every
//! property; [`soak`] does so many times and keeps a tally.

mod constraints;
mod genes;
mod layout;
mod ledger;
mod newton_law;
mod run;
mod scene;
pub mod soak;

pub use genes::genes;
pub use run::{Breach, RunOutcome};
pub use scene::draw;

use run::{breach, run};

/// Runs a scene and looks at every property; returns how it ended.
///
/// # Errors
/// The first property that does not hold.
pub fn judge(text: &str) -> Result<RunOutcome, Breach> {
    let first = run(text, &[])?;
    // the same scene, run in another thread, gives the same bytes; as text, which tells -0 from 0
    let again = std::thread::scope(|s| s.spawn(|| run(text, &[])).join());
    let again = again.expect("panics are caught")?;
    if format!("{first:?}") != format!("{again:?}") {
        return breach("a run repeats its bytes", "rows or report differ");
    }
    let run = match first {
        Ok(run) => run,
        Err(refusal) => return Ok(RunOutcome::Refused(refusal)),
    };
    constraints::kept(&run)?;
    newton_law::forces(&run)?;
    newton_law::momentum(&run)?;
    ledger::closes(text, &run)?;
    Ok(run.outcome)
}
