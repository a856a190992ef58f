//! A drawing as SVG text.

use crate::layout::{SMALL, SMALL_LINE, WIDTH};
use crate::{Color, palette};
use texts::xml::escaped;

/// Families in the order a browser tries them.
const FAMILIES: &str = "DejaVu Sans, Arial, Helvetica, sans-serif";
/// Dots an inch of the PNG; a drawing unit is one of them.
const DPI: f64 = 300.0;

/// An SVG document in the making; places are in pixels.
pub struct Canvas(String);

impl Canvas {
    /// A white page.
    pub fn new(height: i32) -> Canvas {
        let [across, down] = [WIDTH, height].map(|pixels| f64::from(pixels) / DPI * 25.4);
        // joints are round, so that lines do not overshoot at sharp peaks
        Canvas(format!(
            "<svg width=\"{across:.3}mm\" height=\"{down:.3}mm\" stroke-linejoin=\"round\" font-family=\"{FAMILIES}\" \
             viewBox=\"0 0 {WIDTH} {height}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
             <rect x=\"0\" y=\"0\" width=\"{WIDTH}\" height=\"{height}\" opacity=\"1\" fill=\"#FFFFFF\" stroke=\"none\"/>\n"
        ))
    }

    /// The whole document.
    pub fn finish(self) -> String {
        self.0 + "</svg>\n"
    }

    /// A line through points.
    pub fn line(&mut self, points: &[(i32, i32)], color: Color, width: u32) {
        self.lines(&[points], color, width);
    }

    /// Lines of one kind, each through its points.
    pub fn lines<L: AsRef<[(i32, i32)]>>(&mut self, lines: &[L], color: Color, width: u32) {
        let path: String = lines.iter().map(|line| path(line.as_ref())).collect();
        if path.is_empty() {
            return;
        }
        let color = code(color);
        self.0 += &format!(
            "<path fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" d=\"{path}\"/>\n"
        );
    }

    /// The inside of a polygon; `opacity` is in per cent.
    pub fn area(&mut self, corners: &[(i32, i32)], color: Color, opacity: u32) {
        let color = code(color);
        let corners = corners.iter().map(|(x, y)| format!("{x},{y} "));
        self.0 += &format!(
            "<polygon fill=\"{color}\" opacity=\"{:.2}\" stroke=\"none\" points=\"{}\"/>\n",
            f64::from(opacity) / 100.0,
            corners.collect::<String>()
        );
    }

    /// A dashed horizontal line.
    pub fn dashes(&mut self, from: i32, to: i32, y: i32, color: Color) {
        let dashes = (from..to).step_by(24);
        let dashes = dashes.map(|x| [(x, y), ((x + 14).min(to), y)]);
        self.lines(&dashes.collect::<Vec<_>>(), color, 3);
    }

    /// Crosses, each of two short lines.
    pub fn crosses(&mut self, places: &[(i32, i32)], color: Color) {
        let arms = places
            .iter()
            .flat_map(|&(x, y)| [12, -12].map(|slope| [(x - 12, y - slope), (x + 12, y + slope)]));
        self.lines(&arms.collect::<Vec<_>>(), color, 4);
    }

    /// Dots of one size.
    pub fn dots(&mut self, places: &[(i32, i32)], radius: u32, color: Color) {
        if places.is_empty() {
            return;
        }
        let dots = places
            .iter()
            .map(|(x, y)| format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>\n"));
        let color = code(color);
        self.0 += &format!("<g fill=\"{color}\">\n{}</g>\n", dots.collect::<String>());
    }

    /// A line of text around its vertical centre; `anchor` is what stands at x: `start`, `middle` or `end`.
    pub fn text(&mut self, text: &str, at: (i32, i32), size: u32, anchor: &str) {
        self.text_with(text, at, size, anchor, palette::BLACK, "");
    }

    /// A line of text in a colour, readable where it stands on a curve.
    pub fn name(&mut self, text: &str, at: (i32, i32), size: u32, anchor: &str, color: Color) {
        let halo = " paint-order=\"stroke\" stroke=\"#FFFFFF\" stroke-width=\"8\"";
        self.text_with(text, at, size, anchor, color, halo);
    }

    /// Lines of small text below each other.
    pub fn small_lines(&mut self, lines: &[String], (x, mut y): (i32, i32)) {
        for line in lines {
            self.text(line, (x, y), SMALL, "start");
            y += SMALL_LINE;
        }
    }

    /// A line of bold text.
    pub fn bold(&mut self, text: &str, at: (i32, i32), size: u32) {
        self.text_with(
            text,
            at,
            size,
            "start",
            palette::BLACK,
            " font-weight=\"bold\"",
        );
    }

    /// A line of text that is read upwards.
    pub fn upright(&mut self, text: &str, at: (i32, i32), size: u32) {
        let turned = format!(" transform=\"rotate(270, {}, {})\"", at.0, at.1);
        self.text_with(text, at, size, "middle", palette::BLACK, &turned);
    }

    fn text_with(
        &mut self,
        text: &str,
        (x, y): (i32, i32),
        size: u32,
        anchor: &str,
        color: Color,
        attributes: &str,
    ) {
        let color = code(color);
        let text = escaped(text);
        self.0 += &format!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.5ex\" text-anchor=\"{anchor}\" font-size=\"{size}\" fill=\"{color}\"{attributes}>\n{text}\n</text>\n"
        );
    }
}

/// Path data of a line: its first place, then the way from each place to the next, which takes fewer characters.
fn path(points: &[(i32, i32)]) -> String {
    let [(x, y), _, ..] = points else {
        return String::new();
    };
    let ways = points.windows(2).map(|pair| {
        let ((x, y), (to_x, to_y)) = (pair[0], pair[1]);
        format!("{},{}", to_x - x, to_y - y)
    });
    format!("M{x},{y}l{}", ways.collect::<Vec<_>>().join(" "))
}

fn code((r, g, b): Color) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}
