//! A measure over one parameter of a grid, one curve for each combination of the others.

use super::{MeasurePoints, label, parameter_axis, stride};
use crate::sweep::SweepParameter;
use plot::{Mark, Panel, palette};

/// Radius of a dot \[pixels\].
const DOT: u32 = 7;
/// Points of a curve; of more some are drawn.
pub const MOST: usize = 500;

/// The panel over the parameter with this place.
pub fn panel(of: &MeasurePoints, parameters: &[(&String, &SweepParameter)], place: usize) -> Panel {
    let mut panel = of.panel(parameter_axis(parameters[place]));
    let levels = parameters[place].1.levels();
    // the first parameter varies slowest
    let later: usize = parameters[place + 1..]
        .iter()
        .map(|(_, p)| p.levels())
        .product();
    let curves = of.points.values.len() / levels;
    for (curve, color) in (0..curves).zip(palette::SERIES) {
        let first = curve / later * later * levels + curve % later;
        let drawn = (0..levels).step_by(stride(levels, MOST));
        let points = drawn.map(|level| first + level * later);
        let known = points.filter_map(|point| {
            let (mean, low, high) = of.at(point)?;
            Some((of.abscissa(point, place), mean, low, high))
        });
        let mut known: Vec<(f64, f64, f64, f64)> = known.collect();
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let column = |k: fn(&(f64, f64, f64, f64)) -> f64| known.iter().map(k).collect::<Vec<_>>();
        let (x, mean) = (column(|p| p.0), column(|p| p.1));
        let (low, high) = (column(|p| p.2), column(|p| p.3));
        let others = parameters.iter().enumerate().filter(|(j, _)| *j != place);
        let others = others
            .map(|(j, (name, parameter))| label(name, parameter, &of.points.values[first][j]));
        let label = others.collect::<Vec<_>>().join(", ");
        if low != high {
            panel.marks.push(Mark::band("", color, &x, &low, &high));
        }
        panel.marks.push(Mark::curve("", color, &x, &mean).width(3));
        panel
            .marks
            .push(Mark::points(&label, color, &x, &mean, DOT));
    }
    panel
}
