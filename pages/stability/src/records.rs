//! What runs of minutes and hours have found, kept for the page.

use crate::cases::Check;
use crate::random::soak::SoakTally;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::io;
use std::path::{Path, PathBuf};

/// All records.
#[derive(Debug)]
pub struct Records {
    /// Checks of long runs, by the number of their case.
    pub long: Vec<(usize, Vec<Check>)>,
    /// Random mechanisms.
    pub soak: SoakTally,
    /// Random input.
    pub fuzz: Fuzz,
}

/// What the fuzzer found.
#[derive(Debug, Clone, Deserialize)]
pub struct Fuzz {
    /// Command that makes the record again.
    pub command: String,
    /// Fuzzer.
    pub engine: String,
    /// Limits of an input.
    pub limits: String,
    /// What was fuzzed.
    pub targets: Vec<Target>,
    /// What was found on the way.
    pub found_and_fixed: Vec<String>,
}

/// What one target of the fuzzer found.
#[derive(Debug, Clone, Deserialize)]
pub struct Target {
    /// Its name.
    pub target: String,
    /// Inputs run.
    pub inputs: u64,
    /// How long \[s\].
    pub seconds: u64,
    /// Edges of the program that were taken.
    pub edges_covered: u64,
    /// Failures that are left.
    pub open_failures: u64,
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("records")
}

fn read<T: DeserializeOwned>(file: &str) -> io::Result<T> {
    let text = std::fs::read_to_string(folder().join(file))?;
    Ok(serde_json::from_str(&text)?)
}

impl Records {
    /// Reads the folder of records.
    ///
    /// # Errors
    /// A record that is missing or cannot be read.
    pub fn read() -> io::Result<Records> {
        Ok(Records {
            long: read("long.json")?,
            soak: read("soak.json")?,
            fuzz: read("fuzz.json")?,
        })
    }
}

/// Keeps the checks of long runs.
///
/// # Errors
/// When they cannot be written.
pub fn write_long(found: &[(usize, Vec<Check>)]) -> io::Result<()> {
    std::fs::create_dir_all(folder())?;
    let text = serde_json::to_string_pretty(found)? + "\n";
    std::fs::write(folder().join("long.json"), text)
}
