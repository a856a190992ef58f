//! What a campaign leaves: results with the version that they belong to, and a journal with which an interrupted one continues.
//!
//! A campaign measures something that no test repeats. Its results are a [`Record`] in `evidence/data`, from which pages and
//! pictures are made. While it runs, every finished item is a line of its [`Journal`].
#![forbid(unsafe_code)]

mod journal;
mod record;

pub use journal::{Journal, each};
pub use record::{Origin, Record};

use std::path::{Path, PathBuf};
use std::thread;

/// Threads of runs side by side: as many as there are cores.
pub fn threads() -> usize {
    thread::available_parallelism().map_or(1, Into::into)
}

/// The root of the workspace.
pub fn root() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    root.canonicalize().unwrap_or(root)
}
