//! Small mathematics that the mechanics stands on.

pub mod dense;
pub mod lu;
pub mod plane;
pub mod quadrature;
pub mod saddle_point;
pub mod sparse_rows;
