//! Fig. 8: penetration in joint B1, negative while journal and bearing are apart. a) case 3, b) case 4; below, the
//! same curves enlarged around contact.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::figures::{caption, step_label, time_axis};
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::signal::fraction;
use numbers::{percent, si};
use plot::{Axis, Figure, Mark, Panel, palette};

/// Draws the figure.
pub fn figure(c: &Campaign, numbers: &mut Numbers) -> Figure {
    let mut whole = |title: &str, name: &str, r: &CaseRecording| {
        let (t, delta) = r.between("B1.penetration", FROM, DURATION);
        let deepest = delta.iter().copied().fold(f64::MIN, f64::max);
        let contact = numbers.put(
            format!("fig8.{name}.contact_fraction"),
            fraction(delta, |d| d > 0.0),
        );
        numbers.put(format!("fig8.{name}.largest_penetration"), deepest);
        Panel {
            title: title.into(),
            note: format!(
                "In contact {} of the time, deepest {}.",
                percent(contact),
                si(deepest, "m")
            ),
            x: time_axis(),
            y: Axis::new("Penetration δ in joint B1", "µm", 1e6),
            marks: vec![
                Mark::series(&step_label(r), palette::BLUE, t, delta).width(2),
                Mark::level("contact begins", palette::BLACK, 0.0),
                Mark::level("centred (δ = −c)", palette::GREY, -c.geometry.clearance),
            ],
        }
    };
    let top = vec![
        whole("a) Case 3", "case3", &c.loose),
        whole("b) Case 4", "case4", &c.both),
    ];
    let close = |title: &str, r: &CaseRecording| {
        let (t, delta) = r.between("B1.penetration", FROM, DURATION);
        let deepest = delta.iter().copied().fold(0.0, f64::max);
        let range = if deepest > 0.0 {
            (-0.25 * deepest, 1.05 * deepest)
        } else {
            (-c.geometry.clearance, 0.0)
        };
        Panel {
            title: title.into(),
            note: String::new(),
            x: time_axis(),
            y: Axis::new("Penetration δ in joint B1", "µm", 1e6).over(range.0, range.1),
            marks: vec![
                Mark::series("", palette::BLUE, t, delta).width(2),
                Mark::level("", palette::BLACK, 0.0),
            ],
        }
    };
    let bottom = vec![
        close("a) Case 3, around contact", &c.loose),
        close("b) Case 4, around contact", &c.both),
    ];
    let text = "Penetration δ = e − c in joint B1; negative values mean that journal and bearing are apart.";
    Figure {
        rows: vec![top, bottom],
        caption: caption(text, &[&c.loose, &c.both]),
    }
}
