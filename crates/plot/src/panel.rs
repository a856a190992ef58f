//! Draws one panel with plotters.

use crate::clip::Frame;
use crate::decimate::{Point, envelope, portrait};
use crate::label::Label;
use crate::layout::{LABEL, PlacedConstraint, SAMPLE, SMALL, SMALL_LINE, TITLE};
use crate::ticks::Ticks;
use crate::{Color, Mark, Shape, palette};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::Color as _;
use plotters::style::text_anchor::HPos;

/// The page being drawn.
pub type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// What drawing can fail with.
pub type DrawError<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

const GRID: Color = (228, 228, 228);
/// Points a curve may have: 25,000 are 250 kB of SVG.
const CURVE_BUDGET: usize = 25_000;

/// Draws a panel: grid, marks, frame, ticks, texts.
pub fn draw<'a>(canvas: &Canvas<'a>, placed: &PlacedConstraint) -> Result<(), DrawError<'a>> {
    let scales = Scales::new(placed);
    grid(canvas, placed, &scales)?;
    for mark in &placed.panel.marks {
        draw_mark(canvas, mark, &scales)?;
    }
    axes(canvas, placed, &scales)?;
    heading(canvas, placed)
}

/// From data to pixels.
struct Scales<'p> {
    x: &'p Ticks,
    y: &'p Ticks,
    frame: [i32; 4],
}

impl<'p> Scales<'p> {
    fn new(placed: &'p PlacedConstraint) -> Scales<'p> {
        Scales {
            x: &placed.x,
            y: &placed.y,
            frame: placed.frame,
        }
    }

    /// Pixel of a drawing value on the horizontal axis.
    fn across(&self, value: f64) -> f64 {
        let (low, high) = self.x.range;
        f64::from(self.frame[0])
            + (value - low) / (high - low) * f64::from(self.frame[2] - self.frame[0])
    }

    /// Pixel of a drawing value on the vertical axis.
    fn up(&self, value: f64) -> f64 {
        let (low, high) = self.y.range;
        f64::from(self.frame[3])
            - (value - low) / (high - low) * f64::from(self.frame[3] - self.frame[1])
    }

    fn points(&self, x: &[f64], y: &[f64]) -> Vec<Point> {
        x.iter()
            .zip(y)
            .map(|(&x, &y)| (self.across(self.x.place(x)), self.up(self.y.place(y))))
            .collect()
    }

    fn clip(&self) -> Frame {
        let [left, top, right, bottom] = self.frame.map(f64::from);
        Frame {
            low: (left, top),
            high: (right, bottom),
        }
    }
}

/// The colour as plotters knows it.
pub fn rgb((r, g, b): Color) -> RGBColor {
    RGBColor(r, g, b)
}

fn line<'a>(
    canvas: &Canvas<'a>,
    points: Vec<(i32, i32)>,
    color: Color,
    width: u32,
) -> Result<(), DrawError<'a>> {
    canvas.draw(&PathElement::new(points, rgb(color).stroke_width(width)))
}

fn dashes<'a>(
    canvas: &Canvas<'a>,
    from: i32,
    to: i32,
    y: i32,
    color: Color,
) -> Result<(), DrawError<'a>> {
    (from..to)
        .step_by(24)
        .try_for_each(|x| line(canvas, vec![(x, y), ((x + 14).min(to), y)], color, 3))
}

fn grid<'a>(
    canvas: &Canvas<'a>,
    placed: &PlacedConstraint,
    scales: &Scales,
) -> Result<(), DrawError<'a>> {
    let [left, top, right, bottom] = placed.frame;
    for (value, _) in &placed.x.major {
        let x = scales.across(*value).round() as i32;
        line(canvas, vec![(x, top), (x, bottom)], GRID, 2)?;
    }
    for (value, _) in &placed.y.major {
        let y = scales.up(*value).round() as i32;
        line(canvas, vec![(left, y), (right, y)], GRID, 2)?;
    }
    Ok(())
}

fn draw_mark<'a>(canvas: &Canvas<'a>, mark: &Mark, scales: &Scales) -> Result<(), DrawError<'a>> {
    let polyline = |points: Vec<Point>, width: u32| {
        scales
            .clip()
            .clip(&points)
            .into_iter()
            .try_for_each(|part| {
                let mut pixels: Vec<(i32, i32)> = part
                    .iter()
                    .map(|p| (p.0.round() as i32, p.1.round() as i32))
                    .collect();
                pixels.dedup();
                line(canvas, pixels, mark.color, width)
            })
    };
    match &mark.shape {
        Shape::Series { x, y, width } => polyline(envelope(&scales.points(x, y)), *width),
        Shape::Curve { x, y, width } => {
            polyline(portrait(&scales.points(x, y), CURVE_BUDGET), *width)
        }
        Shape::Points { x, y, radius } => scales
            .points(x, y)
            .into_iter()
            .filter(|&p| scales.clip().contains(p))
            .try_for_each(|p| {
                let at = (p.0.round() as i32, p.1.round() as i32);
                canvas.draw(&Circle::new(at, *radius, rgb(mark.color).filled()))
            }),
        Shape::Cross { at } => {
            let p = scales.points(&[at.0], &[at.1])[0];
            if !scales.clip().contains(p) {
                return Ok(());
            }
            cross(canvas, (p.0.round() as i32, p.1.round() as i32), mark.color)
        }
        Shape::Level { y } => {
            let y = scales.up(scales.y.place(*y)).round() as i32;
            if y < scales.frame[1] || y > scales.frame[3] {
                return Ok(());
            }
            dashes(canvas, scales.frame[0], scales.frame[2], y, mark.color)
        }
    }
}

fn cross<'a>(canvas: &Canvas<'a>, (x, y): (i32, i32), color: Color) -> Result<(), DrawError<'a>> {
    line(canvas, vec![(x - 12, y - 12), (x + 12, y + 12)], color, 4)?;
    line(canvas, vec![(x - 12, y + 12), (x + 12, y - 12)], color, 4)
}

fn axes<'a>(
    canvas: &Canvas<'a>,
    placed: &PlacedConstraint,
    scales: &Scales,
) -> Result<(), DrawError<'a>> {
    let [left, top, right, bottom] = placed.frame;
    let ink = palette::BLACK;
    line(
        canvas,
        vec![
            (left, top),
            (right, top),
            (right, bottom),
            (left, bottom),
            (left, top),
        ],
        ink,
        2,
    )?;
    for (value, label) in &placed.x.major {
        let x = scales.across(*value).round() as i32;
        line(canvas, vec![(x, bottom), (x, bottom - 11)], ink, 2)?;
        Label {
            anchor: HPos::Center,
            ..Label::new(label, SMALL)
        }
        .draw(canvas, (x, bottom + 28))?;
    }
    for (value, label) in &placed.y.major {
        let y = scales.up(*value).round() as i32;
        line(canvas, vec![(left, y), (left + 11, y)], ink, 2)?;
        Label {
            anchor: HPos::Right,
            ..Label::new(label, SMALL)
        }
        .draw(canvas, (left - 12, y))?;
    }
    for value in &placed.x.minor {
        let x = scales.across(*value).round() as i32;
        line(canvas, vec![(x, bottom), (x, bottom - 6)], ink, 1)?;
    }
    for value in &placed.y.minor {
        let y = scales.up(*value).round() as i32;
        line(canvas, vec![(left, y), (left + 6, y)], ink, 1)?;
    }
    let across = Label {
        anchor: HPos::Center,
        ..Label::new(&placed.x.label, LABEL)
    };
    across.draw(canvas, ((left + right) / 2, bottom + 76))?;
    let up = Label {
        anchor: HPos::Center,
        upright: true,
        ..Label::new(&placed.y.label, LABEL)
    };
    up.draw(canvas, (placed.cell_left + 20, (top + bottom) / 2))
}

fn heading<'a>(canvas: &Canvas<'a>, placed: &PlacedConstraint) -> Result<(), DrawError<'a>> {
    let left = placed.frame[0];
    Label {
        bold: true,
        ..Label::new(&placed.panel.title, TITLE)
    }
    .draw(canvas, (left, placed.title_y))?;
    for (i, text) in placed.note.iter().enumerate() {
        Label::new(text, SMALL).draw(canvas, (left, placed.note_y + SMALL_LINE * i as i32))?;
    }
    for &(index, x, y) in &placed.legend {
        let mark = &placed.panel.marks[index];
        match &mark.shape {
            Shape::Series { .. } | Shape::Curve { .. } => {
                line(canvas, vec![(x, y), (x + SAMPLE, y)], mark.color, 6)?
            }
            Shape::Level { .. } => dashes(canvas, x, x + SAMPLE, y, mark.color)?,
            Shape::Cross { .. } => cross(canvas, (x + SAMPLE / 2, y), mark.color)?,
            Shape::Points { radius, .. } => {
                canvas.draw(&Circle::new(
                    (x + SAMPLE / 2, y),
                    (*radius).max(6),
                    rgb(mark.color).filled(),
                ))?;
            }
        }
        Label::new(&mark.label, SMALL).draw(canvas, (x + SAMPLE + 12, y))?;
    }
    Ok(())
}
