//! Fig. 6: acceleration of the platform along x. a) case 2, b) case 3, c) case 4, each over that of case 1.

use super::{curve, of_cases};
use crate::figures::FigureRuns;
use crate::runs::CaseRecording;
use plot::{Axis, Figure, Mark, palette};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let beside = |_: &CaseRecording, mut marks: Vec<Mark>| {
        let mut ideal = curve((runs.get("ideal"), palette::GREY), "platform.ax");
        ideal.label = "case 1 (ideal)".into();
        marks.push(ideal);
        marks
    };
    let axis = Axis::new("Acceleration ẍ of platform", "m/s²", 1.0);
    let text = "Acceleration of the platform along x, from the acceleration-level equations at the accepted states.";
    of_cases(runs, ("platform.ax", axis), beside, text)
}
