//! How far a run is.

use looselink::simulate::Progress;
use std::time::{Duration, Instant};

/// When a run began or was resumed: on the clock, and in simulated time \[s\].
#[derive(Debug)]
pub struct Start(Instant, f64);

impl Start {
    /// Now, from a simulated time on.
    pub fn at(t: f64) -> Start {
        Start(Instant::now(), t)
    }

    /// One line about how far the run is.
    pub fn line(&self, progress: &Progress) -> String {
        let Progress {
            t,
            duration,
            contacts,
        } = progress;
        let Some(contacts) = contacts else {
            return format!("equilibrium at t = {t:.4} of {duration}");
        };
        let factor = (t - self.1) / self.0.elapsed().as_secs_f64();
        format!(
            "t = {t:.4} s of {duration} s, {factor:.3} x real time, closed contacts: {contacts}"
        )
    }
}

/// Looks at the clock every 256 steps or so, more often when steps are slow.
#[derive(Debug)]
pub struct Ticker {
    every: u32,
    count: u32,
    last: Instant,
}

const TICK: Duration = Duration::from_millis(100);

impl Default for Ticker {
    fn default() -> Ticker {
        Ticker::new()
    }
}

impl Ticker {
    /// Starts with a look at every step.
    pub fn new() -> Ticker {
        Ticker {
            every: 1,
            count: 0,
            last: Instant::now(),
        }
    }

    /// True about ten times a second.
    pub fn tick(&mut self) -> bool {
        self.count += 1;
        if self.count < self.every {
            return false;
        }
        self.count = 0;
        let due = self.last.elapsed() >= TICK;
        self.every = if due {
            (self.every / 2).max(1)
        } else {
            (self.every * 2).min(256)
        };
        if due {
            self.last = Instant::now();
        }
        due
    }
}
