//! Draws one panel.

use crate::canvas::Canvas;
use crate::clip::ClipRectangle;
use crate::decimate::{PixelPoint, envelope, portrait};
use crate::layout::{
    GAP, LABEL, LEGEND_LINE, PlacedPanel, SAMPLE, SMALL, SMALL_LINE, TITLE, TITLE_LINE,
};
use crate::{Color, Mark, MarkShape, palette};

const GRID: Color = (228, 228, 228);
/// Points a curve may have: 25,000 are 250 kB of SVG.
const CURVE_BUDGET: usize = 25_000;

impl PlacedPanel<'_> {
    /// Draws grid, marks, frame, ticks and texts.
    pub fn draw(&self, canvas: &mut Canvas) {
        self.grid(canvas);
        for mark in &self.panel.marks {
            self.mark(canvas, mark);
        }
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
        for (value, _) in &self.x.major {
            let x = self.across(*value).round() as i32;
            canvas.line(&[(x, top), (x, bottom)], GRID, 2);
        }
        for (value, _) in &self.y.major {
            let y = self.up(*value).round() as i32;
            canvas.line(&[(left, y), (right, y)], GRID, 2);
        }
    }

    fn mark(&self, canvas: &mut Canvas, mark: &Mark) {
        let [left, top, right, bottom] = self.frame;
        let frame = ClipRectangle {
            low: (f64::from(left), f64::from(top)),
            high: (f64::from(right), f64::from(bottom)),
        };
        let points = mark.x.iter().zip(&mark.y);
        let points =
            points.map(|(x, y)| (self.across(self.x.place(*x)), self.up(self.y.place(*y))));
        let points: Vec<PixelPoint> = points.collect();
        let pixel = |p: &PixelPoint| (p.0.round() as i32, p.1.round() as i32);
        let mut polyline = |points: &[PixelPoint], width| {
            for part in frame.clip(points) {
                let mut pixels: Vec<(i32, i32)> = part.iter().map(pixel).collect();
                pixels.dedup();
                canvas.line(&pixels, mark.color, width);
            }
        };
        let inside = points.iter().filter(|p| frame.contains(**p)).map(pixel);
        match mark.shape {
            MarkShape::Series { width } => polyline(&envelope(&points), width),
            MarkShape::Curve { width } => polyline(&portrait(&points, CURVE_BUDGET), width),
            MarkShape::Points { radius } => {
                inside.for_each(|at| canvas.dot(at, radius, mark.color))
            }
            MarkShape::Cross => inside.for_each(|at| canvas.cross(at, mark.color)),
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

    fn axes(&self, canvas: &mut Canvas) {
        let [left, top, right, bottom] = self.frame;
        let ink = palette::BLACK;
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        canvas.line(&[&corners[..], &corners[..1]].concat(), ink, 2);
        for (value, label) in &self.x.major {
            let x = self.across(*value).round() as i32;
            canvas.line(&[(x, bottom), (x, bottom - 11)], ink, 2);
            canvas.text(label, (x, bottom + 28), SMALL, "middle");
        }
        for (value, label) in &self.y.major {
            let y = self.up(*value).round() as i32;
            canvas.line(&[(left, y), (left + 11, y)], ink, 2);
            canvas.text(label, (left - 12, y), SMALL, "end");
        }
        for value in &self.x.minor {
            let x = self.across(*value).round() as i32;
            canvas.line(&[(x, bottom), (x, bottom - 6)], ink, 1);
        }
        for value in &self.y.minor {
            let y = self.up(*value).round() as i32;
            canvas.line(&[(left, y), (left + 6, y)], ink, 1);
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
            MarkShape::Cross => canvas.cross(middle, mark.color),
            MarkShape::Area { opacity } => {
                let (low, high) = (y - 12, y + 12);
                let corners = [(x, low), (x + SAMPLE, low), (x + SAMPLE, high), (x, high)];
                canvas.area(&corners, mark.color, opacity);
            }
            MarkShape::Points { radius } => canvas.dot(middle, radius.max(6), mark.color),
        }
        canvas.text(&mark.label, (x + SAMPLE + 12, y), SMALL, "start");
    }
}
