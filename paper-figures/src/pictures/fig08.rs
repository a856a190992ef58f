//! Fig. 8: penetration in joint B1, negative while journal and bearing are apart. a) case 3, b) case 4; below, the
//! same curves enlarged around contact.

use super::{caption, curve, over_time};
use crate::figures::FigureRuns;
use crate::runs::{CaseRecording, DURATION, FROM};
use plot::{Axis, Figure, Mark, Panel, palette};

const CHANNEL: &str = "B1.penetration";

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let clearance = runs.geometry.clearance;
    let axis = || Axis::new("Penetration δ in joint B1", "µm", 1e6);
    let deepest = |run: &CaseRecording| {
        let penetration = run.between(CHANNEL, FROM, DURATION).1.iter();
        penetration.copied().fold(f64::MIN, f64::max)
    };
    let whole = |title: &str, run: &CaseRecording| {
        let marks = vec![
            curve((run, palette::BLUE), CHANNEL),
            Mark::level("contact begins", palette::BLACK, 0.0),
            Mark::level("centred (δ = −c)", palette::GREY, -clearance),
        ];
        over_time(title, axis(), marks)
    };
    let close = |title: &str, run: &CaseRecording| -> Panel {
        let (low, high) = match deepest(run) {
            deepest if deepest > 0.0 => (-0.25 * deepest, 1.05 * deepest),
            _ => (-clearance, 0.0),
        };
        let mut curve = curve((run, palette::BLUE), CHANNEL);
        curve.label.clear();
        let marks = vec![curve, Mark::level("", palette::BLACK, 0.0)];
        over_time(title, axis().over(low, high), marks)
    };
    let [loose, both] = ["loose", "both"].map(|name| runs.get(name));
    let text = "Penetration δ = e − c in joint B1; negative values mean that journal and bearing are apart.";
    Figure {
        rows: vec![
            vec![whole("a) Case 3", loose), whole("b) Case 4", both)],
            vec![
                close("a) Case 3, around contact", loose),
                close("b) Case 4, around contact", both),
            ],
        ],
        caption: caption(text, &[loose, both]),
    }
}
