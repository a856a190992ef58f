//! What a run leaves for its measures.

use looselink::simulate::{Impact, Recording};
use std::ops::Range;

/// Rows and contacts of a run.
#[derive(Debug)]
pub struct Recorded<'a> {
    /// Time of every row \[s\].
    pub t: &'a [f64],
    /// Time that the run has reached \[s\].
    pub end: f64,
    /// Contacts in the order of their onsets.
    pub contacts: &'a [Impact],
    recording: &'a Recording,
}

impl Recorded<'_> {
    /// What a recording holds of a run that has reached some time \[s\].
    pub fn new(recording: &Recording, end: f64) -> Recorded<'_> {
        Recorded {
            end,
            t: recording.get("t").unwrap_or(&[]),
            contacts: &recording.onsets,
            recording,
        }
    }

    /// Some rows of a channel, or of the magnitude of several; none where a channel is not recorded.
    pub fn magnitude(&self, channels: &[String], rows: Range<usize>) -> Option<Vec<f64>> {
        let columns = channels.iter().map(|name| self.recording.get(name));
        let columns: Vec<&[f64]> = columns.collect::<Option<_>>()?;
        if let [column] = columns[..] {
            return Some(column[rows].to_vec());
        }
        let squares = |row: usize| columns.iter().map(|c| c[row] * c[row]).sum::<f64>();
        Some(rows.map(|row| squares(row).sqrt()).collect())
    }
}
