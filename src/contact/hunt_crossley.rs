//! Hunt and Crossley 1975, J. Appl. Mech. 42:440.

use super::{DampedPower, damped_power_law};

/// F = K delta^n (1 + 3 (1 - c_e)/2 delta_dot / delta_dot^(-)).
#[derive(Debug, Clone, Copy)]
pub struct HuntCrossley(pub DampedPower);

impl HuntCrossley {
    /// Stiffness K \[N/m^n\], exponent n, restitution coefficient c_e, floor of the impact velocity \[m/s\].
    pub fn new(
        stiffness: f64,
        exponent: f64,
        restitution: f64,
        impact_velocity_floor: f64,
    ) -> HuntCrossley {
        let damping = 1.5 * (1.0 - restitution);
        HuntCrossley(DampedPower {
            stiffness,
            exponent,
            damping,
            impact_velocity_floor,
        })
    }
}

damped_power_law!(HuntCrossley, "hunt_crossley");
