//! Friction laws, one a file: a tangential force from slip and normal force.

mod ambrosio;

pub use ambrosio::Ambrosio;

/// A tangential force with its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialForce {
    /// Force against the slip \[N\], of the sign of the slip.
    pub value: f64,
    /// d(value)/d(slip) \[N s/m\].
    pub by_slip: f64,
    /// d(value)/d(normal force).
    pub by_normal: f64,
}

/// A friction law without memory.
pub trait FrictionLaw: std::fmt::Debug + Send + Sync {
    /// The force with its slopes, for a slip \[m/s\] and a normal force \[N\].
    fn force(&self, slip: f64, normal: f64) -> TangentialForce;
    /// True for a slip at which a body that should stick slides, because the law has no other way to hold it.
    fn creeps(&self, slip: f64) -> bool;
}
