//! Ideal revolute joint between two markers (eq. 16, second and third row).

use crate::marker::Marker;
use crate::math::plane::{Vec2, perp, sub};
use crate::system::State;

/// Phi = r_bearing - r_journal, two rows; the multiplier is the force of the bearing on the journal \[N\].
#[derive(Debug, Clone, Copy)]
pub struct Coincide {
    /// Point of the bearing side.
    pub bearing: Marker,
    /// Point of the journal side.
    pub journal: Marker,
}

/// Phi_q of both markers: columns in the order bearing, journal.
#[derive(Debug, Clone, Copy)]
pub struct Gradient {
    /// Rows x and y.
    pub rows: [[f64; 6]; 2],
    /// Number of columns in use.
    pub columns: usize,
}

impl Coincide {
    /// The coordinates in local order.
    pub fn coordinates(&self) -> Vec<usize> {
        let of = |m: &Marker| m.x()..m.x() + m.width();
        of(&self.bearing).chain(of(&self.journal)).collect()
    }

    /// Phi \[m\].
    #[inline]
    pub fn value(&self, q: &[f64]) -> Vec2 {
        let point = |m: &Marker| m.position(q, m.arm(q));
        sub(point(&self.bearing), point(&self.journal))
    }

    /// Phi_q.
    #[inline]
    pub fn gradient(&self, q: &[f64]) -> Gradient {
        let mut rows = [[0.0; 6]; 2];
        let mut column = 0;
        for (marker, sign) in [(&self.bearing, 1.0), (&self.journal, -1.0)] {
            rows[0][column] = sign;
            rows[1][column + 1] = sign;
            if let Marker::OnBody { .. } = marker {
                let turn = perp(marker.arm(q));
                rows[0][column + 2] = sign * turn[0];
                rows[1][column + 2] = sign * turn[1];
            }
            column += marker.width();
        }
        Gradient {
            rows,
            columns: column,
        }
    }

    /// d(Phi_q^T lambda)/dq: (local index of theta, value) for the bearing and the journal.
    #[inline]
    pub fn curvature(&self, q: &[f64], lambda: Vec2) -> [Option<(usize, f64)>; 2] {
        let of = |marker: &Marker, sign: f64, first: usize| match marker {
            Marker::Node { .. } => None,
            Marker::OnBody { .. } => {
                let arm = marker.arm(q);
                Some((first + 2, -sign * (arm[0] * lambda[0] + arm[1] * lambda[1])))
            }
        };
        [
            of(&self.bearing, 1.0, 0),
            of(&self.journal, -1.0, self.bearing.width()),
        ]
    }

    /// Phi_q v.
    pub fn velocity(&self, at: &State) -> Vec2 {
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        sub(rate(&self.bearing), rate(&self.journal))
    }

    /// Phi_q a + d(Phi_q)/dt v.
    pub fn acceleration(&self, at: &State) -> Vec2 {
        let second = |m: &Marker| m.acceleration(&at.v, &at.a, m.arm(&at.q));
        sub(second(&self.bearing), second(&self.journal))
    }
}
