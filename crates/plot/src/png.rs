//! Rasterises an SVG text with the embedded font.

use crate::layout::WIDTH;
use miette::{IntoDiagnostic, Result};
use resvg::{tiny_skia, usvg};
use std::sync::{Arc, LazyLock};

static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Arc::new(fonts)
});

/// The PNG of an SVG text, at one pixel a drawing unit; none without the feature `png`.
///
/// # Errors
/// A text that cannot be drawn.
pub fn png(svg: &str) -> Result<Option<Vec<u8>>> {
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
    pixmap.encode_png().into_diagnostic().map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::tests::sample;
    use crate::svg;

    #[test]
    fn a_picture_has_the_stated_width_and_is_not_blank() {
        let png = png(&svg(&sample())).unwrap().unwrap();
        let image = tiny_skia::Pixmap::decode_png(&png).unwrap();
        assert_eq!(image.width(), WIDTH as u32);
        let dark = image
            .pixels()
            .iter()
            .filter(|p| p.red() < 100 && p.green() < 100 && p.blue() < 100)
            .count();
        assert!(dark > 5000, "axes and text are drawn");
    }
}
