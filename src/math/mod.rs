//! Small mathematics that the mechanics stands on.

pub mod lu;
pub mod plane;
pub mod quadrature;
