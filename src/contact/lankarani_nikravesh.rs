//! Lankarani and Nikravesh (eq. 24).

use super::{DampedPower, damped_power_law};

/// F = K delta^n (1 + 3 (1 - c_e^2)/4 delta_dot / delta_dot^(-)).
#[derive(Debug, Clone, Copy)]
pub struct LankaraniNikravesh(pub DampedPower);

impl LankaraniNikravesh {
    /// Stiffness K \[N/m^n\], exponent n, restitution coefficient c_e, floor of the impact velocity \[m/s\].
    pub fn new(
        stiffness: f64,
        exponent: f64,
        restitution: f64,
        impact_velocity_floor: f64,
    ) -> LankaraniNikravesh {
        let damping = 0.75 * (1.0 - restitution * restitution);
        LankaraniNikravesh(DampedPower {
            stiffness,
            exponent,
            damping,
            impact_velocity_floor,
        })
    }
}

damped_power_law!(LankaraniNikravesh, "lankarani_nikravesh");
