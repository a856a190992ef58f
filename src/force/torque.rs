//! An applied torque on one body, or between two.

use super::{Force, LocalMatrix, WIDTH};
use crate::effect::Effect;
use crate::marker::Spin;
use crate::motion::Function;
use crate::system::{INTEGRALS, Integral, State, Weights};

/// M(t) on the second body, -M(t) on the first (the ground, where there is none): conjugate to the relative angle. On a
/// slope r' it is the force M (-r'_y, r'_x)/|r'|^2.
#[derive(Debug)]
pub struct Torque {
    /// The body that takes the reaction.
    pub first: Spin,
    /// The body it turns.
    pub second: Spin,
    /// M \[N m\].
    pub value: Function,
}

impl Torque {
    fn sides(&self) -> [(f64, Spin, usize); 2] {
        [
            (-1.0, self.first, 0),
            (1.0, self.second, self.first.width()),
        ]
    }
}

impl Force for Torque {
    fn effect(&self) -> Effect {
        Effect::Torque
    }

    fn coordinates(&self) -> Vec<usize> {
        [self.first.coordinates(), self.second.coordinates()].concat()
    }

    fn split(&self) -> usize {
        self.first.width()
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let torque = self.value.at(at.t)[0];
        for (sign, spin, first) in self.sides() {
            let d = spin.derivatives(&at.q, &at.v);
            for i in 0..spin.width() {
                f[first + i] -= sign * torque * d.b[i];
            }
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        self.force(at, f);
        let torque = self.value.at(at.t)[0];
        for (sign, spin, first) in self.sides() {
            let d = spin.derivatives(&at.q, &at.v);
            for i in 0..spin.width() {
                for j in 0..spin.width() {
                    k[first + i][first + j] -= w.q * sign * torque * d.b_q[i][j];
                }
            }
        }
    }

    fn powers(&self, at: &State, powers: &mut [f64; INTEGRALS]) {
        let rates = [self.first, self.second].map(|s| s.rate(&at.q, &at.v));
        powers[Integral::Work as usize] += self.value.at(at.t)[0] * (rates[1] - rates[0]);
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("torque", "N m")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        [self.value.at(at.t)[0], 0.0, 0.0]
    }
}
