//! Scalar contact laws: a normal force from penetration and its rate, a tangential force from slip and normal force.

pub mod ambrosio;
mod flores;
mod hertz;
mod hunt_crossley;
mod lankarani_nikravesh;

pub use ambrosio::Ambrosio;
pub use flores::Flores;
pub use hertz::Hertz;
pub use hunt_crossley::HuntCrossley;
pub use lankarani_nikravesh::LankaraniNikravesh;

use crate::scene::{Contact, NormalLawKind};

/// A normal force with its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalForce {
    /// Force that pushes the surfaces apart \[N\], never negative.
    pub value: f64,
    /// d(value)/d(delta) \[N/m\].
    pub by_delta: f64,
    /// d(value)/d(delta_dot) \[N s/m\].
    pub by_rate: f64,
    /// Conservative part K delta^n \[N\].
    pub elastic: f64,
    /// The law asked for a pull, and got zero.
    pub clamped: bool,
}

/// A normal law for penetrations delta > 0 \[m\]; `rate` is delta_dot and `impact_velocity` the one stored at onset \[m/s\].
pub trait NormalLaw: std::fmt::Debug + Send + Sync {
    /// The name in a scene.
    fn name(&self) -> &'static str;
    /// The force with its slopes.
    fn force(&self, delta: f64, rate: f64, impact_velocity: f64) -> NormalForce;
    /// Energy of the conservative part, K delta^(n+1)/(n+1) \[J\]; 0 when apart.
    fn energy(&self, delta: f64) -> f64;
    /// Restitution that a free impact of one mass delivers.
    fn delivered_restitution(&self) -> f64;
}

/// K delta^n (1 + chi delta_dot / impact velocity): the family that Hertz, Hunt and Crossley, Lankarani and Nikravesh and
/// Flores et al. share; they differ in chi.
#[derive(Debug, Clone, Copy)]
pub struct DampedPower {
    /// K \[N/m^n\].
    pub stiffness: f64,
    /// n.
    pub exponent: f64,
    /// chi.
    pub damping: f64,
    /// Smallest impact velocity that divides \[m/s\]: at a grazing onset eq. 24 would divide by zero.
    pub impact_velocity_floor: f64,
}

impl DampedPower {
    /// delta^(n-1), with the square root for the exponent of eq. 24.
    #[inline]
    fn power(&self, delta: f64) -> f64 {
        if self.exponent == 1.5 {
            delta.sqrt()
        } else {
            delta.powf(self.exponent - 1.0)
        }
    }

    /// The force with its slopes.
    #[inline]
    pub fn force(&self, delta: f64, rate: f64, impact_velocity: f64) -> NormalForce {
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

    /// K delta^(n+1)/(n+1).
    pub fn energy(&self, delta: f64) -> f64 {
        if delta <= 0.0 {
            0.0
        } else {
            self.stiffness * self.power(delta) * delta * delta / (self.exponent + 1.0)
        }
    }

    /// e_out of a free impact, which depends on chi alone: chi (1 + e_out) = ln((1 + chi)/(1 - chi e_out)).
    ///
    /// The mass m moves by m v dv/ddelta = -K delta^n (1 + chi v/v0); separated and integrated from v0 to -e_out v0.
    pub fn delivered_restitution(&self) -> f64 {
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

/// Implements [`NormalLaw`] for a law that is a named [`DampedPower`] in its field 0.
macro_rules! damped_power_law {
    ($law:ty, $name:literal) => {
        impl crate::contact::NormalLaw for $law {
            fn name(&self) -> &'static str {
                $name
            }
            fn force(
                &self,
                delta: f64,
                rate: f64,
                impact_velocity: f64,
            ) -> crate::contact::NormalForce {
                self.0.force(delta, rate, impact_velocity)
            }
            fn energy(&self, delta: f64) -> f64 {
                self.0.energy(delta)
            }
            fn delivered_restitution(&self) -> f64 {
                self.0.delivered_restitution()
            }
        }
    };
}
pub(crate) use damped_power_law;

/// Builds a law from stiffness K, exponent n, restitution coefficient c_e and the floor of the impact velocity.
pub type Build = fn(f64, f64, f64, f64) -> Box<dyn NormalLaw>;

/// All laws, by the kind that a scene names.
pub const LAWS: [(NormalLawKind, Build); 4] = [
    (NormalLawKind::Hertz, |k, n, _, _| {
        Box::new(Hertz::new(k, n))
    }),
    (NormalLawKind::LankaraniNikravesh, |k, n, e, v| {
        Box::new(LankaraniNikravesh::new(k, n, e, v))
    }),
    (NormalLawKind::HuntCrossley, |k, n, e, v| {
        Box::new(HuntCrossley::new(k, n, e, v))
    }),
    (NormalLawKind::Flores, |k, n, e, v| {
        Box::new(Flores::new(k, n, e, v))
    }),
];

/// The normal law that a scene names.
pub fn normal_law(contact: &Contact) -> Box<dyn NormalLaw> {
    let (_, build) = LAWS
        .iter()
        .find(|(kind, _)| *kind == contact.law)
        .expect("every kind of law is in the registry");
    build(
        contact.stiffness,
        contact.exponent,
        contact.restitution,
        contact.impact_velocity_floor,
    )
}
