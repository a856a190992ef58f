//! K delta^n (1 + chi delta_dot / impact velocity): the family that Hertz, Hunt and Crossley, Lankarani and Nikravesh and
//! Flores et al. share; they differ in chi.

use super::{NormalForce, NormalLaw, NormalLawKind, NormalParameters};

/// Hertz: no damping.
pub static HERTZ: NormalLawKind = NormalLawKind {
    name: "hertz",
    is_damped: false,
    keys: &[],
    build: |p| {
        // nothing is divided by the impact velocity
        let impact_velocity_floor = f64::MIN_POSITIVE;
        let undamped = NormalParameters {
            impact_velocity_floor,
            ..*p
        };
        Box::new(DampedPower::new(&undamped, 0.0))
    },
};

/// Lankarani and Nikravesh (eq. 24): chi = 3 (1 - c_e^2)/4.
pub static LANKARANI_NIKRAVESH: NormalLawKind = NormalLawKind {
    name: "lankarani_nikravesh",
    is_damped: true,
    keys: &[],
    build: |p| {
        Box::new(DampedPower::new(
            p,
            0.75 * (1.0 - p.restitution * p.restitution),
        ))
    },
};

/// Hunt and Crossley 1975, J. Appl. Mech. 42:440: chi = 3 (1 - c_e)/2.
pub static HUNT_CROSSLEY: NormalLawKind = NormalLawKind {
    name: "hunt_crossley",
    is_damped: true,
    keys: &[],
    build: |p| Box::new(DampedPower::new(p, 1.5 * (1.0 - p.restitution))),
};

/// Flores, Machado, Silva and Martins 2011, Multibody Syst. Dyn. 25:357: chi = 8 (1 - c_e)/(5 c_e).
pub static FLORES: NormalLawKind = NormalLawKind {
    name: "flores",
    is_damped: true,
    keys: &[],
    build: |p| {
        let damping = 8.0 * (1.0 - p.restitution) / (5.0 * p.restitution);
        Box::new(DampedPower::new(p, damping))
    },
};

/// A law of the family.
#[derive(Debug, Clone, Copy)]
pub struct DampedPower {
    /// K \[N/m^n\].
    pub stiffness: f64,
    /// n.
    pub exponent: f64,
    /// chi.
    pub damping: f64,
    /// Smallest impact velocity that divides \[m/s\].
    pub impact_velocity_floor: f64,
}

impl DampedPower {
    fn new(p: &NormalParameters, damping: f64) -> DampedPower {
        DampedPower {
            stiffness: p.stiffness,
            exponent: p.exponent,
            damping,
            impact_velocity_floor: p.impact_velocity_floor,
        }
    }

    /// delta^(n-1), with the square root for the exponent of eq. 24.
    #[inline]
    fn power(&self, delta: f64) -> f64 {
        if self.exponent == 1.5 {
            delta.sqrt()
        } else {
            delta.powf(self.exponent - 1.0)
        }
    }
}

impl NormalLaw for DampedPower {
    fn force(&self, delta: f64, rate: f64, impact_velocity: f64) -> NormalForce {
        let slope = self.stiffness * self.power(delta);
        let elastic = slope * delta;
        let ratio = self.damping / impact_velocity.max(self.impact_velocity_floor);
        let bracket = 1.0 + ratio * rate;
        if bracket < 0.0 {
            return NormalForce {
                value: 0.0,
                by_delta: 0.0,
                by_rate: 0.0,
                elastic,
                clamped: true,
            };
        }
        NormalForce {
            value: elastic * bracket,
            by_delta: self.exponent * slope * bracket,
            by_rate: elastic * ratio,
            elastic,
            clamped: false,
        }
    }

    fn energy(&self, delta: f64) -> f64 {
        if delta <= 0.0 {
            0.0
        } else {
            self.stiffness * self.power(delta) * delta * delta / (self.exponent + 1.0)
        }
    }

    /// e_out of a free impact, which depends on chi alone: chi (1 + e_out) = ln((1 + chi)/(1 - chi e_out)).
    ///
    /// The mass m moves by m v dv/ddelta = -K delta^n (1 + chi v/v0); separated and integrated from v0 to -e_out v0.
    fn delivered_restitution(&self) -> f64 {
        let chi = self.damping;
        if chi == 0.0 {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0_f64.min(1.0 / chi));
        // bisection: one bit a turn
        for _ in 0..60 {
            let e = 0.5 * (low + high);
            // ln((1 + chi)/(1 - chi e)) - chi (1 + e), negative at e = 0 and growing
            let excess = log1p_minus(chi) - log1p_minus(-chi * e);
            if excess > 0.0 { high = e } else { low = e }
        }
        0.5 * (low + high)
    }
}

/// ln(1 + x) - x without cancellation near zero.
fn log1p_minus(x: f64) -> f64 {
    if x.abs() > 0.2 {
        return x.ln_1p() - x;
    }
    // 0.2^25/25 is below the rounding of the first term 0.2^2/2
    (2..25).rev().fold(0.0, |sum, k| {
        x * (if k % 2 == 0 { -1.0 } else { 1.0 } / f64::from(k) + sum)
    }) * x
}
