//! Where everything stands on the page, in pixels.

use crate::ticks::Ticks;
use crate::{Axis, Figure, Mark, Panel, Scale, Shape, text};

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

const MARGIN: i32 = 26;
const TITLE_LINE: i32 = 52;
const GAP: i32 = 14;
const BELOW: i32 = 110;
/// Height of a line of a chart of categories.
const CATEGORY_LINE: i32 = 52;

/// A panel with its axes and the place of its parts.
pub struct PlacedConstraint<'a> {
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
    /// Baseline-centre of the title.
    pub title_y: i32,
    /// Note, broken to the width of the frame.
    pub note: Vec<String>,
    /// First line of the note.
    pub note_y: i32,
    /// Entries of the legend: index of the mark, left edge, vertical centre.
    pub legend: Vec<(usize, i32, i32)>,
}

/// A figure laid out.
pub struct Page<'a> {
    /// Panels in reading order.
    pub panels: Vec<PlacedConstraint<'a>>,
    /// Caption broken to the width of the page.
    pub caption: Vec<String>,
    /// First line of the caption.
    pub caption_y: i32,
    /// Left edge of the caption.
    pub caption_x: i32,
    /// Height of the page.
    pub height: i32,
}

/// Lays a figure out.
pub fn page(figure: &Figure) -> Page<'_> {
    let mut panels = Vec::new();
    let mut top = MARGIN;
    for row in &figure.rows {
        let height = height(row);
        let (columns, width) = columns(figure, row);
        let heads: Vec<Head> = row.iter().map(|panel| Head::new(panel, width)).collect();
        let head = heads.iter().map(Head::height).max().unwrap_or(0);
        for ((panel, parts), (cell_left, left)) in row.iter().zip(heads).zip(columns) {
            let frame = [left, top + head, left + width, top + head + height];
            panels.push(place(panel, parts, frame, cell_left, top));
        }
        top += head + height + BELOW + 2 * GAP;
    }
    let caption = text::wrap(&figure.caption, SMALL, WIDTH - 4 * MARGIN);
    let height = top + SMALL_LINE * caption.len() as i32 + MARGIN;
    Page {
        panels,
        caption,
        caption_y: top + GAP,
        caption_x: 2 * MARGIN,
        height,
    }
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

fn place(
    panel: &Panel,
    head: Head,
    frame: [i32; 4],
    cell_left: i32,
    top: i32,
) -> PlacedConstraint<'_> {
    let note_y = top + TITLE_LINE + SMALL_LINE / 2;
    let legend_top = frame[1] - GAP - LEGEND_LINE * head.legend.len() as i32;
    let legend = head
        .legend
        .iter()
        .enumerate()
        .flat_map(|(line, entries)| {
            let y = legend_top + LEGEND_LINE * line as i32 + LEGEND_LINE / 2;
            entries
                .iter()
                .map(move |&(mark, x)| (mark, frame[0] + x, y))
        })
        .collect();
    let (across, up) = axes(panel, [frame[2] - frame[0], frame[3] - frame[1]]);
    let x = horizontal(panel, &across, frame[2] - frame[0]);
    let y = Ticks::new(&up, extent(panel, &up, false), 6);
    PlacedConstraint {
        panel,
        x,
        y,
        frame,
        cell_left,
        title_y: top + TITLE_LINE / 2,
        note: head.note,
        note_y,
        legend,
    }
}

/// What stands above the frame.
struct Head {
    note: Vec<String>,
    legend: Vec<Vec<(usize, i32)>>,
}

impl Head {
    fn new(panel: &Panel, width: i32) -> Head {
        let mut legend: Vec<Vec<(usize, i32)>> = Vec::new();
        let mut right = 0;
        for (index, mark) in panel
            .marks
            .iter()
            .enumerate()
            .filter(|(_, m)| !m.label.is_empty())
        {
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
    let data = extent(panel, axis, true);
    let mut wanted = 7;
    loop {
        let ticks = Ticks::new(axis, data, wanted);
        let needed: i32 = ticks
            .major
            .iter()
            .map(|(_, t)| text::width(t, SMALL) + 44)
            .sum();
        if needed <= width || wanted == 2 {
            return ticks;
        }
        wanted -= 1;
    }
}

fn left_margin(panel: &Panel) -> i32 {
    let ticks = Ticks::new(&panel.y, extent(panel, &panel.y, false), 6);
    let widest = ticks
        .major
        .iter()
        .map(|(_, t)| text::width(t, SMALL))
        .max()
        .unwrap_or(0);
    match (panel.y.names.is_empty(), panel.x.equal) {
        // no axis label stands on the left of names
        (false, _) => widest + 24,
        // the widened range of equal axes may ask for longer labels
        (true, true) => widest + 85,
        (true, false) => widest + 70,
    }
}

fn right_margin(row: &[Panel]) -> i32 {
    let last = |panel: &Panel| {
        let ticks = Ticks::new(&panel.x, extent(panel, &panel.x, true), 5);
        ticks
            .major
            .last()
            .map_or(0, |(_, t)| text::width(t, SMALL) / 2)
    };
    row.iter().map(last).max().unwrap_or(0) + 10
}

/// Least and greatest datum of one axis over all marks.
fn extent(panel: &Panel, axis: &Axis, horizontal: bool) -> (f64, f64) {
    let usable = |v: &&f64| v.is_finite() && (axis.scale == Scale::Linear || **v > 0.0);
    let over = |values: &[f64]| {
        let fold =
            |f: fn(f64, f64) -> f64, start| values.iter().filter(usable).copied().fold(start, f);
        (
            fold(f64::min, f64::INFINITY),
            fold(f64::max, f64::NEG_INFINITY),
        )
    };
    let of = |mark: &Mark| match &mark.shape {
        Shape::Series { x, y, .. } | Shape::Curve { x, y, .. } | Shape::Points { x, y, .. } => {
            over(if horizontal { x } else { y })
        }
        Shape::Cross { at } => over(&[if horizontal { at.0 } else { at.1 }]),
        Shape::Level { .. } if horizontal => over(&[]),
        Shape::Level { y } => over(&[*y]),
    };
    panel
        .marks
        .iter()
        .map(of)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| {
            (a.0.min(b.0), a.1.max(b.1))
        })
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
