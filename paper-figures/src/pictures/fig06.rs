//! Fig. 6: acceleration of the platform along x. a) case 2, b) case 3, c) case 4, each over that of case 1.

use super::{curve, of_cases};
use crate::figures::FigureRuns;
use crate::measures::deviation;
use crate::runs::{CaseRecording, DURATION, FROM};
use crate::signal::{peak, rms};
use numbers::si;
use plot::{Axis, Figure, Mark, palette};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let note = |run: &CaseRecording| {
        let largest = peak(run.between("platform.ax", FROM, DURATION).1);
        let deviation = rms(&deviation(&runs.geometry, run, FROM, DURATION));
        let [largest, deviation] = [largest, deviation].map(|x| si(x, "m/s²"));
        format!("Peak {largest}, rms deviation from case 1 {deviation}.")
    };
    let beside = |_: &CaseRecording, marks: Vec<Mark>| {
        let ideal = curve((runs.get("ideal"), palette::GREY), "platform.ax");
        let labelled = |label: &str| Mark {
            label: label.into(),
            ..ideal.clone()
        };
        // the ideal line is drawn again where a dense curve would hide it
        let before = [labelled("case 1 (ideal)").width(4)];
        let all = before.into_iter().chain(marks);
        all.chain([labelled("")]).collect()
    };
    let axis = Axis::new("Acceleration ẍ of platform", "m/s²", 1.0);
    let text = "Acceleration of the platform along x, from the acceleration-level equations at the accepted states. \
                The numbers above the panels belong to the finer step.";
    of_cases(runs, ("platform.ax", axis), note, beside, text)
}
