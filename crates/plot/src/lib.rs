//! Line figures and dot charts for print: a grid of panels with a caption, as SVG and, with the feature `png`, as the PNG
//! rasterised from the same SVG.
//!
//! The caller describes a [`Figure`] in data units; [`svg`] lays it out and thins long series to what a pixel can show. One
//! drawing unit is one pixel of the PNG at 300 dpi.

mod canvas;
mod clip;
mod decimate;
mod layout;
mod output;
mod panel;
#[cfg(feature = "png")]
mod png;
mod text;
mod ticks;

#[cfg(not(feature = "png"))]
pub use output::png;
pub use output::{save, svg};
#[cfg(feature = "png")]
pub use png::png;

use serde::{Deserialize, Serialize};

/// An RGB colour.
pub type Color = (u8, u8, u8);

/// Okabe & Ito (2008): distinguishable with every common form of colour blindness.
pub mod palette {
    use super::Color;

    /// First series.
    pub const BLUE: Color = (0, 114, 178);
    /// Second series.
    pub const VERMILION: Color = (213, 94, 0);
    /// Third series.
    pub const GREEN: Color = (0, 158, 115);
    /// Fourth series.
    pub const PURPLE: Color = (204, 121, 167);
    /// Fifth series.
    pub const ORANGE: Color = (230, 159, 0);
    /// Sixth series.
    pub const SKY: Color = (86, 180, 233);
    /// Seventh series (of Tol's palettes, as are those after it).
    pub const INDIGO: Color = (51, 34, 136);
    /// Eighth series.
    pub const BROWN: Color = (136, 84, 40);
    /// Ninth series.
    pub const OLIVE: Color = (153, 153, 51);
    /// Tenth series.
    pub const WINE: Color = (136, 34, 85);
    /// Eleventh series.
    pub const TEAL: Color = (68, 170, 153);
    /// For a diagram with more curves than [`SERIES`].
    pub const LIME: Color = (120, 190, 32);
    /// The same.
    pub const ROSE: Color = (238, 80, 130);
    /// The same.
    pub const SLATE: Color = (90, 110, 150);
    /// The same.
    pub const GOLD: Color = (201, 168, 0);
    /// The same.
    pub const CLARET: Color = (160, 20, 40);
    /// The colours of series in their order; the first six are those of Okabe and Ito.
    pub const SERIES: [Color; 11] = [
        BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY, INDIGO, BROWN, OLIVE, WINE, TEAL,
    ];
    /// Reference curves such as the ideal mechanism.
    pub const GREY: Color = (130, 130, 130);
    /// Bounds and reference lines.
    pub const BLACK: Color = (30, 30, 30);
}

/// A figure: rows of panels and a caption below.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Rows from top to bottom; panels of a row share its width.
    pub rows: Vec<Vec<Panel>>,
    /// Text below the panels, wrapped to the width.
    pub caption: String,
}

impl Figure {
    /// Panels one after the other, so many beside each other.
    pub fn grid(panels: Vec<Panel>, columns: usize, caption: String) -> Figure {
        let mut rows: Vec<Vec<Panel>> = Vec::new();
        for panel in panels {
            match rows.last_mut() {
                Some(row) if row.len() < columns => row.push(panel),
                _ => rows.push(vec![panel]),
            }
        }
        Figure { rows, caption }
    }

    /// The figure with the points alone that make a difference in the drawing, to five digits: what a record keeps of it.
    pub fn thinned(mut self) -> Figure {
        let (placed, _) = layout::place(&self);
        let drawn = |panel: &layout::PlacedPanel| {
            let marks = panel.panel.marks.iter();
            marks.map(|mark| panel.drawn(mark)).collect::<Vec<_>>()
        };
        let kept: Vec<Vec<usize>> = placed.iter().flat_map(drawn).collect();
        let marks = self.rows.iter_mut().flatten().flat_map(|p| &mut p.marks);
        for (mark, kept) in marks.zip(kept) {
            let pick = |from: &[f64]| {
                let kept = kept.iter().map(|i| from[*i]);
                kept.map(|x| numbers::rounded(x, 5)).collect()
            };
            if !mark.x.is_empty() {
                (mark.x, mark.y) = (pick(&mark.x), pick(&mark.y));
            }
        }
        self
    }
}

/// One pair of axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Title above the frame, such as `a) Case 2`.
    pub title: String,
    /// Remark below the title in small type; empty for none.
    pub note: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn, back to front.
    pub marks: Vec<Mark>,
}

/// One axis: label, unit and range.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Quantity without the unit.
    pub label: String,
    /// Symbol of the unit the ticks are in, such as `µm`; empty for a pure number.
    pub unit: String,
    /// Ticks are data (SI) times this.
    pub factor: f64,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Range in SI; from the data when absent.
    pub range: Option<(f64, f64)>,
    /// Where labels stand on a logarithmic axis, in SI; at powers of ten when empty.
    pub labels: Vec<f64>,
    /// On the horizontal axis of a panel: both axes are drawn to one scale, the shorter range is widened.
    pub equal: bool,
    /// On the vertical axis of a panel: what stands at 0, 1, ... from the top down; empty for an axis of numbers.
    pub names: Vec<String>,
}

/// Spacing of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scale {
    /// Equal differences.
    Linear,
    /// Equal ratios; values that are not positive are not drawn.
    Log,
}

/// Something drawn inside a panel, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mark {
    /// Entry of the legend; empty for none. Text of a [`MarkShape::Name`].
    pub label: String,
    /// Colour.
    pub color: Color,
    /// Kind.
    pub shape: MarkShape,
    /// Abscissae; none for a level.
    pub x: Vec<f64>,
    /// Ordinates.
    pub y: Vec<f64>,
}

/// The kinds of mark; widths and radii are in pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum MarkShape {
    /// y over an x that never decreases; thinned to the envelope of every pixel column.
    Series {
        /// Line width.
        width: u32,
    },
    /// A curve in the plane; points closer than a quarter pixel to the last one kept are dropped.
    Curve {
        /// Line width.
        width: u32,
    },
    /// Separate points.
    Points {
        /// Radius of a dot.
        radius: u32,
    },
    /// A cross at one place.
    Cross,
    /// A horizontal dashed line over the width of the panel; it takes part in the automatic range.
    Level,
    /// The label itself, beside one place; labels of a panel that would overlap are moved apart.
    Name,
    /// The inside of a polygon, so opaque \[%\]; what lies outside the frame is pushed to its edge.
    Area {
        /// 100 hides what is drawn before.
        opacity: u32,
    },
}

impl Axis {
    /// A linear axis over the range of the data: ticks are data times `factor`, in `unit`.
    pub fn new(label: &str, unit: &str, factor: f64) -> Axis {
        Axis {
            label: label.into(),
            unit: unit.to_owned(),
            factor,
            scale: Scale::Linear,
            range: None,
            labels: Vec::new(),
            equal: false,
            names: Vec::new(),
        }
    }

    /// A vertical axis of names, the first at the top: marks stand at the ordinates 0, 1, ...
    pub fn categories(names: Vec<String>) -> Axis {
        Axis {
            names,
            ..Axis::new("", "", 1.0)
        }
    }

    /// The same horizontal axis, to one scale with the vertical one; both linear, with the same factor.
    pub fn equal(self) -> Axis {
        Axis {
            equal: true,
            ..self
        }
    }

    /// The same axis with logarithmic spacing.
    pub fn log(self) -> Axis {
        Axis {
            scale: Scale::Log,
            ..self
        }
    }

    /// The same axis with logarithmic spacing and these labels alone, in SI units.
    pub fn log_at(self, labels: Vec<f64>) -> Axis {
        Axis {
            labels,
            ..self.log()
        }
    }

    /// The same axis over a given range in SI units.
    pub fn over(self, low: f64, high: f64) -> Axis {
        Axis {
            range: Some((low, high)),
            ..self
        }
    }
}

impl Mark {
    fn new(label: &str, color: Color, shape: MarkShape, x: &[f64], y: &[f64]) -> Mark {
        Mark {
            label: label.into(),
            color,
            shape,
            x: x.to_vec(),
            y: y.to_vec(),
        }
    }

    /// A line over a monotonic abscissa.
    pub fn series(label: &str, color: Color, x: &[f64], y: &[f64]) -> Mark {
        Mark::new(label, color, MarkShape::Series { width: 3 }, x, y)
    }

    /// A curve in the plane.
    pub fn curve(label: &str, color: Color, x: &[f64], y: &[f64]) -> Mark {
        Mark::new(label, color, MarkShape::Curve { width: 2 }, x, y)
    }

    /// Dots.
    pub fn points(label: &str, color: Color, x: &[f64], y: &[f64], radius: u32) -> Mark {
        Mark::new(label, color, MarkShape::Points { radius }, x, y)
    }

    /// A cross.
    pub fn cross(label: &str, color: Color, at: (f64, f64)) -> Mark {
        Mark::new(label, color, MarkShape::Cross, &[at.0], &[at.1])
    }

    /// A dashed horizontal line.
    pub fn level(label: &str, color: Color, y: f64) -> Mark {
        Mark::new(label, color, MarkShape::Level, &[], &[y])
    }

    /// A text in the colour of the curve that passes here.
    pub fn name(label: &str, color: Color, at: (f64, f64)) -> Mark {
        Mark::new(label, color, MarkShape::Name, &[at.0], &[at.1])
    }

    /// What lies between two curves over an increasing abscissa, so pale that curves in the same colour stand out from it.
    pub fn band(label: &str, color: Color, x: &[f64], low: &[f64], high: &[f64]) -> Mark {
        let back = |values: &[f64]| values.iter().rev().copied().collect::<Vec<f64>>();
        let shape = MarkShape::Area { opacity: 22 };
        let (x, y) = ([x, &back(x)].concat(), [high, &back(low)].concat());
        Mark::new(label, color, shape, &x, &y)
    }

    /// A filled rectangle between two corners.
    pub fn cell(label: &str, color: Color, low: (f64, f64), high: (f64, f64)) -> Mark {
        let shape = MarkShape::Area { opacity: 100 };
        let (x, y) = (
            [low.0, high.0, high.0, low.0],
            [low.1, low.1, high.1, high.1],
        );
        Mark::new(label, color, shape, &x, &y)
    }

    /// The same mark with another line width in pixels.
    pub fn width(mut self, pixels: u32) -> Mark {
        if let MarkShape::Series { width } | MarkShape::Curve { width } = &mut self.shape {
            *width = pixels;
        }
        self
    }
}
