//! Fig. 5: displacement error of the platform along x. a) case 2, b) case 3, c) case 4.

use super::of_cases;
use crate::figures::FigureRuns;
use crate::measures::bound;
use crate::runs::{CaseRecording, DURATION, FROM};
use plot::{Axis, Figure, Mark, palette};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let beside = |run: &CaseRecording, mut marks: Vec<Mark>| {
        if run.plan.case >= 3 {
            let above = bound(&runs.geometry, run);
            let below: Vec<f64> = above.iter().map(|b| -b).collect();
            let (t, _) = run.between("t", FROM, DURATION);
            for (label, bound) in [("kinematic bound", &above), ("", &below)] {
                marks.push(Mark::series(label, palette::BLACK, t, bound).width(2));
            }
        }
        marks
    };
    let axis = Axis::new("Displacement error eₓ", "µm", 1e6);
    let text = "Displacement error of the platform along x. The ±0.2 mm of the paper is not drawn: it would flatten the \
                curves. Kinematic bound: sum over the legs of |J⁻¹|ₓᵢ (2 c + penetrations), in case 4 plus the \
                stretch of the links.";
    of_cases(runs, ("error.x", axis), beside, text)
}
