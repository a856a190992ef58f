//! The law of Canudas de Wit, Olsson, Åström and Lischinsky (1995, IEEE Trans. Automat. Contr. 40:419), LuGre: bristles that slip from the
//! first deflection on. Under an oscillating load below break-away it drifts.

use super::FrictionKind;
use super::bristle::{self, Bristle, BristleLaw, Plasticity};
use std::sync::Arc;

pub(super) static KIND: FrictionKind = FrictionKind {
    name: "lugre",
    keys: &bristle::KEYS,
    read: |table| Ok(Some(Arc::new(LuGre(Bristle::read(table)?)))),
};

/// Bristles with alpha = 1.
#[derive(Debug, Clone, Copy)]
pub struct LuGre(pub Bristle);

impl BristleLaw for LuGre {
    fn bristle(&self) -> &Bristle {
        &self.0
    }

    fn alpha(&self, _: f64, _: f64, _: f64) -> Plasticity {
        Plasticity {
            value: 1.0,
            by_deflection: 0.0,
            by_coefficient: 0.0,
        }
    }

    fn parameters(&self) -> String {
        format!("LuGre {}", self.0.describe())
    }
}
