//! Sobol indices of a measure, one line for each parameter.

use super::empty;
use crate::sweep::Estimated;
use crate::sweep::merge::IndicesOfMeasure;
use plot::{Axis, Color, Mark, Panel, palette};

/// Radius of a dot \[pixels\].
const DOT: u32 = 10;
/// The dots of a parameter stand so far above and below its line.
const APART: f64 = 0.16;

pub fn panel(name: &str, indices: &IndicesOfMeasure) -> Panel {
    let names = indices
        .parameters
        .keys()
        .map(|name| name.replace('_', " "))
        .collect();
    let x = Axis::new("Share of the variance", "", 1.0);
    let title = format!("Influence on {name}");
    let mut panel = empty(&title, x, Axis::categories(names));
    let mut draw = |label: &str, color: Color, shift: f64, of: Vec<Estimated>| {
        let y: Vec<f64> = (0..of.len()).map(|k| k as f64 + shift).collect();
        let x: Vec<f64> = of.iter().map(|e| e.value).collect();
        for (estimated, y) in of.iter().zip(&y) {
            let ends = [estimated.low, estimated.high];
            panel
                .marks
                .push(Mark::curve("", color, &ends, &[*y, *y]).width(3));
        }
        panel.marks.push(Mark::points(label, color, &x, &y, DOT));
    };
    let first = indices.parameters.values().map(|of| of.first_order);
    draw("alone", palette::BLUE, -APART, first.collect());
    let total = indices.parameters.values().map(|of| of.total);
    draw("takes part", palette::VERMILION, APART, total.collect());
    panel
}
