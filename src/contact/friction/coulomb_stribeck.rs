//! Coulomb friction whose coefficient falls from a static to a kinetic one with the slip (Stribeck).

use super::{FrictionKind, FrictionLaw, SLIP, TangentialForce};
use crate::document::{Fields, Key, SceneError};
use numbers::exact;
use std::sync::Arc;

pub(super) const MU_C: Key = Key::positive("mu_c", "", "the kinetic coefficient of friction mu_c");
pub(super) const MU_S: Key = Key::positive(
    "mu_s",
    "",
    "the static coefficient of friction mu_s, at least `mu_c`",
);
pub(super) const V_S: Key = Key::positive("v_s", "m/s", "the Stribeck velocity v_s");
pub(super) const S2: Key = Key::non_negative("s2", "s/m", "the viscous friction s_2").or("0");

pub(super) static KIND: FrictionKind = FrictionKind {
    name: "coulomb_stribeck",
    keys: &[
        MU_C,
        MU_S,
        V_S,
        Key::positive(
            "v_r",
            "m/s",
            "the slip v_r over which the force changes its sign",
        ),
        S2,
        SLIP,
    ],
    read: |table| {
        Ok(Some(Arc::new(CoulombStribeck {
            coefficient: Stribeck::read(table)?,
            v_r: table.number("v_r")?,
            viscous: table.optional_number("s2")?.unwrap_or(0.0),
        })))
    },
};

/// The coefficient g(v) = mu_c + (mu_s - mu_c) exp(-(v/v_s)^2).
#[derive(Debug, Clone, Copy)]
pub struct Stribeck {
    /// mu_c.
    pub kinetic: f64,
    /// mu_s.
    pub static_: f64,
    /// v_s \[m/s\].
    pub velocity: f64,
}

impl Stribeck {
    /// Reads its three keys.
    pub(super) fn read(table: &Fields) -> Result<Stribeck, SceneError> {
        let [kinetic, static_] = [table.number("mu_c")?, table.number("mu_s")?];
        if static_ < kinetic {
            let field = table.field("mu_s")?;
            return Err(field.must(&format!("be at least `mu_c` = {kinetic:?}")));
        }
        Ok(Stribeck {
            kinetic,
            static_,
            velocity: table.number("v_s")?,
        })
    }

    /// g and dg/dv at a slip \[m/s\].
    pub fn at(&self, slip: f64) -> [f64; 2] {
        let ratio = slip / self.velocity;
        let above = (self.static_ - self.kinetic) * (-ratio * ratio).exp();
        [self.kinetic + above, -2.0 * ratio / self.velocity * above]
    }

    /// Its parameters in words.
    pub fn describe(&self) -> String {
        let [kinetic, static_, velocity] = [self.kinetic, self.static_, self.velocity].map(exact);
        format!("friction {kinetic} (static {static_}, v_s = {velocity} m/s)")
    }
}

/// T = F_n (g(v) tanh(v/v_r) + s_2 v).
#[derive(Debug, Clone, Copy)]
pub struct CoulombStribeck {
    /// g.
    pub coefficient: Stribeck,
    /// v_r \[m/s\].
    pub v_r: f64,
    /// s_2 \[s/m\].
    pub viscous: f64,
}

/// Over v_r: there tanh is 1 in double precision.
const FULL: f64 = 19.0;

impl FrictionLaw for CoulombStribeck {
    fn force(&self, slip: f64, normal: f64, _: f64) -> TangentialForce {
        let [g, g_v] = self.coefficient.at(slip);
        let sign = (slip / self.v_r).tanh();
        let by_normal = g * sign + self.viscous * slip;
        let slope = g_v * sign + g * (1.0 - sign * sign) / self.v_r + self.viscous;
        TangentialForce {
            value: by_normal * normal,
            by_slip: slope * normal,
            by_normal,
            ..TangentialForce::default()
        }
    }

    fn creeps(&self, slip: f64) -> bool {
        slip != 0.0 && slip.abs() < FULL * self.v_r
    }

    fn largest_coefficient(&self) -> (&'static str, f64) {
        ("mu_s", self.coefficient.static_)
    }

    fn describe(&self) -> String {
        let shape = self.coefficient.describe();
        format!(
            "{shape} with v_r = {} m/s and s2 = {} s/m",
            exact(self.v_r),
            exact(self.viscous)
        )
    }
}
