//! Figs. 5 to 9, and what they have in common.

mod fig05;
mod fig06;
mod fig07;
mod fig08;
mod fig09;

pub use fig09::{section, spread};

use crate::figures::FigureRuns;
use crate::runs::{CaseRecording, DURATION, FROM};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use std::collections::BTreeSet;

/// The error that the paper reads off its Figs. 5a and 5b \[m\].
pub const CLAIMED: f64 = 2e-4;

/// Name and content of every figure.
pub fn all(runs: &FigureRuns) -> Vec<(String, Figure)> {
    let figures = [
        ("fig5", fig05::figure(runs)),
        ("fig6", fig06::figure(runs)),
        ("fig7", fig07::figure(runs)),
        ("fig8", fig08::figure(runs)),
        ("fig9", fig09::figure(runs)),
    ];
    let thinned = |(name, figure): (&str, Figure)| (name.to_owned(), figure.thinned());
    figures.map(thinned).into()
}

/// A panel over the last two cycles.
fn over_time(title: &str, y: Axis, marks: Vec<Mark>) -> Panel {
    Panel {
        title: title.into(),
        note: String::new(),
        x: Axis::new("Time t", "s", 1.0).over(FROM, DURATION),
        y,
        marks,
    }
}

/// Both steps of case 2, the finer first.
fn flexible(runs: &FigureRuns) -> [(&CaseRecording, Color); 2] {
    let colors = [("flexible", palette::BLUE), ("coarse", palette::VERMILION)];
    colors.map(|(name, color)| (runs.get(name), color))
}

/// A channel over the last two cycles.
fn curve((run, color): (&CaseRecording, Color), channel: &str) -> Mark {
    let (t, y) = run.between(channel, FROM, DURATION);
    Mark::series(&run.plan.pace.label(), color, t, y).width(2)
}

/// A channel of case 2 with both steps, of case 3 and of case 4, and what is drawn beside the first run.
fn of_cases(
    runs: &FigureRuns,
    (channel, axis): (&str, Axis),
    beside: impl Fn(&CaseRecording, Vec<Mark>) -> Vec<Mark>,
    text: &str,
) -> Figure {
    let panel = |title: &str, shown: &[(&CaseRecording, Color)]| {
        let curves = shown.iter().map(|run| curve(*run, channel)).collect();
        over_time(title, axis.clone(), beside(shown[0].0, curves))
    };
    let row = vec![
        panel("a) Case 2", &flexible(runs)),
        panel("b) Case 3", &[(runs.get("loose"), palette::BLUE)]),
        panel("c) Case 4", &[(runs.get("both"), palette::BLUE)]),
    ];
    let made_with = ["flexible", "coarse", "loose", "both"].map(|name| runs.get(name));
    Figure {
        rows: vec![row],
        caption: caption(text, &made_with),
    }
}

/// A caption: what is seen, then the scenes it was made with, and what every run warns of.
fn caption(text: &str, made_with: &[&CaseRecording]) -> String {
    let scenes: BTreeSet<String> = made_with.iter().map(|r| r.plan.scene_name()).collect();
    let scenes = Vec::from_iter(scenes).join(", ");
    let warn = made_with.iter().filter(|r| !r.warnings.is_empty());
    let warnings = warn.map(|r| {
        let (case, pace) = (r.plan.case, r.plan.pace.label());
        format!(" Case {case} ({pace}) warns: {}.", r.warnings.join("; "))
    });
    let warnings: String = warnings.collect();
    format!(
        "{text} Scenes: {scenes}. Bathe's method with the step h, unless the legend says otherwise. Cases 3 and 4 are chaotic: \
         each curve is one run of many, and decides nothing.{warnings}"
    )
}
