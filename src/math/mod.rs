//! Small mathematics that the mechanics stands on.

pub mod bisection;
mod copies;
pub mod dense;
pub mod groups;
pub mod independent_rows;
pub mod lu;
mod mass_inverse;
mod minimum_degree;
pub mod plane;
pub mod quadrature;
pub mod saddle_point;
pub mod sparse_product;
pub mod sparse_rows;

/// The larger of m and |x|; not a number if one of them is not, where `f64::max` would drop it.
#[inline]
pub fn larger(m: f64, x: f64) -> f64 {
    match x.abs() <= m || m.is_nan() {
        true => m,
        false => x.abs(),
    }
}

/// Component i of a direction that shares no symmetry with a mechanism: its components are a golden angle, about 2.4 rad, apart.
pub fn generic(i: usize) -> f64 {
    (1.0 + 2.4 * i as f64).sin()
}
