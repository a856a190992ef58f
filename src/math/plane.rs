//! Vectors of the plane: those of nalgebra, and what it does not have. nalgebra's `a.perp(&b)` is the out-of-plane component of a x b.

use nalgebra::{UnitComplex, Vector2};

/// A vector of the plane.
pub type Vec2 = Vector2<f64>;

/// A rotation of the plane by an angle.
pub type Rotation = UnitComplex<f64>;

/// a turned by +90 degrees, exactly.
#[inline]
pub fn quarter_turn(a: Vec2) -> Vec2 {
    Vec2::new(-a.y, a.x)
}

/// The unit vector at an angle from the x axis.
#[inline]
pub fn unit(angle: f64) -> Vec2 {
    Vec2::new(angle.cos(), angle.sin())
}

/// The entries `i` and `i + 1` of x.
#[inline]
pub fn pair(x: &[f64], i: usize) -> Vec2 {
    Vec2::new(x[i], x[i + 1])
}
