//! Fig. 7: force in joint B1. a) case 2, where it is the reaction of the ideal joint, b) case 3, c) case 4.

use super::of_cases;
use crate::figures::FigureRuns;
use plot::{Axis, Figure};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let axis = Axis::new("Force in joint B1", "N", 1.0);
    let text = "Magnitude of the force in joint B1. Case 2 has no contact: its force is the reaction of the ideal joint.";
    of_cases(runs, ("B1.force", axis), |_, marks| marks, text)
}
