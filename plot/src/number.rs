//! How numbers are written for people.

use crate::superscript;

/// A value with three significant digits and an SI prefix, such as `23.1 µm`, and a no-break space.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 8] = [
        (1e9, "G"),
        (1e6, "M"),
        (1e3, "k"),
        (1.0, ""),
        (1e-3, "m"),
        (1e-6, "µ"),
        (1e-9, "n"),
        (1e-12, "p"),
    ];
    if value == 0.0 || !value.is_finite() {
        return format!("{value}\u{a0}{unit}");
    }
    let size = rounded(value.abs());
    let (factor, prefix) = PREFIXES
        .into_iter()
        .find(|(f, _)| size >= *f * 0.9999)
        .unwrap_or(PREFIXES[7]);
    format!("{}\u{a0}{prefix}{unit}", digits(value / factor))
}

/// A value with three significant digits.
pub fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = rounded(value.abs()).log10().floor() as i32;
    if !(-4..6).contains(&magnitude) {
        let mantissa = value / 10f64.powi(magnitude);
        return format!("{mantissa:.2}·10{}", superscript(magnitude));
    }
    let text = format!("{value:.*}", (2 - magnitude).max(0) as usize);
    // a step of 2 µs is not 2.00 µs; the tolerance is that of a few products
    let short = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    let exact = short
        .parse::<f64>()
        .is_ok_and(|v| (v - value).abs() <= 1e-14 * value.abs());
    if exact { short.into() } else { text }
}

/// A fraction in per cent.
pub fn percent(value: f64) -> String {
    format!("{}\u{a0}%", digits(100.0 * value))
}

fn rounded(size: f64) -> f64 {
    format!("{size:.2e}").parse().unwrap_or(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_and_digits() {
        assert_eq!(si(2e-6, "s"), "2\u{a0}µs");
        assert_eq!(si(1e-4, "s"), "100\u{a0}µs");
        assert_eq!(si(2.3456e-5, "m"), "23.5\u{a0}µm");
        assert_eq!(si(9.999e-4, "m"), "1.00\u{a0}mm");
        assert_eq!(si(7e9, "Pa"), "7\u{a0}GPa");
        assert_eq!(si(-3.9478, "m/s²"), "-3.95\u{a0}m/s²");
        assert_eq!(si(10.0 * 1e-6, "s"), "10\u{a0}µs");
        assert_eq!(digits(1234.6), "1235");
        assert_eq!(digits(-4.123e-8), "-4.12·10⁻⁸");
        assert_eq!(percent(0.98765), "98.8\u{a0}%");
    }
}
