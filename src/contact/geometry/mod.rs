//! Geometries of contact, one a file.

mod circle_in_circle;

pub use circle_in_circle::CircleInCircle;

use super::ContactState;
use crate::force::{LocalMatrix, WIDTH};
use crate::math::plane::Vec2;

/// Where the surfaces of a contact are.
#[derive(Debug, Clone, Copy, Default)]
pub struct Gap {
    /// Eccentricity vector along the normal: second side minus first (eq. 19) \[m\].
    pub e: Vec2,
    /// Its rate \[m/s\].
    pub e_dot: Vec2,
    /// Its magnitude \[m\].
    pub eccentricity: f64,
    /// Penetration delta (eq. 21) \[m\].
    pub delta: f64,
    /// Arms of the two markers, for a geometry that needs them again \[m\].
    pub arms: [Vec2; 2],
}

/// A touching contact: directions, rates, and the gradients of both in local coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub struct Touch {
    /// Unit normal, out of the first side.
    pub n: Vec2,
    /// Unit tangent: n turned by 90 degrees or, where there is a line along which the second side slides, the direction of the line.
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
    /// For a marker on a body, of a geometry that needs it again: local index of theta and d2(e)/d(theta)2.
    pub bends: [Option<(usize, Vec2)>; 2],
}

/// The surfaces of a contact between two points. Nothing but [`Geometry::gap`] is evaluated while they are apart.
pub trait Geometry: std::fmt::Debug + Send + Sync {
    /// The coordinates in local order. None occurs twice.
    fn coordinates(&self) -> Vec<usize>;
    /// Number of local coordinates.
    fn columns(&self) -> usize;
    /// Eccentricity and penetration.
    fn gap(&self, q: &[f64], v: &[f64]) -> Gap;
    /// d(delta)/dt = n . e_dot; |e_dot| of sides that leave their centre \[m/s\].
    #[inline]
    fn rate(&self, gap: &Gap) -> f64 {
        if gap.eccentricity > 0.0 {
            gap.e.dot(&gap.e_dot) / gap.eccentricity
        } else {
            gap.e_dot.norm()
        }
    }
    /// `force` along the normal n = e/|e| \[N\].
    #[inline]
    fn along_normal(&self, gap: &Gap, force: f64) -> Vec2 {
        force / gap.eccentricity * gap.e
    }
    /// Adds `force` d(delta)/dq to `f`.
    fn push(&self, at: ContactState, gap: &Gap, force: f64, f: &mut [f64; WIDTH]);
    /// Directions, rates and gradients of surfaces that touch.
    fn touch(&self, at: ContactState, gap: &Gap) -> Touch;
    /// Adds normal d2(delta)/dq2 + tangential d2(slip)/(dv dq) to `k`, without the rates.
    fn curve(
        &self,
        at: ContactState,
        gap: &Gap,
        touch: &Touch,
        normal: f64,
        tangential: f64,
        k: &mut LocalMatrix,
    );
    /// The part of the slip with which the point of contact moves over the surfaces (eqs. 22, 23), and its derivative by delta.
    fn share(&self, _gap: &Gap) -> [f64; 2] {
        [1.0, 0.0]
    }
    /// Radii of the two surfaces \[m\]: what spins of the bodies add to the slip.
    fn radii(&self) -> [f64; 2] {
        [0.0; 2]
    }
}
