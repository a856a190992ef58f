//! Elastodynamics of planar mechanisms with flexible links and joint clearance.
#![forbid(unsafe_code)]

pub mod scene;
