//! The evidence of the project: campaigns that measure what no test repeats, and the pages made of their results.
//!
//! Measuring and rendering are apart. A [`campaign`] leaves a [`records::Record`] in `evidence/data`; every tracked page and
//! picture is made from these records and from the templates in `evidence/templates`, in seconds and without a simulation.
#![forbid(unsafe_code)]

pub mod accuracy;
pub mod benchmarks;
pub mod campaign;
pub mod comparison;
pub mod gallery;
pub mod output;
pub mod paper;
pub mod stability;
pub mod verification;
pub mod worktree;
