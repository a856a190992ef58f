//! The law of Canudas de Wit, Olsson, Åström and Lischinsky (1995, IEEE Trans. Automat. Contr. 40:419), LuGre: bristles that slip from the
//! first deflection on. Under an oscillating load below break-away it drifts.

use super::bristle::{self, Bristle, Plasticity};
use super::{FrictionKind, FrictionLaw, SLIP, TangentialForce};
use crate::system::InternalState;
use std::sync::Arc;

pub(super) static KIND: FrictionKind = FrictionKind {
    name: "lugre",
    keys: &{
        let [a, b, c, d, e, f, g] = bristle::KEYS;
        [a, b, c, d, e, f, g, SLIP]
    },
    read: |table| Ok(Some(Arc::new(LuGre(Bristle::read(table)?)))),
};

/// Bristles with alpha = 1.
#[derive(Debug, Clone, Copy)]
pub struct LuGre(pub Bristle);

impl FrictionLaw for LuGre {
    fn state(&self) -> Option<InternalState> {
        Some(Bristle::state())
    }

    fn force(&self, slip: f64, normal: f64, state: f64) -> TangentialForce {
        let alpha = |_| Plasticity {
            value: 1.0,
            by_deflection: 0.0,
            by_coefficient: 0.0,
        };
        self.0.force(slip, normal, state, alpha)
    }

    fn stored(&self, state: f64) -> [f64; 2] {
        self.0.stored(state)
    }

    fn may_give_energy(&self, slip: f64) -> bool {
        self.0.may_give_energy(slip)
    }

    fn largest_coefficient(&self) -> (&'static str, f64) {
        ("mu_s", self.0.coefficient.static_)
    }

    fn describe(&self) -> String {
        format!("LuGre {}", self.0.describe())
    }
}
