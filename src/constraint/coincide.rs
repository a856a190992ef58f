//! Ideal revolute joint between two markers (eq. 16, second and third row).

use super::{Constraint, Curvature, Gradient, ROWS};
use crate::effect::Effect;
use crate::marker::Marker;
use crate::math::plane::Vec2;
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
    fn effect(&self) -> Effect {
        "ideal_joint_constraint"
    }

    fn rows(&self) -> usize {
        2
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.bearing.coordinates(), self.journal.coordinates()]
    }

    #[inline]
    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        let mut value = Vec2::zeros();
        let mut first = 0;
        for (marker, sign) in [(&self.bearing, 1.0), (&self.journal, -1.0)] {
            let arm = marker.arm(&at.q);
            let mut put = |column: usize, x: f64, y: f64| {
                gradient[0][first + column] = sign * x;
                gradient[1][first + column] = sign * y;
            };
            match *marker {
                Marker::Node { .. } => {
                    put(0, 1.0, 0.0);
                    put(1, 0.0, 1.0);
                }
                Marker::OnBody { .. } => {
                    put(0, 1.0, 0.0);
                    put(1, 0.0, 1.0);
                    put(2, -arm.y, arm.x);
                }
                Marker::OnChord { share, .. } => {
                    put(0, 1.0 - share, 0.0);
                    put(1, 0.0, 1.0 - share);
                    put(2, share, 0.0);
                    put(3, 0.0, share);
                }
            }
            value += sign * marker.position(&at.q, arm);
            first += marker.width();
        }
        value.into()
    }

    #[inline]
    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let sides = [
            (&self.bearing, 1.0, 0),
            (&self.journal, -1.0, self.bearing.width()),
        ];
        for (marker, sign, first) in sides {
            if let Marker::OnBody { .. } = marker {
                let bend = -sign * marker.arm(&at.q).dot(&Vec2::from(lambda));
                out.add(first + 2, first + 2, bend);
            }
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        (rate(&self.bearing) - rate(&self.journal)).into()
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let second = |m: &Marker| m.acceleration(&at.v, &at.a, m.arm(&at.q));
        (second(&self.bearing) - second(&self.journal)).into()
    }

    fn force(&self, _: &State, lambda: [f64; ROWS]) -> Vec2 {
        lambda.into()
    }
}
