//! Holonomic constraints: values, gradients, multiplier forces, rates.

mod coincide;
mod length;

pub use coincide::Coincide;
pub use length::Length;
