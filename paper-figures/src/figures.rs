//! What Figs. 5 to 9 have in common, and the list of them.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::{fig05, fig06, fig07, fig08, fig09};
use miette::Result;
use numbers::si;
use plot::{Axis, Color, Figure, palette, save};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::path::Path;

/// File name and content of every figure.
pub fn all(c: &Campaign, numbers: &mut Numbers) -> [(&'static str, Figure); 5] {
    [
        ("fig5", fig05::figure(c, numbers)),
        ("fig6", fig06::figure(c, numbers)),
        ("fig7", fig07::figure(c, numbers)),
        ("fig8", fig08::figure(c, numbers)),
        ("fig9", fig09::figure(c, numbers)),
    ]
}

/// Writes figures, one a core.
///
/// # Errors
/// The first file that cannot be written.
pub fn save_all(figures: &[(&str, Figure)], folder: &Path) -> Result<()> {
    figures
        .par_iter()
        .try_for_each(|(name, figure)| save(figure, folder, name))
}

/// Color of a case where several are in one picture.
pub fn case_color(case: u32) -> Color {
    match case {
        2 => palette::GREEN,
        3 => palette::BLUE,
        _ => palette::VERMILION,
    }
}

/// The axis of the last two cycles.
pub fn time_axis() -> Axis {
    Axis::new("Time t", "s", 1.0).over(FROM, DURATION)
}

/// Legend entry of a recording.
pub fn step_label(recording: &CaseRecording) -> String {
    recording.plan.pace.label()
}

/// A caption: what is seen, then the scenes it was made with, and what every run warns of.
pub fn caption(text: &str, made_with: &[&CaseRecording]) -> String {
    let scenes: BTreeSet<String> = made_with.iter().map(|r| r.plan.scene_name()).collect();
    let scenes: Vec<String> = scenes.into_iter().collect();
    let warned: Vec<String> = made_with
        .iter()
        .filter(|r| !r.warnings.is_empty())
        .map(|r| {
            format!(
                "Run {} (case {}, {}) warns: {}.",
                r.number,
                r.plan.case,
                r.plan.pace.label(),
                r.warnings.join("; ")
            )
        })
        .collect();
    let warned = if warned.is_empty() {
        "No run warns of anything.".to_owned()
    } else {
        warned.join(" ")
    };
    let mut intervals: Vec<f64> = made_with.iter().map(|r| r.plan.interval).collect();
    intervals.sort_by(f64::total_cmp);
    intervals.dedup();
    let rows: Vec<String> = intervals.iter().map(|i| si(*i, "s")).collect();
    let chaotic = match made_with.iter().any(|r| r.plan.case > 2) {
        true => " Cases 3 and 4 are chaotic: each curve is one run of many, and decides nothing.",
        false => "",
    };
    format!(
        "{text} Scenes: {}. Bathe's method with the step h, unless the legend says otherwise; rows every {}.{chaotic} {warned}",
        scenes.join(", "),
        rows.join(" or "),
    )
}
