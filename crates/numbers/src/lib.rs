//! How numbers are written for people.

/// A value with three significant digits and an SI prefix, such as `23.1 µm`, and a no-break space; with a power of ten where there is
/// no prefix.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [&str; 10] = ["p", "n", "µ", "m", "", "k", "M", "G", "T", "P"];
    const FACTORS: [f64; 10] = [1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12, 1e15];
    if value == 0.0 || !value.is_finite() {
        return format!("{}\u{a0}{unit}", plain(value));
    }
    let thousands = magnitude(value, 3).div_euclid(3);
    let place = usize::try_from(thousands + 4).ok();
    let prefix = place.and_then(|place| Some((FACTORS.get(place)?, PREFIXES[place])));
    match prefix {
        Some((factor, prefix)) => format!("{}\u{a0}{prefix}{unit}", digits(value / factor)),
        None => format!("{}\u{a0}{unit}", digits(value)),
    }
}

/// A value with three significant digits; powers of ten as in print.
pub fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return plain(value);
    }
    let magnitude = magnitude(value, 3);
    if !(-4..6).contains(&magnitude) {
        let mantissa = value / 10f64.powi(magnitude);
        return format!("{mantissa:.2}·10{}", superscript(magnitude));
    }
    let text = format!("{value:.*}", (2 - magnitude).max(0) as usize);
    // a step of 2 µs is not 2.00 µs; the tolerance is that of a few products
    let short = without_zeros(&text);
    match short.parse::<f64>() {
        Ok(v) if (v - value).abs() <= 1e-14 * value.abs() => short.to_owned(),
        _ => text,
    }
}

/// A value with at most so many significant digits; powers of ten as in a file, such as `1.25e-8`. For messages, and for
/// tables whose numbers are compared with those of a file.
pub fn number(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return plain(value);
    }
    let magnitude = magnitude(value, digits);
    if !(-3..6).contains(&magnitude) {
        let text = format!("{value:.*e}", digits - 1);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", without_zeros(mantissa));
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    without_zeros(&format!("{value:.decimals$}")).to_owned()
}

/// A part of something in words: a percentage up to the whole, a multiple beyond it.
pub fn share(part: f64, of: &str) -> String {
    match part {
        part if part <= 1.0 => format!("{} % of {of}", number(100.0 * part, 3)),
        part => format!("{} times {of}", number(part, 2)),
    }
}

/// A value with all the digits that it takes to read it back, such as `10`, `0.001` or `1.25e-6`.
pub fn exact(value: f64) -> String {
    let text = format!("{:?}", value + 0.0);
    text.trim_end_matches(".0").to_owned()
}

/// A value with so many significant digits, as it is kept in a file.
pub fn rounded(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits - 1);
    text.parse().unwrap_or(value)
}

/// Zero, which has no sign here, or what is not finite.
fn plain(value: f64) -> String {
    format!("{}", value + 0.0)
}

/// The power of ten of the first digit, of a value rounded to so many digits.
fn magnitude(value: f64, digits: usize) -> i32 {
    let text = format!("{value:.*e}", digits - 1);
    let exponent = text.split_once('e').and_then(|(_, e)| e.parse().ok());
    exponent.unwrap_or(0)
}

fn without_zeros(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// A fraction in per cent.
pub fn percent(value: f64) -> String {
    format!("{}\u{a0}%", digits(100.0 * value))
}

/// Bytes as hexadecimal digits, such as those of a digest.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// An integer as superscript characters.
pub fn superscript(n: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]);
    n.to_string().chars().map(raised).collect()
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
        assert_eq!(si(2.4712e-32, "N"), "2.47·10⁻³²\u{a0}N");
        assert_eq!(si(1.1e-16, "J"), "1.10·10⁻¹⁶\u{a0}J");
        assert_eq!(digits(1234.6), "1235");
        assert_eq!(digits(-4.123e-8), "-4.12·10⁻⁸");
        assert_eq!(percent(0.98765), "98.8\u{a0}%");
        assert_eq!((digits(0.0), digits(-0.0)), ("0".into(), "0".into()));
        assert_eq!(si(-0.0, "m"), "0\u{a0}m");
    }

    #[test]
    fn numbers_of_messages_and_tables() {
        for (value, digits, text) in [
            (0.0, 4, "0"),
            (-0.0, 4, "0"),
            (1.0, 4, "1"),
            (36.0, 4, "36"),
            (1e-9, 4, "1e-9"),
            (-1.25e-8, 3, "-1.25e-8"),
            (5.00e-8, 3, "5e-8"),
            (9.9996e-4, 4, "0.001"),
            (9.96e-10, 2, "1e-9"),
            (-2.802161641234, 10, "-2.802161641"),
            (12.39669421, 10, "12.39669421"),
            (0.0012868065791, 10, "0.001286806579"),
            (123456.7, 3, "123457"),
            (999999.7, 6, "1e6"),
            (3.0e12, 2, "3e12"),
            (f64::INFINITY, 2, "inf"),
        ] {
            assert_eq!(number(value, digits), text);
        }
        assert_eq!(rounded(-1234.567, 6), -1234.57);
        assert_eq!(rounded(0.1 + 0.2, 4), 0.3);
        assert!(rounded(f64::NAN, 4).is_nan());
        for text in ["0", "10", "100", "0.001", "1.25e-6", "-1e-9", "1e300"] {
            assert_eq!(exact(text.parse().unwrap()), text);
        }
    }
}
