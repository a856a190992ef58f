//! The result of a run of a sweep: one JSON line, from which the tables are made.

use super::{Envelope, FieldValue};
use serde::{Deserialize, Serialize};

/// A run of a sweep that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Its number.
    pub run: usize,
    /// The first digits of the SHA-256 of the program that made it.
    pub program: String,
    /// Number of its start; 0 is that of the scene.
    pub start: usize,
    /// Values of the parameters.
    pub values: Vec<FieldValue>,
    /// How it ended.
    pub status: RunStatus,
    /// Why it did not come to its end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Its warnings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// Time reached \[s\].
    pub t: f64,
    /// Steps taken.
    pub steps: u64,
    /// Contacts closed.
    pub onsets: u64,
    /// The energy ledger, in the order of [`super::columns::ENERGIES`]; absent without one, none where a
    /// failed run has no finite number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energies: Option<[Option<f64>; 6]>,
    /// The measures of a run that came to its end; none where one has no value.
    pub measures: Vec<Option<f64>>,
    /// The envelopes of such a run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub envelopes: Vec<Envelope>,
}

/// How a run of a sweep ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RunStatus {
    /// To the end of the scene.
    Complete,
    /// It could not go on.
    Failed,
    /// The scene with these values has a fault, or its mechanism cannot start.
    Refused,
}

impl RunStatus {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            RunStatus::Complete => "complete",
            RunStatus::Failed => "failed",
            RunStatus::Refused => "refused",
        }
    }
}

/// What a run took, which differs when it is repeated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RowTiming {
    /// The run.
    pub run: usize,
    /// Processor time \[s\].
    pub cpu: f64,
    /// Time on the clock \[s\].
    pub wall: f64,
}
