//! What a run records: the channels, and where all bodies are.

use looselink::model::Model;
use looselink::simulate::{
    ContactEvent, Control, Observer, Onset, Progress, Recording, Simulation,
};
use looselink::system::State;
use std::io::Result;

/// The channels of a run, and its coordinates as an accuracy counts them.
#[derive(Debug)]
pub struct MotionRecording {
    /// The channels.
    pub channels: Recording,
    /// l_i q_i \[m\] of all unknowns, row after row: l_i is the largest distance by which a unit change of the unknown moves a
    /// point of its body.
    pub motion: Vec<f64>,
    lengths: Vec<f64>,
}

impl MotionRecording {
    /// An empty one.
    pub fn new(simulation: &Simulation) -> MotionRecording {
        MotionRecording {
            channels: Recording::new(simulation),
            motion: Vec::new(),
            lengths: simulation.model().lengths(),
        }
    }
}

impl Observer for MotionRecording {
    fn row(&mut self, values: &[f64]) -> Result<()> {
        self.channels.row(values)
    }

    fn state(&mut self, _: &Model, at: &State) -> Result<()> {
        let distances = self.lengths.iter().zip(&at.q).map(|(l, q)| l * q);
        self.motion.extend(distances);
        Ok(())
    }

    fn onset(&mut self, onset: &Onset) -> Result<()> {
        self.channels.onset(onset)
    }

    fn contact(&mut self, contact: &ContactEvent) -> Result<()> {
        self.channels.contact(contact)
    }

    fn step(&mut self, progress: &Progress) -> Result<Control> {
        self.channels.step(progress)
    }
}
