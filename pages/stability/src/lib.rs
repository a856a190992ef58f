//! Hard cases: what becomes of a run where methods come to their limits.
//!
//! [`map`] runs a scene over a parameter and the step and gives every run an [`outcome::OutcomeClass`]; [`cases`] lists what
//! must hold in each of fifteen hard cases; [`random`] runs mechanisms that nobody drew.
#![forbid(unsafe_code)]

pub mod cases;
pub mod map;
mod memory;
pub mod outcome;
pub mod page;
pub mod random;
pub mod records;
