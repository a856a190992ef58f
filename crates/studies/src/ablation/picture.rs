//! The picture of an ablation: error, joint force and processor time of every variant, one dot each.

use super::variants::VariantRole;
use super::{Ablation, AblationRow, VariantOutcome};
use numbers::digits;
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Values this much smaller than the largest are rounding; a dot for them would press all others into a corner.
const ROUNDING: f64 = 1e-6;
/// An axis reaches beyond its last dot by this factor.
const MARGIN: f64 = 1.4;
/// An axis is a decade long at least, so that it has more than one label.
const HALF_A_DECADE: f64 = 3.17;
/// Radius of a dot \[pixels\].
const DOT: u32 = 11;

/// One panel: its title, what is on its axis, the unit, the quantity.
type AblationPanel = (
    &'static str,
    &'static str,
    &'static str,
    fn(&VariantOutcome) -> Option<f64>,
);

const SHOWN: [AblationPanel; 3] = [
    ("Error", "RMS displacement error", "m", |o| {
        o.physics.rms_error
    }),
    ("Force", "Peak joint force", "N", |o| {
        o.physics.peak_joint_force
    }),
    ("CPU time", "CPU time per simulated time", "", |o| {
        Some(o.cost.cpu_seconds_a_simulated_second)
    }),
];

/// The figure.
pub fn figure(ablation: &Ablation) -> Figure {
    let mut left_out = Vec::new();
    let present = |(_, _, _, quantity): &&AblationPanel| {
        let outcomes = ablation.rows.iter().flat_map(|row| &row.outcome);
        outcomes.filter_map(quantity).any(|value| value > 0.0)
    };
    // processor time is drawn even where nothing runs, so that there is a picture
    let (last, others) = SHOWN.split_last().expect("there are three");
    let panels = others.iter().filter(present).chain([last]);
    let panels = panels.enumerate();
    let panels = panels.map(|(k, shown)| panel(ablation, shown, k, &mut left_out));
    Figure {
        rows: vec![panels.collect()],
        caption: caption(ablation, &left_out),
    }
}

/// Panel `place` of the row, the first with the names of the variants; values that are rounding are written down instead.
fn panel(
    ablation: &Ablation,
    (title, label, unit, quantity): &AblationPanel,
    place: usize,
    left_out: &mut Vec<String>,
) -> Panel {
    let value = |outcome: &VariantOutcome| quantity(outcome).filter(|v| *v > 0.0);
    let of_row = |row: &AblationRow| row.outcome.as_ref().ok().and_then(value);
    let values: Vec<Option<f64>> = ablation.rows.iter().map(of_row).collect();
    let largest = values.iter().flatten().copied().fold(0.0, f64::max);
    let drawn = |v: &f64| *v > ROUNDING * largest;
    let range = values.iter().flatten().copied().filter(drawn);
    let range = range.fold((f64::INFINITY, 0.0_f64), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    let mut marks = Vec::new();
    if let Some(full) = ablation.outcome(VariantRole::Full).and_then(value) {
        let ends = [-0.5, ablation.rows.len() as f64 - 0.5];
        marks.push(Mark::curve("", palette::GREY, &[full, full], &ends));
    }
    let mut names = Vec::new();
    for (k, (row, value)) in ablation.rows.iter().zip(values).enumerate() {
        let name = row.variant.short_name();
        match value {
            Some(value) if drawn(&value) => {
                let color = color(row.variant.role);
                marks.push(Mark::points("", color, &[value], &[k as f64], DOT));
            }
            Some(value) => left_out.push(format!("{name}, {} {unit}", digits(value))),
            None => {}
        }
        names.push(if place == 0 { name } else { String::new() });
    }
    let axis = Axis::new(label, unit, 1.0).log();
    Panel {
        title: format!("{}) {title}", ["a", "b", "c"][place]),
        note: String::new(),
        x: match range {
            (low, high) if low <= high => {
                let (middle, half) = ((low * high).sqrt(), MARGIN * (high / low).sqrt());
                let half = half.max(HALF_A_DECADE);
                axis.over(middle / half, middle * half)
            }
            _ => axis,
        },
        y: Axis::categories(names),
        marks,
    }
}

fn color(role: VariantRole) -> Color {
    match role {
        VariantRole::Ideal | VariantRole::Full => palette::BLACK,
        VariantRole::Added(_) => palette::BLUE,
        VariantRole::Removed(_) => palette::VERMILION,
    }
}

fn caption(ablation: &Ablation, left_out: &[String]) -> String {
    let about = ablation.about().join(" ");
    let mut caption = format!(
        "{}. Blue: one effect added to the rigid ideal mechanism, with the one it needs; red: one removed from the full scene, \
         with those that need it; vertical lines: the full scene. {about} CPU times are those of one machine.",
        ablation.header.title,
    );
    let failed = ablation.rows.iter().filter(|row| row.outcome.is_err());
    let failed: Vec<String> = failed.map(|row| row.variant.short_name()).collect();
    for (what, names) in [("Rounding, not drawn", left_out), ("Not run", &failed)] {
        if !names.is_empty() {
            caption += &format!(" {what}: {}.", names.join("; "));
        }
    }
    caption
}
