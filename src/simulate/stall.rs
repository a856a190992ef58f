//! A run whose steps are so much shorter than what was asked for that it will not end.

/// With equal steps: this many steps tried at least, and on average shorter than this part of the step asked for.
const OF_EQUAL_STEPS: (u64, f64) = (20_000, 0.02);
/// With an accuracy: some ten seconds of computing, and an average step at which the whole run takes weeks.
const OF_ACCURACY: (u64, f64) = (1_000_000, 1e-11);

/// Watches the pace of a run.
#[derive(Debug)]
pub(super) struct Stall {
    steps: u64,
    /// Accepted and failed.
    tried: u64,
    patience: u64,
    /// Least average step \[s\].
    least: f64,
    /// Changes of every contact so far.
    changes: Vec<u64>,
}

/// What a stalled run did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stalled {
    /// Steps so far.
    pub steps: u64,
    /// The contact that changed most often, and how often.
    pub contact: Option<(usize, u64)>,
}

impl Stall {
    /// For a run of a duration, in steps of `step` if they are equal \[s\].
    pub fn new(contacts: usize, duration: f64, step: Option<f64>) -> Stall {
        let ((patience, part), whole) = match step {
            Some(step) => (OF_EQUAL_STEPS, step),
            None => (OF_ACCURACY, duration),
        };
        Stall {
            steps: 0,
            tried: 0,
            patience,
            least: part * whole,
            changes: vec![0; contacts],
        }
    }

    /// A step has failed.
    pub fn failure(&mut self) {
        self.tried += 1;
    }

    /// A step to t has been accepted that led from memory `before` to `after`.
    pub fn step(&mut self, t: f64, before: &[f64], after: &[f64]) -> Result<(), Stalled> {
        for (changes, (before, after)) in self.changes.iter_mut().zip(before.iter().zip(after)) {
            *changes += u64::from((*before > 0.0) != (*after > 0.0));
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
            // changes explain a halt where there are some every few steps
            contact: busiest.filter(|(_, changes)| 10 * changes > self.steps),
        })
    }
}
