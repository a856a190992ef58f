//! Results in memory, for programs that evaluate a run after its end.

use super::{ContactEvent, Control, Impact, Observer, Onset, Progress, Simulation};
use std::io::Result;

/// Keeps the results of a run, column by column.
#[derive(Debug, Clone)]
pub struct Recording {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// Contacts in the order of their onsets.
    pub onsets: Vec<Impact>,
    /// The run is stopped after this many onsets.
    pub most_onsets: usize,
    /// The run is stopped after this many steps.
    pub most_steps: u64,
    steps: u64,
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
            most_steps: u64::MAX,
            steps: 0,
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
        self.onsets.push(Impact::from(onset));
        Ok(())
    }

    fn contact(&mut self, contact: &ContactEvent) -> Result<()> {
        let mut latest = self.onsets.iter_mut().rev();
        if let Some(kept) = latest.find(|onset| onset.joint == contact.onset.joint) {
            *kept = Impact::from(contact);
        }
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> Result<Control> {
        self.steps += 1;
        let enough = self.onsets.len() >= self.most_onsets || self.steps >= self.most_steps;
        Ok(if enough {
            Control::Stop
        } else {
            Control::Continue
        })
    }
}
