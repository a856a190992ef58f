//! Ambrosio's modified Coulomb friction (eq. 26).

use super::{FrictionKind, FrictionLaw, SLIP, TangentialForce};
use crate::document::Key;
use numbers::exact;
use std::sync::Arc;

/// Slip below which there is no friction, where the scene says nothing \[m/s\]: the transition velocity that Adams has by default,
/// 0.1 mm/s.
const V0: f64 = 1e-4;
/// Slip above which friction is full, where the scene says nothing \[m/s\]: the characteristic slip velocity that COMSOL has by default,
/// 1e-3/s times the diagonal of the geometry, of a mechanism of a metre.
const V1: f64 = 1e-3;

pub(super) static KIND: FrictionKind = FrictionKind {
    name: "ambrosio",
    keys: &[
        Key::non_negative("coefficient", "", "the coefficient of friction c_f"),
        Key::non_negative("v0", "m/s", "the slip below which there is no friction").or("1e-4"),
        Key::positive(
            "v1",
            "m/s",
            "the slip above which friction is full, greater than `v0`",
        )
        .or("1e-3"),
        SLIP,
    ],
    read: |table| {
        let coefficient = table.number("coefficient")?;
        let v0 = table.optional_number("v0")?.unwrap_or(V0);
        let v1 = table.optional_number("v1")?.unwrap_or(V1);
        if v1 <= v0 {
            return Err(match (table.optional("v1"), table.optional("v0")) {
                (None, Some(v0)) => v0.must(&format!("be less than `v1` = {v1:?}")),
                _ => table
                    .field("v1")?
                    .must(&format!("be greater than `v0` = {v0:?}")),
            });
        }
        let law = Ambrosio {
            coefficient,
            v0,
            v1,
        };
        Ok((coefficient > 0.0).then(|| Arc::new(law) as Arc<dyn FrictionLaw>))
    },
};

/// T = c_f d(|v_t|) F_n sign(v_t), d = 0 below v0, 1 above v1, linear between.
///
/// Eq. 26 is printed for v_t >= 0; with |v_t| and the sign it is odd, as friction has to be.
#[derive(Debug, Clone, Copy)]
pub struct Ambrosio {
    /// c_f.
    pub coefficient: f64,
    /// Slip where friction sets in \[m/s\].
    pub v0: f64,
    /// Slip where friction is full \[m/s\].
    pub v1: f64,
}

impl FrictionLaw for Ambrosio {
    fn force(&self, slip: f64, normal: f64, _: f64) -> TangentialForce {
        let ramp = ((slip.abs() - self.v0) / (self.v1 - self.v0)).clamp(0.0, 1.0);
        let sliding = slip.abs() > self.v0 && slip.abs() < self.v1;
        let by_slip = if sliding {
            self.coefficient * normal / (self.v1 - self.v0)
        } else {
            0.0
        };
        let by_normal = self.coefficient * ramp * slip.signum();
        TangentialForce {
            value: by_normal * normal,
            by_slip,
            by_normal,
            ..TangentialForce::default()
        }
    }

    fn creeps(&self, slip: f64) -> bool {
        slip != 0.0 && slip.abs() < self.v1
    }

    fn largest_coefficient(&self) -> (&'static str, f64) {
        ("coefficient", self.coefficient)
    }

    fn describe(&self) -> String {
        let [v0, v1] = [(self.v0, V0), (self.v1, V1)].map(|(v, default)| match v == default {
            true => format!("{} m/s, the default", exact(v)),
            false => format!("{} m/s", exact(v)),
        });
        let coefficient = exact(self.coefficient);
        format!("friction {coefficient} with v0 = {v0}, and v1 = {v1}")
    }
}
