//! Text metrics from the embedded font: DejaVu Sans is the widest of the fallback families, so text that fits with
//! it fits with the others.

use std::sync::LazyLock;
use ttf_parser::Face;

static FACE: LazyLock<Face<'static>> =
    LazyLock::new(|| Face::parse(dejavu::sans::regular(), 0).expect("the embedded font is a font"));

/// Width of one line of text at a font size, both in pixels.
pub fn width(text: &str, size: u32) -> i32 {
    let advance = |c| FACE.glyph_hor_advance(FACE.glyph_index(c)?);
    let units: u32 = text
        .chars()
        .map(|c| advance(c).map_or(600, u32::from))
        .sum();
    (f64::from(units) * f64::from(size) / f64::from(FACE.units_per_em())).ceil() as i32
}

/// Lines of `text` no wider than `limit` pixels, broken at spaces; no-break spaces hold.
pub fn wrap(text: &str, size: u32, limit: i32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ').filter(|w| !w.is_empty()) {
        let longer = lines.last().map(|line| format!("{line} {word}"));
        match (lines.last_mut(), longer) {
            (Some(line), Some(longer)) if width(&longer, size) <= limit => *line = longer,
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_loses_no_word_and_keeps_the_limit() {
        let text = "one two three four five six seven eight nine ten";
        let lines = wrap(text, 30, 300);
        assert_eq!(lines.join(" "), text);
        assert!(lines.len() > 1 && lines.iter().all(|l| width(l, 30) <= 300));
    }

    #[test]
    fn every_character_of_the_labels_is_in_the_font() {
        for c in "µδθω²³⁻⁰¹⁴⁵⁶⁷⁸⁹−·×ẍẋΣᵢ≤±√°–ₓ".chars()
        {
            assert!(FACE.glyph_index(c).is_some(), "{c} is not in DejaVu Sans");
        }
    }
}
