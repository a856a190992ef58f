//! Figs. 5 to 9 of Zhang & Zhang (2017), and its statements decided by computed quantities.
//!
//! Three campaigns measure: [`figures`] makes the runs of the figures, [`scans`] varies one parameter at a time, [`ensembles`] runs the
//! chaotic cases from many starts. Their results are records; [`statement`], [`scans`] and [`ensembles_page`] make the contexts of the
//! templates from them, without a run.
#![forbid(unsafe_code)]

mod decisions;
pub mod ensembles;
pub mod ensembles_page;
mod evidence;
pub mod exponents;
pub mod figures;
mod kinematics;
mod measures;
mod methods;
mod pictures;
mod runs;
pub mod scans;
mod shown;
mod signal;
pub mod statement;
mod timings;
mod variants;
mod verdict;
mod warned;

pub use shown::environment;
