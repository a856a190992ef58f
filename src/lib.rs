//! Elastodynamics of planar mechanisms with flexible links and joint clearance.
#![forbid(unsafe_code)]

pub mod compile;
pub mod constraint;
pub mod contact;
pub mod force;
pub mod initial;
pub mod kinematics;
pub mod link;
pub mod marker;
pub mod math;
pub mod model;
pub mod motion;
pub mod newton;
pub mod output;
pub mod record;
pub mod scene;
pub mod simulate;
pub mod stepper;
pub mod system;
