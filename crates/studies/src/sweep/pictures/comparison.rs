//! A measure over words, such as the names of contact laws: one line for each combination of them.

use super::{MeasurePoints, axis, label};
use crate::sweep::SweepParameter;
use plot::{Axis, Mark, Panel, palette};

/// Radius of a dot \[pixels\].
const DOT: u32 = 8;
/// Lines of a panel.
pub const MOST: usize = 24;

pub fn panel(of: &MeasurePoints, parameters: &[(&String, &SweepParameter)]) -> Panel {
    let points = &of.points.values;
    let names = points.iter().map(|values| {
        let labels = parameters.iter().zip(values);
        let labels = labels.map(|((name, parameter), value)| label(name, parameter, value));
        labels.collect::<Vec<_>>().join(", ")
    });
    let names = Axis::categories(names.collect());
    let mut panel = of.panel_over(axis(of.name, of.unit), names);
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for point in 0..points.len() {
        let Some((mean, low, high)) = of.at(point) else {
            continue;
        };
        let line = point as f64;
        if low < high {
            let interval = Mark::curve("", palette::SKY, &[low, high], &[line, line]);
            panel.marks.push(interval.width(3));
        }
        x.push(mean);
        y.push(line);
    }
    panel
        .marks
        .push(Mark::points("", palette::BLUE, &x, &y, DOT));
    panel
}
