//! Normal contact laws, one family a file: a force from penetration, its rate and the impact velocity.

pub mod damped_power;

pub use damped_power::DampedPower;

use crate::document::Key;

/// A normal force with its slopes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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
    /// The force with its slopes.
    fn force(&self, delta: f64, rate: f64, impact_velocity: f64) -> NormalForce;
    /// Energy of the conservative part, K delta^(n+1)/(n+1) \[J\]; 0 when apart.
    fn energy(&self, delta: f64) -> f64;
    /// Restitution that a free impact of one mass delivers.
    fn delivered_restitution(&self) -> f64;
}

/// What a scene gives a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalParameters<'a> {
    /// Contact stiffness K \[N/m^exponent\].
    pub stiffness: f64,
    /// Exponent n.
    pub exponent: f64,
    /// Restitution coefficient c_e; 1 for a law without damping.
    pub restitution: f64,
    /// Smallest impact velocity that the damping term divides by \[m/s\]: at a grazing onset eq. 24 would divide by zero.
    pub impact_velocity_floor: f64,
    /// Values of the keys that the law alone has, in their order.
    pub own: &'a [f64],
}

/// A kind of normal law.
#[derive(Debug)]
pub struct NormalLawKind {
    /// Its name in a scene.
    pub name: &'static str,
    /// False for a law without damping: its restitution is 1, and it does not use the impact velocity.
    pub is_damped: bool,
    /// Keys of a contact that this law alone has; all are numbers that it needs.
    pub keys: &'static [Key],
    /// Builds the law.
    pub build: fn(&NormalParameters) -> Box<dyn NormalLaw>,
}

impl PartialEq for NormalLawKind {
    fn eq(&self, other: &NormalLawKind) -> bool {
        self.name == other.name
    }
}

/// All kinds.
pub static LAWS: [&NormalLawKind; 4] = [
    &damped_power::LANKARANI_NIKRAVESH,
    &damped_power::HERTZ,
    &damped_power::HUNT_CROSSLEY,
    &damped_power::FLORES,
];
