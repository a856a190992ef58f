//! Hertz: no damping.

use super::{DampedPower, damped_power_law};

/// F = K delta^n.
#[derive(Debug, Clone, Copy)]
pub struct Hertz(pub DampedPower);

impl Hertz {
    /// Stiffness K \[N/m^n\] and exponent n.
    pub fn new(stiffness: f64, exponent: f64) -> Hertz {
        Hertz(DampedPower {
            stiffness,
            exponent,
            damping: 0.0,
            impact_velocity_floor: f64::MIN_POSITIVE,
        })
    }
}

damped_power_law!(Hertz, "hertz");
