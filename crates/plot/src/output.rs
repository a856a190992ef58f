//! Writes a figure as SVG and, rasterised from that SVG with the embedded font, as PNG.

use crate::canvas::Canvas;
use crate::layout::{GAP, MARGIN, SMALL, SMALL_LINE, WIDTH, place};
use crate::{Figure, text};
use miette::{IntoDiagnostic, Result, WrapErr};
use resvg::{tiny_skia, usvg};
use std::fs;
use std::path::Path;
use std::sync::{Arc, LazyLock};

static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Arc::new(fonts)
});

/// Writes `folder/name.svg` and `folder/name.png`.
///
/// # Errors
/// When a file cannot be written.
pub fn save(figure: &Figure, folder: &Path, name: &str) -> Result<()> {
    let [svg, png] = render(figure)?;
    fs::create_dir_all(folder).into_diagnostic()?;
    for (extension, bytes) in [("svg", svg), ("png", png)] {
        let path = folder.join(name).with_extension(extension);
        fs::write(&path, bytes)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

/// The bytes of the SVG and of the PNG file.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn render(figure: &Figure) -> Result<[Vec<u8>; 2]> {
    let svg = svg(figure);
    let png = png(&svg)?;
    Ok([svg.into_bytes(), png])
}

/// The SVG text of a figure.
pub fn svg(figure: &Figure) -> String {
    let (panels, bottom) = place(figure);
    let caption = text::wrap(&figure.caption, SMALL, WIDTH - 4 * MARGIN);
    let mut canvas = Canvas::new(bottom + SMALL_LINE * caption.len() as i32 + MARGIN);
    for panel in panels {
        panel.draw(&mut canvas);
    }
    canvas.small_lines(&caption, (2 * MARGIN, bottom + GAP));
    canvas.finish()
}

/// The PNG of an SVG text, at one pixel a drawing unit.
///
/// # Errors
/// A text that cannot be drawn.
pub fn png(svg: &str) -> Result<Vec<u8>> {
    let options = usvg::Options {
        fontdb: FONTS.clone(),
        font_family: "DejaVu Sans".into(),
        ..Default::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).into_diagnostic()?;
    let scale = WIDTH as f32 / tree.size().width();
    let height = (tree.size().height() * scale).round() as u32;
    let mut pixmap = tiny_skia::Pixmap::new(WIDTH as u32, height)
        .ok_or_else(|| miette::miette!("a figure has no height"))?;
    resvg::render(
        &tree,
        tiny_skia::Transform::from_scale(scale, scale),
        &mut pixmap.as_mut(),
    );
    pixmap.encode_png().into_diagnostic()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Mark, Panel, palette};

    fn sample() -> Figure {
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
    fn long_series_give_a_small_svg_and_a_picture_of_the_stated_width() {
        let svg = svg(&sample());
        assert!(svg.len() < 1_000_000);
        assert!(svg.contains("177.800mm") && svg.contains("h &lt; 2"));
        let image = tiny_skia::Pixmap::decode_png(&png(&svg).unwrap()).unwrap();
        assert_eq!(image.width(), WIDTH as u32);
        let dark = image
            .pixels()
            .iter()
            .filter(|p| p.red() < 100 && p.green() < 100 && p.blue() < 100)
            .count();
        assert!(dark > 5000, "axes and text are drawn");
    }
}
