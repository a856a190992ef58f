//! The elasto-plastic law of Dupont, Hayward, Armstrong and Altpeter (2002, IEEE Trans. Automat. Contr. 47:787): bristles that are elastic
//! up to the deflection of break-away, so that they hold under an oscillating load.

use super::FrictionKind;
use super::bristle::{self, Bristle, BristleLaw, Plasticity};
use crate::document::{Key, NumberRange};
use numbers::exact;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

pub(super) static KIND: FrictionKind = FrictionKind {
    name: "elasto_plastic",
    keys: &{
        let [a, b, c, d, e, f, g, slip] = bristle::KEYS;
        let breakaway = Key::within(
            "breakaway",
            NumberRange::Between(0.0, 1.0),
            "the deflection up to which bristles are elastic over mu_c/s_0, below 1",
        );
        [a, b, c, d, e, f, g, breakaway, slip]
    },
    read: |table| {
        let breakaway = table.number("breakaway")?;
        if breakaway == 1.0 {
            return Err(table.field("breakaway")?.must("be less than 1"));
        }
        let bristle = Bristle::read(table)?;
        Ok(Some(Arc::new(ElastoPlastic {
            bristle,
            elastic_limit: breakaway * bristle.coefficient.kinetic / bristle.stiffness,
        })))
    },
};

/// Bristles with alpha = 0 where z v <= 0 or |z| <= z_ba, 1 where |z| >= z_ss = g(v)/s_0, and between them
/// 1/2 + 1/2 sin(pi (|z| - (z_ss + z_ba)/2)/(z_ss - z_ba)).
#[derive(Debug, Clone, Copy)]
pub struct ElastoPlastic {
    /// What it shares with LuGre.
    pub bristle: Bristle,
    /// z_ba \[m\].
    pub elastic_limit: f64,
}

impl BristleLaw for ElastoPlastic {
    fn bristle(&self) -> &Bristle {
        &self.bristle
    }

    fn alpha(&self, slip: f64, z: f64, g: f64) -> Plasticity {
        let constant = |value| Plasticity {
            value,
            by_deflection: 0.0,
            by_coefficient: 0.0,
        };
        let (size, elastic) = (z.abs(), self.elastic_limit);
        let steady = g / self.bristle.stiffness;
        if z * slip <= 0.0 || size <= elastic {
            return constant(0.0);
        }
        if size >= steady {
            return constant(1.0);
        }
        let width = steady - elastic;
        let angle = PI * (size - 0.5 * (steady + elastic)) / width;
        let slope = FRAC_PI_2 * angle.cos() / width;
        Plasticity {
            value: 0.5 + 0.5 * angle.sin(),
            by_deflection: slope * z.signum(),
            by_coefficient: slope * (elastic - size) / width / self.bristle.stiffness,
        }
    }

    fn parameters(&self) -> String {
        format!(
            "elasto-plastic {}, elastic up to {} m",
            self.bristle.describe(),
            exact(self.elastic_limit)
        )
    }
}
