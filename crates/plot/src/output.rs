//! Writes a figure as SVG.

use crate::canvas::Canvas;
use crate::layout::{GAP, MARGIN, SMALL, SMALL_LINE, WIDTH, place};
use crate::{Figure, text};
use miette::{IntoDiagnostic, Result, WrapErr};
use std::fs;
use std::path::Path;

/// Writes `folder/name.svg`.
///
/// # Errors
/// When the file cannot be written.
pub fn save(figure: &Figure, folder: &Path, name: &str) -> Result<()> {
    fs::create_dir_all(folder).into_diagnostic()?;
    let path = folder.join(name).with_extension("svg");
    fs::write(&path, svg(figure))
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

/// The SVG text of a figure.
pub fn svg(figure: &Figure) -> String {
    let (panels, bottom) = place(figure);
    let caption = caption(figure);
    let mut canvas = Canvas::new(height(bottom, &caption));
    for panel in panels {
        panel.draw(&mut canvas);
    }
    canvas.small_lines(&caption, (2 * MARGIN, bottom + GAP));
    canvas.finish()
}

impl Figure {
    /// Height of the picture in pixels.
    pub fn height(&self) -> i32 {
        height(place(self).1, &caption(self))
    }
}

/// The lines of the caption.
fn caption(figure: &Figure) -> Vec<String> {
    text::wrap(&figure.caption, SMALL, WIDTH - 4 * MARGIN)
}

/// Height of a picture whose panels end at `bottom`.
fn height(bottom: i32, caption: &[String]) -> i32 {
    bottom + SMALL_LINE * caption.len() as i32 + MARGIN
}

/// None: PNGs need the feature `png`.
///
/// # Errors
/// None.
#[cfg(not(feature = "png"))]
pub fn png(_svg: &str) -> Result<Option<Vec<u8>>> {
    Ok(None)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::{Axis, Mark, Panel, palette};

    pub fn sample() -> Figure {
        let x: Vec<f64> = (0..300_000)
            .map(|i| 1.0 + f64::from(i) / 150_000.0)
            .collect();
        let y: Vec<f64> = x
            .iter()
            .map(|t| 1e-6 * (900.0 * t).sin() * (7.0 * t).cos())
            .collect();
        let panel = Panel {
            title: "a) Case 2".into(),
            note: String::new(),
            x: Axis::new("Time", "s", 1.0),
            y: Axis::new("Error", "µm", 1e6),
            marks: vec![Mark::series("h < 2", palette::BLUE, &x, &y)],
        };
        Figure {
            rows: vec![vec![panel]],
            caption: "A caption.".into(),
        }
    }

    #[test]
    fn long_series_give_a_small_svg_of_the_stated_width() {
        let svg = svg(&sample());
        assert!(svg.len() < 1_000_000);
        assert!(svg.contains("177.800mm") && svg.contains("h &lt; 2"));
    }

    #[test]
    fn a_thinned_figure_has_few_points_and_all_extremes() {
        let (full, thinned) = (sample(), sample().thinned());
        let mark = |figure: &Figure| figure.rows[0][0].marks[0].clone();
        let (before, after) = (mark(&full), mark(&thinned));
        assert!(after.x.len() * 10 < before.x.len(), "{}", after.x.len());
        let range = |y: &[f64]| {
            let fold = |pick: fn(f64, f64) -> f64, from| y.iter().copied().fold(from, pick);
            [fold(f64::min, f64::MAX), fold(f64::max, f64::MIN)].map(|y| numbers::rounded(y, 5))
        };
        assert_eq!(range(&after.y), range(&before.y));
        // thinned again it loses little: pieces of the simplification begin elsewhere
        let lengths = [&full, &thinned].map(svg).map(|text| text.len());
        assert!(
            lengths[0].abs_diff(lengths[1]) * 20 < lengths[0],
            "{lengths:?}"
        );
    }
}
