//! Vectors of the plane as `[f64; 2]`.

/// A vector of the plane.
pub type Vec2 = [f64; 2];

/// a + b
#[inline]
pub fn add(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] + b[0], a[1] + b[1]]
}

/// a - b
#[inline]
pub fn sub(a: Vec2, b: Vec2) -> Vec2 {
    [a[0] - b[0], a[1] - b[1]]
}

/// s a
#[inline]
pub fn scale(s: f64, a: Vec2) -> Vec2 {
    [s * a[0], s * a[1]]
}

/// a . b
#[inline]
pub fn dot(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// a turned by +90 degrees.
#[inline]
pub fn perp(a: Vec2) -> Vec2 {
    [-a[1], a[0]]
}

/// Out-of-plane component of a x b.
#[inline]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// |a|; a plain square root, because no length of a mechanism comes near the range of `f64`.
#[inline]
pub fn norm(a: Vec2) -> f64 {
    dot(a, a).sqrt()
}

/// a turned by the angle whose cosine and sine are given.
#[inline]
pub fn rotate(cosine: f64, sine: f64, a: Vec2) -> Vec2 {
    [cosine * a[0] - sine * a[1], sine * a[0] + cosine * a[1]]
}
