//! Case 1: inverse dynamics on the one side, a differential-algebraic system without a degree of freedom on the other.

use super::classes::{self, NO_ROUNDING};
use crate::check::Agreement;
use crate::trajectory::{ComparisonPlan, tolerances};
use miette::Result;

/// The rows of one cycle.
pub fn agreements() -> Result<Vec<Agreement>> {
    let (plan, scene) = (ComparisonPlan::new("3rrr/case1", 1.0, 1e-3), "case1, 1 s");
    // positions are those of the ideal mechanism at any step; the work is of order 4
    let runs = [&plan.rust(1e-4)?, &plan.cpp(&tolerances(1e-12))?];
    let reason = "relative to the largest value of its kind; a hundred times the error of IDA at a relative tolerance of 1e-12";
    Ok(classes::agreements(NO_ROUNDING, scene, runs, 1e-10, reason))
}
