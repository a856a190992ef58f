//! Where everything stands on the page, in pixels.

use crate::ticks::Ticks;
use crate::{Axis, Figure, Mark, MarkShape, Panel, Scale, text};

/// Width of every figure: 178 mm at 300 dpi.
pub const WIDTH: i32 = 2100;
/// Font size of titles.
pub const TITLE: u32 = 34;
/// Font size of axis labels and legends.
pub const LABEL: u32 = 30;
/// Font size of ticks, notes and the caption.
pub const SMALL: u32 = 27;
/// Length of the sample line of a legend entry.
pub const SAMPLE: i32 = 46;
/// Height of a line of the legend.
pub const LEGEND_LINE: i32 = 40;
/// Height of a line of small text.
pub const SMALL_LINE: i32 = 36;

/// Height of a line of titles.
pub const TITLE_LINE: i32 = 52;
/// Space between parts.
pub const GAP: i32 = 14;
/// Space at the edges of the page.
pub const MARGIN: i32 = 26;

const BELOW: i32 = 110;
/// Height of a line of a chart of categories.
const CATEGORY_LINE: i32 = 52;

/// A panel with its axes and the place of its parts.
pub struct PlacedPanel<'a> {
    /// The panel.
    pub panel: &'a Panel,
    /// Horizontal axis.
    pub x: Ticks,
    /// Vertical axis.
    pub y: Ticks,
    /// Frame: left, top, right, bottom.
    pub frame: [i32; 4],
    /// Left edge of the cell.
    pub cell_left: i32,
    /// Upper edge of the cell.
    pub top: i32,
    /// What stands above the frame.
    pub head: Head,
}

/// Panels in reading order, and the lower edge of the last row.
pub fn place(figure: &Figure) -> (Vec<PlacedPanel<'_>>, i32) {
    let mut panels = Vec::new();
    let mut top = MARGIN;
    for row in &figure.rows {
        let height = height(row);
        let (columns, width) = columns(figure, row);
        let heads: Vec<Head> = row.iter().map(|panel| Head::new(panel, width)).collect();
        let upper = top + heads.iter().map(Head::height).max().unwrap_or(0);
        for ((panel, head), (cell_left, left)) in row.iter().zip(heads).zip(columns) {
            let (across, up) = axes(panel, [width, height]);
            panels.push(PlacedPanel {
                panel,
                x: horizontal(panel, &across, width),
                y: Ticks::new(&up, extent(panel, &up, false), 6),
                frame: [left, upper, left + width, upper + height],
                cell_left,
                top,
                head,
            });
        }
        top = upper + height + BELOW + 2 * GAP;
    }
    (panels, top)
}

/// Height of the frames of a row.
fn height(row: &[Panel]) -> i32 {
    let categories = row.iter().map(|panel| panel.y.names.len()).max();
    match (categories.unwrap_or(0) as i32, row.len()) {
        (0, 1) => 620,
        (0, 2) => 560,
        (0, 3) => 500,
        (0, _) => 400,
        (categories, _) => CATEGORY_LINE * categories,
    }
}

/// Left edges of the cell and of the frame of every panel of a row, and the width of its frames.
///
/// Frames stand below those of other rows of as many panels. In a row with categories each has the margin that its names
/// need, because they may stand on the left of the row alone.
fn columns(figure: &Figure, row: &[Panel]) -> (Vec<(i32, i32)>, i32) {
    let count = row.len() as i32;
    let (page, right) = (WIDTH - 2 * MARGIN, right_margin(row));
    if row.iter().any(|panel| !panel.y.names.is_empty()) {
        let margins: Vec<i32> = row.iter().map(left_margin).collect();
        let width = (page - margins.iter().sum::<i32>()) / count - right;
        let edges = margins.iter().scan(MARGIN, |cell, margin| {
            let edge = (*cell, *cell + margin);
            *cell = edge.1 + width + right;
            Some(edge)
        });
        return (edges.collect(), width);
    }
    let cell = page / count;
    let rows = figure.rows.iter().filter(|r| r.len() == row.len());
    let left = rows.flatten().map(left_margin).max().unwrap_or(0);
    let edge = |column| (MARGIN + column * cell, MARGIN + column * cell + left);
    ((0..count).map(edge).collect(), cell - left - right)
}

/// What stands above the frame.
pub struct Head {
    /// Note, broken to the width of the frame.
    pub note: Vec<String>,
    /// Lines of the legend: indices of marks, and where their entries begin.
    pub legend: Vec<Vec<(usize, i32)>>,
}

impl Head {
    fn new(panel: &Panel, width: i32) -> Head {
        let mut legend: Vec<Vec<(usize, i32)>> = Vec::new();
        let mut right = 0;
        let marks = panel.marks.iter().enumerate();
        let entry = |mark: &Mark| !mark.label.is_empty() && mark.shape != MarkShape::Name;
        for (index, mark) in marks.filter(|(_, mark)| entry(mark)) {
            let needed = SAMPLE + 12 + text::width(&mark.label, SMALL);
            match legend.last_mut() {
                Some(line) if right + 30 + needed <= width => {
                    line.push((index, right + 30));
                    right += 30 + needed;
                }
                _ => {
                    legend.push(vec![(index, 0)]);
                    right = needed;
                }
            }
        }
        Head {
            note: text::wrap(&panel.note, SMALL, width),
            legend,
        }
    }

    fn height(&self) -> i32 {
        TITLE_LINE
            + SMALL_LINE * self.note.len() as i32
            + LEGEND_LINE * self.legend.len() as i32
            + GAP
    }
}

/// The axes of a panel with a frame of this width and height in pixels; equal ones get their ranges here.
fn axes(panel: &Panel, size: [i32; 2]) -> (Axis, Axis) {
    let (x, y) = (panel.x.clone(), panel.y.clone());
    if !x.equal {
        return (x, y);
    }
    let ranges = [extent(panel, &x, true), extent(panel, &y, false)];
    // data per pixel of the tighter axis, with a margin of 8 % on both sides
    let scale = (0..2)
        .map(|i| (ranges[i].1 - ranges[i].0) / (0.84 * f64::from(size[i])))
        .filter(|scale| scale.is_finite())
        .fold(f64::MIN_POSITIVE, f64::max);
    let widened = |i: usize| {
        let middle = 0.5 * (ranges[i].0 + ranges[i].1);
        let half = 0.5 * scale * f64::from(size[i]);
        (middle - half, middle + half)
    };
    let [(left, right), (low, high)] = [widened(0), widened(1)];
    (x.over(left, right), y.over(low, high))
}

/// As many labels as fit with a clear gap between them.
fn horizontal(panel: &Panel, axis: &Axis, width: i32) -> Ticks {
    let ticks = |wanted| Ticks::new(axis, extent(panel, axis, true), wanted);
    let fits = |ticks: &Ticks| ticks.widths().map(|label| label + 44).sum::<i32>() <= width;
    let most = (3..=7).rev().map(ticks).find(fits);
    most.unwrap_or_else(|| ticks(2))
}

fn left_margin(panel: &Panel) -> i32 {
    let ticks = Ticks::new(&panel.y, extent(panel, &panel.y, false), 6);
    let widest = ticks.widths().max().unwrap_or(0);
    match (panel.y.names.is_empty(), panel.x.equal) {
        (false, _) if panel.y.label.is_empty() => widest + 24,
        (false, _) => widest + 70,
        // the widened range of equal axes may ask for longer labels
        (true, true) => widest + 85,
        (true, false) => widest + 70,
    }
}

fn right_margin(row: &[Panel]) -> i32 {
    let last = |panel: &Panel| {
        let ticks = Ticks::new(&panel.x, extent(panel, &panel.x, true), 5);
        ticks.widths().last().unwrap_or(0) / 2
    };
    row.iter().map(last).max().unwrap_or(0) + 10
}

/// Least and greatest datum of one axis over all marks.
fn extent(panel: &Panel, axis: &Axis, horizontal: bool) -> (f64, f64) {
    let marks = panel.marks.iter();
    let values = marks.flat_map(|mark| if horizontal { &mark.x } else { &mark.y });
    let usable = |v: &&f64| v.is_finite() && (axis.scale == Scale::Linear || **v > 0.0);
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let values = values.filter(usable);
    values.fold(none, |(low, high), v| (low.min(*v), high.max(*v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_axes_have_one_scale_and_hold_all_data() {
        for (x, y) in [([0.0, 1.0], [0.0, 5.0]), ([0.0, 9.0], [2.0, 2.0])] {
            let panel = Panel {
                title: String::new(),
                note: String::new(),
                x: Axis::new("x", "m", 1.0).equal(),
                y: Axis::new("y", "m", 1.0),
                marks: vec![Mark::curve("", (0, 0, 0), &x, &y)],
            };
            let (across, up) = axes(&panel, [800, 500]);
            let [(left, right), (low, high)] = [across.range.unwrap(), up.range.unwrap()];
            // rounding of a quotient
            assert!(((right - left) / 800.0 - (high - low) / 500.0).abs() < 1e-12);
            assert!(left < x[0] && x[1] < right && low < y[0] && y[1] < high);
        }
    }
}
