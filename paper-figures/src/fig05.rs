//! Fig. 5: displacement error of the platform along x. a) case 2, b) case 3, c) case 4.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::figures::{caption, step_label, time_axis};
use crate::measures::bound;
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::signal::peak;
use numbers::{digits, si};
use plot::{Axis, Figure, Mark, Panel, palette};

/// The error the paper reads off its Figs. 5a and 5b \[m\].
pub const CLAIMED: f64 = 2e-4;

/// Draws the figure.
pub fn figure(c: &Campaign, numbers: &mut Numbers) -> Figure {
    let error = |r: &CaseRecording| peak(r.between("error.x", FROM, DURATION).1);
    let mut note = |name: &str, value: f64| {
        numbers.put(format!("fig5.{name}.largest_error_x"), value);
        format!(
            "Largest |eₓ| {}; the ±0.2\u{a0}mm of the paper is {} times that.",
            si(value, "m"),
            digits(CLAIMED / value)
        )
    };
    let axes = |title: &str, note: String, marks: Vec<Mark>| Panel {
        title: title.into(),
        note,
        x: time_axis(),
        y: Axis::new("Displacement error eₓ", "µm", 1e6),
        marks,
    };
    let series = |r: &CaseRecording, color| {
        let (t, e) = r.between("error.x", FROM, DURATION);
        Mark::series(&step_label(r), color, t, e)
    };
    let flexible = vec![
        series(&c.flexible, palette::BLUE),
        series(&c.flexible_coarse, palette::VERMILION),
    ];
    let loose = |r: &CaseRecording| {
        let bound = bound(&c.geometry, r);
        let below: Vec<f64> = bound.iter().map(|b| -b).collect();
        let t = &r.t[r.rows(FROM, DURATION)];
        vec![
            series(r, palette::BLUE),
            Mark::series("kinematic bound", palette::BLACK, t, &bound).width(2),
            Mark::series("", palette::BLACK, t, &below).width(2),
        ]
    };
    let row = vec![
        axes("a) Case 2", note("case2", error(&c.flexible)), flexible),
        axes("b) Case 3", note("case3", error(&c.loose)), loose(&c.loose)),
        axes("c) Case 4", note("case4", error(&c.both)), loose(&c.both)),
    ];
    let text = "Displacement error of the platform along x. The ±0.2 mm of the paper is not drawn: it would flatten the \
                curves. Kinematic bound: sum over the legs of |J⁻¹|ₓᵢ (2 c + penetrations), in case 4 plus the \
                stretch of the links.";
    Figure {
        rows: vec![row],
        caption: caption(text, &[&c.flexible, &c.flexible_coarse, &c.loose, &c.both]),
    }
}
