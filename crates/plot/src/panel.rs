//! Draws one panel.

use crate::canvas::Canvas;
use crate::clip::ClipRectangle;
use crate::decimate::{PixelPoint, envelope, portrait};
use crate::layout::{
    GAP, LABEL, LEGEND_LINE, PlacedPanel, SAMPLE, SMALL, SMALL_LINE, TITLE, TITLE_LINE,
};
use crate::{Color, Mark, MarkShape, palette, text};

const GRID: Color = (228, 228, 228);
/// Space between a place and its name.
const NAME_GAP: i32 = 16;
/// Points a curve may have: 25,000 are 250 kB of SVG.
const CURVE_BUDGET: usize = 25_000;

/// Indices of the points that a line is drawn through; all of another mark.
fn thinned(mark: &Mark, points: &[PixelPoint]) -> Vec<usize> {
    match mark.shape {
        MarkShape::Series { .. } => envelope(points),
        MarkShape::Curve { .. } => portrait(points, CURVE_BUDGET),
        _ => (0..points.len()).collect(),
    }
}

impl PlacedPanel<'_> {
    /// Draws grid, marks, frame, ticks and texts.
    pub fn draw(&self, canvas: &mut Canvas) {
        self.grid(canvas);
        for mark in &self.panel.marks {
            self.mark(canvas, mark);
        }
        self.names(canvas);
        self.axes(canvas);
        self.heading(canvas);
    }

    /// Pixel of a drawing value on the horizontal axis.
    fn across(&self, value: f64) -> f64 {
        let ([left, _, right, _], (low, high)) = (self.frame, self.x.range);
        f64::from(left) + (value - low) / (high - low) * f64::from(right - left)
    }

    /// Pixel of a drawing value on the vertical axis.
    fn up(&self, value: f64) -> f64 {
        let ([_, top, _, bottom], (low, high)) = (self.frame, self.y.range);
        f64::from(bottom) - (value - low) / (high - low) * f64::from(bottom - top)
    }

    fn grid(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = self.frame;
        let across = self.x.major.iter().map(|(value, _)| {
            let x = self.across(*value).round() as i32;
            [(x, top), (x, bottom)]
        });
        let up = self.y.major.iter().map(|(value, _)| {
            let y = self.up(*value).round() as i32;
            [(left, y), (right, y)]
        });
        canvas.lines(&across.chain(up).collect::<Vec<_>>(), GRID, 2);
    }

    fn pixels(&self, mark: &Mark) -> Vec<PixelPoint> {
        let points = mark.x.iter().zip(&mark.y);
        points
            .map(|(x, y)| (self.across(self.x.place(*x)), self.up(self.y.place(*y))))
            .collect()
    }

    /// Indices of the points of a line that make a difference in the drawing; all of another mark.
    pub fn drawn(&self, mark: &Mark) -> Vec<usize> {
        thinned(mark, &self.pixels(mark))
    }

    fn mark(&self, canvas: &mut Canvas, mark: &Mark) {
        let [left, top, right, bottom] = self.frame;
        let frame = ClipRectangle {
            low: (f64::from(left), f64::from(top)),
            high: (f64::from(right), f64::from(bottom)),
        };
        let points = self.pixels(mark);
        let pixel = |p: &PixelPoint| (p.0.round() as i32, p.1.round() as i32);
        let mut polyline = |points: &[PixelPoint], width| {
            let parts = frame.clip(points).into_iter().map(|part| {
                let mut pixels: Vec<(i32, i32)> = part.iter().map(pixel).collect();
                pixels.dedup();
                pixels
            });
            canvas.lines(&parts.collect::<Vec<_>>(), mark.color, width);
        };
        let inside = || {
            let inside = points.iter().filter(|p| frame.contains(**p));
            inside.map(pixel).collect::<Vec<_>>()
        };
        match mark.shape {
            MarkShape::Series { width } | MarkShape::Curve { width } => {
                let kept = thinned(mark, &points).into_iter().map(|i| points[i]);
                polyline(&kept.collect::<Vec<_>>(), width);
            }
            MarkShape::Points { radius } => canvas.dots(&inside(), radius, mark.color),
            MarkShape::Cross => canvas.crosses(&inside(), mark.color),
            MarkShape::Name => {}
            MarkShape::Area { opacity } => {
                let within = |(x, y): (i32, i32)| (x.clamp(left, right), y.clamp(top, bottom));
                let corners = points.iter().map(|point| within(pixel(point)));
                canvas.area(&corners.collect::<Vec<_>>(), mark.color, opacity);
            }
            MarkShape::Level => {
                let y = self.up(self.y.place(mark.y[0])).round() as i32;
                if (top..=bottom).contains(&y) {
                    canvas.dashes(left, right, y, mark.color);
                }
            }
        }
    }

    /// The names beside their places, from the lowest up, each above those that it would overlap.
    fn names(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = self.frame;
        let marks = self.panel.marks.iter();
        let names = marks.filter(|mark| mark.shape == MarkShape::Name);
        let mut names: Vec<(&Mark, PixelPoint)> = names
            .flat_map(|mark| self.pixels(mark).into_iter().map(move |at| (mark, at)))
            .collect();
        names.sort_by(|a, b| b.1.1.total_cmp(&a.1.1));
        let mut placed: Vec<[i32; 3]> = Vec::new();
        for (mark, (x, y)) in names {
            let (x, mut y) = (x.round() as i32, y.round() as i32);
            y = y.clamp(top + SMALL_LINE / 2, bottom - SMALL_LINE / 2);
            let width = text::width(&mark.label, SMALL);
            let from = match x + NAME_GAP + width < right {
                true => x + NAME_GAP,
                false => (x - NAME_GAP - width).max(left),
            };
            for [other, end, at] in &placed {
                if *other < from + width && from < *end && (y - at).abs() < SMALL_LINE {
                    y = at - SMALL_LINE;
                }
            }
            placed.push([from, from + width, y]);
            canvas.name(&mark.label, (from, y), SMALL, "start", mark.color);
        }
    }

    fn axes(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = self.frame;
        let ink = palette::BLACK;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        canvas.line(&[&corners[..], &corners[..1]].concat(), ink, 2);
        let across = |value: f64| self.across(value).round() as i32;
        let up = |value: f64| self.up(value).round() as i32;
        let upright =
            |value: f64, length| [(across(value), bottom), (across(value), bottom - length)];
        let level = |value: f64, length| [(left, up(value)), (left + length, up(value))];
        let major = self.x.major.iter().map(|(value, _)| upright(*value, 11));
        let major = major.chain(self.y.major.iter().map(|(value, _)| level(*value, 11)));
        canvas.lines(&major.collect::<Vec<_>>(), ink, 2);
        let minor = self.x.minor.iter().map(|value| upright(*value, 6));
        let minor = minor.chain(self.y.minor.iter().map(|value| level(*value, 6)));
        canvas.lines(&minor.collect::<Vec<_>>(), ink, 1);
        for (value, label) in &self.x.major {
            canvas.text(label, (across(*value), bottom + 28), SMALL, "middle");
        }
        for (value, label) in &self.y.major {
            canvas.text(label, (left - 12, up(*value)), SMALL, "end");
        }
        let middle = ((left + right) / 2, (top + bottom) / 2);
        canvas.text(&self.x.label, (middle.0, bottom + 76), LABEL, "middle");
        canvas.upright(&self.y.label, (self.cell_left + 20, middle.1), LABEL);
    }

    fn heading(&self, canvas: &mut Canvas) {
        let [left, top, ..] = self.frame;
        let title = (left, self.top + TITLE_LINE / 2);
        canvas.bold(&self.panel.title, title, TITLE);
        let note = (left, self.top + TITLE_LINE + SMALL_LINE / 2);
        canvas.small_lines(&self.head.note, note);
        let legend = &self.head.legend;
        let mut y = top - GAP - LEGEND_LINE * legend.len() as i32 + LEGEND_LINE / 2;
        for line in legend {
            for &(index, from) in line {
                self.sample(canvas, &self.panel.marks[index], (left + from, y));
            }
            y += LEGEND_LINE;
        }
    }

    /// An entry of the legend.
    fn sample(&self, canvas: &mut Canvas, mark: &Mark, (x, y): (i32, i32)) {
        let middle = (x + SAMPLE / 2, y);
        match mark.shape {
            MarkShape::Series { .. } | MarkShape::Curve { .. } => {
                canvas.line(&[(x, y), (x + SAMPLE, y)], mark.color, 6);
            }
            MarkShape::Level => canvas.dashes(x, x + SAMPLE, y, mark.color),
            MarkShape::Cross => canvas.crosses(&[middle], mark.color),
            MarkShape::Area { opacity } => {
                let (low, high) = (y - 12, y + 12);
                let corners = [(x, low), (x + SAMPLE, low), (x + SAMPLE, high), (x, high)];
                canvas.area(&corners, mark.color, opacity);
            }
            MarkShape::Points { radius } => canvas.dots(&[middle], radius.max(6), mark.color),
            MarkShape::Name => {}
        }
        canvas.text(&mark.label, (x + SAMPLE + 12, y), SMALL, "start");
    }
}
