//! What users read while a scene is loaded and run, in the words that all programs share: faults of a scene, the end of a run that
//! could not go on, how far a run is, and what it came to.

mod closing;
mod failure;
mod progress;

pub use closing::closing_table;
pub use failure::{Colors, run_failure, scene_fault};
pub use progress::{Start, Ticker};
