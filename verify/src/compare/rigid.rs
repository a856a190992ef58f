//! Case 1: inverse dynamics on the one side, a differential-algebraic system without a degree of freedom on the other.

use super::classes;
use crate::check::Agreement;
use crate::trajectory::{Plan, Trajectory, tolerances};
use miette::Result;

/// Both trajectories over one cycle.
///
/// # Errors
/// A run that fails.
pub fn runs() -> Result<[Trajectory; 2]> {
    let plan = Plan::new("3rrr/case1", 1.0, 1e-3);
    // positions are those of the ideal mechanism at any step; the work is of order 4
    Ok([
        plan.rust(1e-4)?,
        plan.cpp(&tolerances(1e-12, 1e-14, 1e-12))?,
    ])
}

/// The rows.
///
/// # Errors
/// A run that fails.
pub fn agreements() -> Result<Vec<Agreement>> {
    let [rust, cpp] = runs()?;
    let reason = "of the largest of its kind; a hundred times the error of IDA at a relative tolerance of 1e-12";
    Ok(classes::agreements("case1, 1 s", &rust, &cpp, 1e-8, reason))
}
