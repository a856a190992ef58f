//! Friction that deflects bristles between the surfaces: their deflection z is an internal state.
//!
//! ```text
//! z' = v - alpha |v| s_0 z/g(v)          T = F_n (s_0 z + s_1(v) z' + s_2 v)
//! ```
//!
//! g is the coefficient of [`super::coulomb_stribeck`]; alpha, between 0 and 1, is what makes one law of the other. The bristles store
//! F_n s_0 z^2/2, and the loss
//!
//! ```text
//! F_n (s_0^2 alpha |v| z^2/g + s_1 z'^2 + s_0 s_1 alpha |v| z z'/g + s_2 v^2)
//! ```
//!
//! is never negative where s_1 |v| <= 4 g: with x = s_0 alpha |v| z/g its first three terms are g/(alpha |v|) x^2 + s_1 x z' + s_1 z'^2, a
//! form in x and z' whose discriminant s_1^2 - 4 s_1 g/(alpha |v|) is not positive then.

use super::coulomb_stribeck::{MU_C, MU_S, S2, Stribeck, V_S};
use super::{FrictionLaw, SLIP, StateRate, TangentialForce};
use crate::document::{Fields, Key, SceneError};
use crate::system::InternalState;
use numbers::exact;
use std::fmt::Debug;

pub(super) const S0: Key = Key::positive("s0", "1/m", "the stiffness s_0 of the bristles over F_n");
pub(super) const S1: Key =
    Key::non_negative("s1", "s/m", "the damping s_1 of the bristles over F_n").or("0");
pub(super) const V_D: Key = Key::positive(
    "v_d",
    "m/s",
    "with it s_1 falls with the slip as s_1 exp(-(v/v_d)^2)",
)
.or("s_1 is constant");
/// The keys that laws of bristles share.
pub(super) const KEYS: [Key; 8] = [MU_C, MU_S, V_S, S0, S1, V_D, S2, SLIP];

/// What laws of bristles share.
#[derive(Debug, Clone, Copy)]
pub struct Bristle {
    /// g.
    pub coefficient: Stribeck,
    /// s_0 \[1/m\].
    pub stiffness: f64,
    /// s_1 \[s/m\].
    pub damping: f64,
    /// v_d \[m/s\]; infinite where s_1 is constant.
    pub damping_velocity: f64,
    /// s_2 \[s/m\].
    pub viscous: f64,
}

/// A law of bristles.
pub(super) trait BristleLaw: Debug + Send + Sync + 'static {
    /// What it shares with others.
    fn bristle(&self) -> &Bristle;
    /// alpha at a slip v, a deflection z and a coefficient g.
    fn alpha(&self, v: f64, z: f64, g: f64) -> Plasticity;
    /// Its parameters in words.
    fn parameters(&self) -> String;
}

/// alpha with its derivatives by z and by g.
#[derive(Debug, Clone, Copy)]
pub struct Plasticity {
    /// alpha.
    pub value: f64,
    /// By z \[1/m\].
    pub by_deflection: f64,
    /// By g.
    pub by_coefficient: f64,
}

impl Bristle {
    /// Reads the keys of [`KEYS`].
    pub(super) fn read(table: &Fields) -> Result<Bristle, SceneError> {
        Ok(Bristle {
            coefficient: Stribeck::read(table)?,
            stiffness: table.number("s0")?,
            damping: table.optional_number("s1")?.unwrap_or(0.0),
            damping_velocity: table.optional_number("v_d")?.unwrap_or(f64::INFINITY),
            viscous: table.optional_number("s2")?.unwrap_or(0.0),
        })
    }

    /// s_1 and its derivative by the slip.
    fn damping_at(&self, slip: f64) -> [f64; 2] {
        let ratio = slip / self.damping_velocity;
        let s1 = self.damping * (-ratio * ratio).exp();
        [s1, -2.0 * ratio / self.damping_velocity * s1]
    }

    /// The force at a slip v, a normal force and a deflection z, with alpha(g).
    fn force(
        &self,
        v: f64,
        normal: f64,
        z: f64,
        alpha: impl FnOnce(f64) -> Plasticity,
    ) -> TangentialForce {
        let [g, g_v] = self.coefficient.at(v);
        let alpha = alpha(g);
        let s0 = self.stiffness;
        // z' = v - |v| s_0 z w with w = alpha/g
        let w = alpha.value / g;
        let w_v = (alpha.by_coefficient - w) / g * g_v;
        let rate = StateRate {
            value: v - v.abs() * s0 * z * w,
            by_slip: 1.0 - s0 * z * (v.signum() * w + v.abs() * w_v),
            by_state: -v.abs() * s0 * (w + z * alpha.by_deflection / g),
        };
        let [s1, s1_v] = self.damping_at(v);
        let by_normal = s0 * z + s1 * rate.value + self.viscous * v;
        TangentialForce {
            value: normal * by_normal,
            by_slip: normal * (s1 * rate.by_slip + s1_v * rate.value + self.viscous),
            by_normal,
            by_state: normal * (s0 + s1 * rate.by_state),
            rate,
        }
    }

    /// Its parameters in words.
    pub(super) fn describe(&self) -> String {
        format!(
            "{} with s0 = {}/m, s1 = {} s/m and s2 = {} s/m",
            self.coefficient.describe(),
            exact(self.stiffness),
            exact(self.damping),
            exact(self.viscous)
        )
    }
}

impl<L: BristleLaw> FrictionLaw for L {
    /// z: an error of it is one of a position. Its rate s_0 |v|/g is far above that of any motion.
    fn state(&self) -> Option<InternalState> {
        Some(InternalState {
            name: "bristle",
            unit: "m",
            metres: 1.0,
            is_stiff: true,
        })
    }

    fn force(&self, slip: f64, normal: f64, z: f64) -> TangentialForce {
        let alpha = |g| self.alpha(slip, z, g);
        self.bristle().force(slip, normal, z, alpha)
    }

    /// s_0 z^2/2 and its derivative.
    fn stored(&self, z: f64) -> [f64; 2] {
        let s0 = self.bristle().stiffness;
        [0.5 * s0 * z * z, s0 * z]
    }

    fn may_give_energy(&self, slip: f64) -> bool {
        let bristle = self.bristle();
        let ([g, _], [s1, _]) = (bristle.coefficient.at(slip), bristle.damping_at(slip));
        s1 * slip.abs() > 4.0 * g
    }

    fn largest_coefficient(&self) -> (&'static str, f64) {
        ("mu_s", self.bristle().coefficient.static_)
    }

    fn describe(&self) -> String {
        self.parameters()
    }
}
