//! Flores, Machado, Silva and Martins 2011, Multibody Syst. Dyn. 25:357.

use super::{DampedPower, damped_power_law};

/// F = K delta^n (1 + 8 (1 - c_e)/(5 c_e) delta_dot / delta_dot^(-)).
#[derive(Debug, Clone, Copy)]
pub struct Flores(pub DampedPower);

impl Flores {
    /// Stiffness K \[N/m^n\], exponent n, restitution coefficient c_e, floor of the impact velocity \[m/s\].
    pub fn new(
        stiffness: f64,
        exponent: f64,
        restitution: f64,
        impact_velocity_floor: f64,
    ) -> Flores {
        let damping = 8.0 * (1.0 - restitution) / (5.0 * restitution);
        Flores(DampedPower {
            stiffness,
            exponent,
            damping,
            impact_velocity_floor,
        })
    }
}

damped_power_law!(Flores, "flores");
