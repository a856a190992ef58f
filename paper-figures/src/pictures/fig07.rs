//! Fig. 7: force in joint B1. a) case 2, where it is the reaction of the ideal joint, b) case 3, c) case 4.

use super::of_cases;
use crate::figures::FigureRuns;
use crate::runs::{CaseRecording, DURATION, FROM};
use crate::signal::{mean, peak};
use numbers::si;
use plot::{Axis, Figure};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let note = |run: &CaseRecording| {
        let force = run.between("B1.force", FROM, DURATION).1;
        let (largest, average) = (si(peak(force), "N"), si(mean(force), "N"));
        let quantity = match run.plan.case {
            2 => "Reaction",
            _ => "Contact force",
        };
        format!("{quantity}: peak {largest}, mean {average}.")
    };
    let axis = Axis::new("Force in joint B1", "N", 1.0);
    let text = "Magnitude of the force in joint B1. Case 2 has no contact: its force is the reaction of the ideal \
                joint. The numbers above the panels belong to the finer step.";
    of_cases(runs, ("B1.force", axis), note, |_, marks| marks, text)
}
