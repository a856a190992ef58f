//! A measure over two parameters of a grid, one rectangle for each point, darker where the measure is larger.

use super::{MeasurePoints, parameter_axis, stride};
use crate::sweep::{Spacing, SweepParameter};
use plot::{Color, Mark, Panel};

/// From the least value to the largest: pale to dark, so that it reads in grey too.
const RAMP: [Color; 3] = [(230, 240, 250), (0, 114, 178), (5, 20, 60)];
/// Values whose colours the legend explains.
const EXPLAINED: usize = 5;
/// Rectangles beside each other; of more levels some are drawn.
pub const MOST: usize = 150;

pub fn panel(
    of: &MeasurePoints,
    first: (&String, &SweepParameter),
    second: (&String, &SweepParameter),
) -> Panel {
    let [x, y] = [first, second].map(parameter_axis);
    let [columns, rows] = [first.1, second.1].map(drawn_levels);
    let across = edges(first.1, &columns);
    let up = edges(second.1, &rows);
    let ends = |edges: &[(f64, f64)]| {
        let low = edges.iter().map(|e| e.0).fold(f64::INFINITY, f64::min);
        (
            low,
            edges.iter().map(|e| e.1).fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let [(left, right), (low, high)] = [ends(&across), ends(&up)];
    let mut panel = of.panel_over(x.over(left, right), y.over(low, high));
    let cells = columns.iter().zip(&across).flat_map(|(column, x)| {
        let cells = rows.iter().zip(&up);
        cells.filter_map(move |(row, y)| Some((of.at(column * second.1.levels() + row)?.0, *x, *y)))
    });
    let cells: Vec<_> = cells.collect();
    let values = cells.iter().map(|cell| cell.0);
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
    for (value, (left, right), (low, high)) in cells {
        let part = if largest > least {
            (value - least) / (largest - least)
        } else {
            0.0
        };
        panel
            .marks
            .push(Mark::cell("", shade(part), (left, low), (right, high)));
    }
    if least.is_finite() {
        for k in 0..EXPLAINED {
            let part = k as f64 / (EXPLAINED - 1) as f64;
            let value = least + part * (largest - least);
            let unit = if of.unit == "1" { "" } else { of.unit };
            let label = match unit {
                "" => numbers::digits(value),
                unit => numbers::si(value, unit),
            };
            panel
                .marks
                .push(Mark::cell(&label, shade(part), (left, low), (left, low)));
        }
    }
    panel
}

/// The colour of a part of the range.
fn shade(part: f64) -> Color {
    let place = (part * 2.0).clamp(0.0, 2.0);
    let k = (place as usize).min(1);
    let (from, to, u) = (RAMP[k], RAMP[k + 1], place - k as f64);
    let mix = |a: u8, b: u8| (f64::from(a) + u * (f64::from(b) - f64::from(a))).round() as u8;
    (mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// The levels that are drawn: all of them unless there are many.
fn drawn_levels(parameter: &SweepParameter) -> Vec<usize> {
    let levels = parameter.levels();
    (0..levels).step_by(stride(levels, MOST)).collect()
}

/// Where the rectangle of each level begins and ends: halfway between neighbours.
fn edges(parameter: &SweepParameter, levels: &[usize]) -> Vec<(f64, f64)> {
    let is_log = parameter.spacing == Spacing::Log;
    let to = |x: f64| if is_log { x.ln() } else { x };
    let from = |x: f64| if is_log { x.exp() } else { x };
    let levels = levels.iter().map(|k| parameter.level(*k).number());
    let levels: Vec<f64> = levels.map(|x| to(x.unwrap_or(f64::NAN))).collect();
    let mut sorted = levels.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let last = sorted.len() - 1;
    let half = |k: usize| match last {
        // one value is left of those that are drawn
        0 => 0.5,
        _ => 0.5 * (sorted[k + 1] - sorted[k]),
    };
    let edge = |x: &f64| {
        let k = sorted.partition_point(|y| y < x);
        let below = half(k.saturating_sub(1));
        let above = half(k.min(last.saturating_sub(1)));
        (from(x - below), from(x + above))
    };
    levels.iter().map(edge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_go_from_pale_to_dark() {
        assert_eq!([0.0, 0.5, 1.0].map(shade), RAMP);
        let grey = |(r, g, b): Color| u32::from(r) + u32::from(g) + u32::from(b);
        let greys: Vec<u32> = (0..=20).map(|k| grey(shade(f64::from(k) / 20.0))).collect();
        assert!(greys.windows(2).all(|pair| pair[1] < pair[0]), "{greys:?}");
    }
}
