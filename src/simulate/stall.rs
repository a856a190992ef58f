//! Detects a run that will not end because its steps are far too short.

use crate::checkpoint::carried;
use crate::system::Changed;

/// Equal steps: the least number of steps tried, and the average step relative to that of the scene.
const OF_EQUAL_STEPS: (u64, f64) = (20_000, 0.02);
/// Steps of an accuracy: the same, the average relative to the duration. The number takes some ten seconds; at that average
/// the whole run would take weeks.
const OF_ACCURACY: (u64, f64) = (1_000_000, 1e-11);

/// Watches the pace of a run.
#[derive(Debug)]
pub(super) struct Stall {
    steps: u64,
    /// Steps accepted and failed.
    tried: u64,
    patience: u64,
    /// Least average step \[s\].
    least: f64,
    contacts: usize,
    /// Changes of every contact and force so far.
    changes: Vec<u64>,
}

carried!(Stall { steps, tried, changes } but { patience, least, contacts });

/// What a stalled run did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stalled {
    /// Steps so far.
    pub steps: u64,
    /// The contact or force that changed most often, by [`Changed::index`], and how often.
    pub busiest: Option<(usize, u64)>,
}

impl Stall {
    /// For a run of a duration, in steps of `step` if they are equal \[s\].
    pub fn new([contacts, forces]: [usize; 2], duration: f64, step: Option<f64>) -> Stall {
        let ((patience, part), whole) = match step {
            Some(step) => (OF_EQUAL_STEPS, step),
            None => (OF_ACCURACY, duration),
        };
        Stall {
            steps: 0,
            tried: 0,
            patience,
            least: part * whole,
            contacts,
            changes: vec![0; contacts + forces],
        }
    }

    /// A step has failed.
    pub fn failure(&mut self) {
        self.tried += 1;
    }

    /// Records an accepted step to t that ends with these changes.
    pub fn step(&mut self, t: f64, changed: &[Changed]) -> Result<(), Stalled> {
        for change in changed {
            self.changes[change.index(self.contacts)] += 1;
        }
        self.steps += 1;
        self.tried += 1;
        if self.tried < self.patience || t >= self.least * self.tried as f64 {
            return Ok(());
        }
        let busiest = self.changes.iter().copied().enumerate();
        let busiest = busiest.max_by_key(|(_, changes)| *changes);
        Err(Stalled {
            steps: self.steps,
            // changes of memory are the cause only if there is one every few steps
            busiest: busiest.filter(|(_, changes)| 10 * changes > self.steps),
        })
    }
}
