//! Lines of text.

use crate::panel::{Canvas, DrawError, rgb};
use crate::{palette, text};
use plotters::prelude::*;
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The SVG backend divides font sizes by this number.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;

/// A line of text around its vertical centre.
pub struct Label<'t> {
    /// The text.
    pub text: &'t str,
    /// Font size in pixels.
    pub size: u32,
    /// Horizontal anchor.
    pub anchor: HPos,
    /// Bold face.
    pub bold: bool,
    /// Reading upwards.
    pub upright: bool,
}

impl<'t> Label<'t> {
    /// Left-aligned plain text.
    pub fn new(text: &'t str, size: u32) -> Label<'t> {
        Label {
            text,
            size,
            anchor: HPos::Left,
            bold: false,
            upright: false,
        }
    }

    /// Draws the text at a point in pixels.
    pub fn draw<'a>(&self, canvas: &Canvas<'a>, at: (i32, i32)) -> Result<(), DrawError<'a>> {
        let style = if self.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let mut font = FontDesc::new(
            FontFamily::Name(text::FAMILY),
            f64::from(self.size) * PLOTTERS_FONT_FACTOR,
            style,
        );
        if self.upright {
            font = font.transform(FontTransform::Rotate270);
        }
        let ink = rgb(palette::BLACK);
        let style = TextStyle::from(font)
            .color(&ink)
            .pos(Pos::new(self.anchor, VPos::Center));
        canvas.draw(&Text::new(self.text, at, style))
    }
}
