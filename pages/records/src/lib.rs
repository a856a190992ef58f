//! Records that cannot be outdated in silence.
//!
//! Some claims rest on campaigns of minutes or hours that no test repeats. Each leaves a record, and with it a digest of
//! every source file that the record depends on (`pages/records/state/`), taken over tokens: comments and formatting outdate
//! nothing. `pages/records/registry.toml` says what depends on what. When a source changes, the page with the claim has to say
//! that its record is of an earlier state.
//!
//! Not counted: versions of libraries and of the compiler, and modules for tests (`#[cfg(test)]`).
#![forbid(unsafe_code)]

mod cpp;
mod digest;
mod notes;
mod registry;
mod rust;
mod state;

pub use digest::{Digests, Tree};
pub use notes::{Findings, check, place, write_notes};
pub use registry::{CampaignRecord, RecordRegistry};
pub use state::{RecordState, RunningCampaign, digests, root, state};
