//! A measure against one parameter, a dot for each point with the interval of its mean.

use super::{MeasurePoints, parameter_axis, stride};
use crate::sweep::{SweepParameter, SweepTarget};
use plot::{Mark, Panel, palette};

/// More dots are drawn smaller.
const MANY: usize = 300;
/// Of more points some are drawn.
pub const MOST: usize = 5000;

/// The panel; the value of a target is a dashed line, and the ends of the interval that a bisection has found are marked.
pub fn panel(
    of: &MeasurePoints,
    place: usize,
    parameter: (&String, &SweepParameter),
    target: Option<&SweepTarget>,
    crossing: Option<[f64; 2]>,
) -> Panel {
    let mut panel = of.panel(parameter_axis(parameter));
    let count = of.points.values.len();
    let points = (0..count).step_by(stride(count, MOST));
    let known = points.filter_map(|point| Some((of.abscissa(point, place), of.at(point)?)));
    let known: Vec<(f64, (f64, f64, f64))> = known.collect();
    for (x, (_, low, high)) in known.iter().filter(|(_, (_, low, high))| low < high) {
        let interval = Mark::curve("", palette::SKY, &[*x, *x], &[*low, *high]);
        panel.marks.push(interval.width(3));
    }
    let (x, y): (Vec<f64>, Vec<f64>) = known.iter().map(|(x, (mean, ..))| (*x, *mean)).unzip();
    let radius = if x.len() > MANY { 3 } else { 6 };
    panel
        .marks
        .push(Mark::points("", palette::BLUE, &x, &y, radius));
    if let Some(ends) = crossing {
        let at = |end: &f64| known.iter().find(|(x, _)| x == end);
        let ends: Vec<_> = ends.iter().filter_map(at).collect();
        let x: Vec<f64> = ends.iter().map(|(x, _)| *x).collect();
        let y: Vec<f64> = ends.iter().map(|(_, (mean, ..))| *mean).collect();
        let answer = Mark::points("between these", palette::VERMILION, &x, &y, radius + 2);
        panel.marks.push(answer);
    }
    if let Some(target) = target.filter(|target| target.measure == of.name) {
        panel
            .marks
            .push(Mark::level("target", palette::VERMILION, target.value));
    }
    panel
}
