//! The course of a run, coarse enough to be kept for every run: least and largest value in equal parts of time.

use super::Recorded;
use serde::{Deserialize, Serialize};

/// `[envelopes.NAME]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnvelopePlan {
    /// Channels; of several the magnitude of their vector is kept.
    pub channels: Vec<String>,
    /// Parts of the time of a run.
    #[serde(default = "parts")]
    pub parts: usize,
}

fn parts() -> usize {
    200
}

/// Least and largest value in every part of a run; none in a part without a row.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Envelope {
    /// Least values.
    pub low: Vec<Option<f64>>,
    /// Largest values.
    pub high: Vec<Option<f64>>,
}

impl EnvelopePlan {
    /// Checks what can be seen without the scene.
    ///
    /// # Errors
    /// What is wrong, without the name of the envelope.
    pub(super) fn check(&self) -> Result<(), String> {
        if self.channels.is_empty() || self.channels.iter().any(|name| name.contains('*')) {
            return Err("needs names of single channels in `channels`".to_owned());
        }
        match self.parts {
            1..=2000 => Ok(()),
            other => Err(format!("needs 1 to 2000 `parts`, not {other}")),
        }
    }

    /// That of a run. Part k of n goes from k/n to (k + 1)/n of its time; a row at the end belongs to the last part.
    pub fn of(&self, recorded: &Recorded) -> Option<Envelope> {
        let all = 0..recorded.t.len();
        let series = recorded.magnitude(&self.channels, all)?;
        let end = recorded.t.last().filter(|end| **end > 0.0)?;
        let none = || vec![None; self.parts];
        let (mut low, mut high) = (none(), none());
        let reach = |place: &mut Option<f64>, x: f64, of: fn(f64, f64) -> f64| {
            *place = Some(place.map_or(x, |known| of(known, x)));
        };
        for (t, x) in recorded.t.iter().zip(series) {
            let part = (t / end * self.parts as f64) as usize;
            let part = part.min(self.parts - 1);
            reach(&mut low[part], x, f64::min);
            reach(&mut high[part], x, f64::max);
        }
        Some(Envelope { low, high })
    }
}
