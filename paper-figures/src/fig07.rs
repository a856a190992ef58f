//! Fig. 7: force in joint B1. a) case 2, where it is the reaction of the ideal joint, b) case 3, c) case 4.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::figures::{caption, step_label, time_axis};
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::signal::{mean, peak};
use numbers::si;
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Draws the figure.
pub fn figure(c: &Campaign, numbers: &mut Numbers) -> Figure {
    let mut panel = |title: &str, name: &str, quantity: &str, shown: &[(&CaseRecording, Color)]| {
        let force = shown[0].0.between("B1.force", FROM, DURATION).1;
        let largest = numbers.put(format!("fig7.{name}.peak_force"), peak(force));
        let average = numbers.put(format!("fig7.{name}.mean_force"), mean(force));
        let series = |&(r, color): &(&CaseRecording, Color)| {
            let (t, f) = r.between("B1.force", FROM, DURATION);
            Mark::series(&step_label(r), color, t, f).width(2)
        };
        Panel {
            title: title.into(),
            note: format!(
                "{quantity}: peak {}, mean {}.",
                si(largest, "N"),
                si(average, "N")
            ),
            x: time_axis(),
            y: Axis::new("Force in joint B1", "N", 1.0),
            marks: shown.iter().map(series).collect(),
        }
    };
    let flexible = [
        (&c.flexible, palette::BLUE),
        (&c.flexible_coarse, palette::VERMILION),
    ];
    let row = vec![
        panel("a) Case 2", "case2", "Reaction", &flexible),
        panel(
            "b) Case 3",
            "case3",
            "Contact force",
            &[(&c.loose, palette::BLUE)],
        ),
        panel(
            "c) Case 4",
            "case4",
            "Contact force",
            &[(&c.both, palette::BLUE)],
        ),
    ];
    let text = "Magnitude of the force in joint B1. Case 2 has no contact: its force is the reaction of the ideal \
                joint. The numbers above the panels belong to the finer step.";
    Figure {
        rows: vec![row],
        caption: caption(text, &[&c.flexible, &c.flexible_coarse, &c.loose, &c.both]),
    }
}
