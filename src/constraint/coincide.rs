//! Ideal revolute joint between two markers (eq. 16, second and third row).

use super::{Constraint, Curvature, Gradient, ROWS, WIDTH};
use crate::marker::Marker;
use crate::math::plane::{Vec2, dot, sub};
use crate::system::State;

/// Phi = r_bearing - r_journal, two rows; the multiplier is the force of the bearing on the journal \[N\].
#[derive(Debug, Clone, Copy)]
pub struct Coincide {
    /// Point of the bearing side.
    pub bearing: Marker,
    /// Point of the journal side.
    pub journal: Marker,
}

impl Constraint for Coincide {
    fn rows(&self) -> usize {
        2
    }

    fn coordinates(&self) -> Vec<usize> {
        [self.bearing.coordinates(), self.journal.coordinates()].concat()
    }

    fn split(&self) -> usize {
        self.bearing.width()
    }

    #[inline]
    fn value(&self, at: &State) -> [f64; ROWS] {
        let point = |m: &Marker| m.position(&at.q, m.arm(&at.q));
        sub(point(&self.bearing), point(&self.journal))
    }

    #[inline]
    fn gradient(&self, at: &State) -> Gradient {
        let mut rows = [[0.0; WIDTH]; ROWS];
        let mut first = 0;
        for (marker, sign) in [(&self.bearing, 1.0), (&self.journal, -1.0)] {
            let columns = marker.columns(&at.q);
            for (c, column) in columns.iter().enumerate() {
                rows[0][first + c] = sign * column[0];
                rows[1][first + c] = sign * column[1];
            }
            first += columns.len();
        }
        rows
    }

    #[inline]
    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let sides = [
            (&self.bearing, 1.0, 0),
            (&self.journal, -1.0, self.bearing.width()),
        ];
        for (marker, sign, first) in sides {
            if let Marker::OnBody { .. } = marker {
                let bend = -sign * dot(marker.arm(&at.q), lambda);
                out.add(first + 2, first + 2, bend);
            }
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        sub(rate(&self.bearing), rate(&self.journal))
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let second = |m: &Marker| m.acceleration(&at.v, &at.a, m.arm(&at.q));
        sub(second(&self.bearing), second(&self.journal))
    }

    fn force(&self, _: &State, lambda: [f64; ROWS]) -> Vec2 {
        lambda
    }
}
