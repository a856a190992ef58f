//! Fig. 6: acceleration of the platform along x. a) case 2, b) case 3, c) case 4, each over that of case 1.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::figures::{caption, step_label, time_axis};
use crate::measures::deviation;
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::signal::{peak, rms};
use numbers::digits;
use plot::{Axis, Figure, Mark, Panel, palette};

/// Draws the figure.
pub fn figure(c: &Campaign, numbers: &mut Numbers) -> Figure {
    let (t, a) = c.ideal.between("platform.ax", FROM, DURATION);
    let mut panel = |title: &str, name: &str, shown: &[(&CaseRecording, plot::Color)]| {
        let first = shown[0].0;
        let largest = numbers.put(
            format!("fig6.{name}.peak"),
            peak(first.between("platform.ax", FROM, DURATION).1),
        );
        let deviation = numbers.put(
            format!("fig6.{name}.rms_deviation"),
            rms(&deviation(&c.geometry, first, FROM, DURATION)),
        );
        let mut marks = vec![Mark::series("case 1 (ideal)", palette::GREY, t, a).width(4)];
        for &(recording, color) in shown {
            let (t, a) = recording.between("platform.ax", FROM, DURATION);
            marks.push(Mark::series(&step_label(recording), color, t, a).width(2));
        }
        // the ideal line is drawn again where a dense curve would hide it
        marks.push(Mark::series("", palette::GREY, t, a).width(2));
        let note = format!(
            "Peak {}\u{a0}m/s², rms deviation from case 1 {}\u{a0}m/s².",
            digits(largest),
            digits(deviation)
        );
        let y = Axis::new("Acceleration ẍ of platform", "m/s²", 1.0);
        Panel {
            title: title.into(),
            note,
            x: time_axis(),
            y,
            marks,
        }
    };
    let row = vec![
        panel(
            "a) Case 2",
            "case2",
            &[
                (&c.flexible, palette::BLUE),
                (&c.flexible_coarse, palette::VERMILION),
            ],
        ),
        panel("b) Case 3", "case3", &[(&c.loose, palette::BLUE)]),
        panel("c) Case 4", "case4", &[(&c.both, palette::BLUE)]),
    ];
    let text = "Acceleration of the platform along x, from the acceleration-level equations at the accepted states. \
                The numbers above the panels belong to the finer step.";
    Figure {
        rows: vec![row],
        caption: caption(
            text,
            &[&c.ideal, &c.flexible, &c.flexible_coarse, &c.loose, &c.both],
        ),
    }
}
