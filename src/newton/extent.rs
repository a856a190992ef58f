//! Displacements of a mechanism: what changes of its coordinates are measured by.

use super::Update;
use crate::system::State;

/// A step that stays nearby moves nothing farther than this part of the size of the mechanism: a sixtieth to a thirtieth of a turn of its
/// largest body.
pub(super) const NEARBY: f64 = 0.1;
/// An update below this part of the size, or of the largest coordinate, that no longer decreases is rounding.
const ROUNDING: f64 = 1e-12;

/// How far changes of coordinates move a mechanism.
#[derive(Debug, Clone, Copy)]
pub struct Extent<'a> {
    /// The largest distance \[m\] by which a unit of each unknown moves a point of its body.
    pub lengths: &'a [f64],
    /// The size of the mechanism \[m\].
    pub size: f64,
}

impl Extent<'_> {
    /// The largest displacement of some changes of the unknowns, as part of the size.
    pub(super) fn update(&self, changes: &[f64]) -> Update {
        let moved = changes.iter().zip(self.lengths);
        Update::largest(moved.map(|(x, length)| x * length / self.size))
    }

    /// The largest coordinate, known or not, as a displacement \[m\].
    pub(super) fn farthest_coordinate(&self, s: &State) -> f64 {
        let (unknown, known) = s.q.split_at(self.lengths.len());
        let unknown = unknown.iter().zip(self.lengths);
        let displacements = unknown.map(|(q, length)| q * length);
        let all = displacements.chain(known.iter().copied());
        all.fold(0.0, |m, q| m.max(q.abs()))
    }

    /// What is rounding of an update, as part of the size.
    pub(super) fn rounding(&self, s: &State) -> f64 {
        ROUNDING * (self.farthest_coordinate(s) / self.size).max(1.0)
    }

    /// The unknown that moves a point farthest in some changes of the unknowns, the first of them without any, and how far \[m\].
    pub fn farthest(&self, changes: impl Iterator<Item = f64>) -> (usize, f64) {
        let moved = changes
            .zip(self.lengths)
            .map(|(x, length)| (x * length).abs());
        let most = moved.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        most.unwrap_or((0, 0.0))
    }
}
