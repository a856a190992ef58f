//! Results in memory, for programs that look at a run when it is over.

use super::{Control, Observer, Onset, Progress, Simulation};
use std::io::Result;

/// An onset that was told.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedOnset {
    /// When \[s\].
    pub t: f64,
    /// The joint.
    pub joint: String,
    /// delta_dot at onset \[m/s\].
    pub impact_velocity: f64,
    /// Penetration at the located instant \[m\].
    pub delta: f64,
}

/// Keeps what a run tells, column by column.
#[derive(Debug, Clone)]
pub struct Recording {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// Onsets in the order of time.
    pub onsets: Vec<RecordedOnset>,
    /// The run is stopped after this many onsets.
    pub most_onsets: usize,
}

impl Recording {
    /// An empty recording of the channels of a simulation.
    pub fn new(simulation: &Simulation) -> Recording {
        let names = simulation.channels().iter().map(|c| c.name.clone());
        let names: Vec<String> = names.collect();
        Recording {
            columns: vec![Vec::new(); names.len()],
            names,
            onsets: Vec::new(),
            most_onsets: usize::MAX,
        }
    }

    /// A channel over time.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        let column = self.names.iter().position(|n| n == name)?;
        Some(&self.columns[column])
    }

    /// Names of all channels.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns[0].len()
    }

    /// All channels with their names.
    pub fn into_columns(self) -> impl Iterator<Item = (String, Vec<f64>)> {
        self.names.into_iter().zip(self.columns)
    }
}

impl Observer for Recording {
    fn row(&mut self, values: &[f64]) -> Result<()> {
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(*value);
        }
        Ok(())
    }

    fn onset(&mut self, onset: &Onset) -> Result<()> {
        self.onsets.push(RecordedOnset {
            t: onset.t,
            joint: onset.joint.to_owned(),
            impact_velocity: onset.impact_velocity,
            delta: onset.delta,
        });
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> Result<Control> {
        Ok(if self.onsets.len() >= self.most_onsets {
            Control::Stop
        } else {
            Control::Continue
        })
    }
}
