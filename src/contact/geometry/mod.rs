//! Geometries of contact, one a file.

mod circle_in_circle;

pub use circle_in_circle::CircleInCircle;

use crate::force::{LocalMatrix, WIDTH};
use crate::math::plane::Vec2;

/// Where the surfaces of a contact are.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gap {
    /// Eccentricity vector: second side minus first (eq. 19) \[m\].
    pub e: Vec2,
    /// Its rate \[m/s\].
    pub e_dot: Vec2,
    /// Its magnitude \[m\].
    pub eccentricity: f64,
    /// Penetration delta (eq. 21) \[m\].
    pub delta: f64,
    /// Arms of the two markers \[m\].
    pub(super) arms: [Vec2; 2],
}

/// A touching contact: directions, rates, and the gradients of both in local coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Touch {
    /// Unit normal, out of the first side.
    pub n: Vec2,
    /// Unit tangent: n turned by 90 degrees.
    pub t: Vec2,
    /// Velocity of the second side relative to the first, along t \[m/s\].
    pub slip: f64,
    /// d(delta)/dq = d(delta_dot)/dv.
    pub normal: [f64; WIDTH],
    /// d(slip)/dv.
    pub tangent: [f64; WIDTH],
    /// d(delta_dot)/dq.
    pub rate_q: [f64; WIDTH],
    /// d(slip)/dq.
    pub slip_q: [f64; WIDTH],
    /// For a marker on a body: local index of theta and d2(e)/d(theta)2.
    pub(super) bends: [Option<(usize, Vec2)>; 2],
}

/// The surfaces of a contact between two points. Nothing but [`Geometry::gap`] is evaluated while they are apart.
pub trait Geometry: std::fmt::Debug + Send + Sync {
    /// The coordinates in local order. None occurs twice.
    fn coordinates(&self) -> Vec<usize>;
    /// Number of local coordinates.
    fn columns(&self) -> usize;
    /// Eccentricity and penetration.
    fn gap(&self, q: &[f64], v: &[f64]) -> Gap;
    /// d(delta)/dt \[m/s\].
    fn rate(&self, gap: &Gap) -> f64;
    /// `force` along the normal \[N\].
    fn along_normal(&self, gap: &Gap, force: f64) -> Vec2;
    /// Adds `force` d(delta)/dq to `f`.
    fn push(&self, gap: &Gap, force: f64, f: &mut [f64; WIDTH]);
    /// Directions, rates and gradients of surfaces that touch.
    fn touch(&self, v: &[f64], gap: &Gap) -> Touch;
    /// Adds normal d2(delta)/dq2 + tangential d2(slip)/(dv dq) to `k`, without the rates.
    fn curve(&self, gap: &Gap, touch: &Touch, normal: f64, tangential: f64, k: &mut LocalMatrix);
    /// The part of the slip with which the point of contact moves over the surfaces (eqs. 22, 23), and its derivative by delta.
    fn share(&self, gap: &Gap) -> [f64; 2];
    /// Radii of the two surfaces \[m\]: what spins of the bodies add to the slip.
    fn radii(&self) -> [f64; 2];
}
