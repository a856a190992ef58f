//! Values as people write them where TOML has another form: what is meant, and how it is written.

use numbers::{exact, rounded};
use std::f64::consts::PI;
use std::ops::Range;
use texts::{described, harmful};
use toml::de::DeValue;

/// Units that people write behind a number: the factor to the unit of SI and its divisor, of which one is 1, so that the digits of
/// decimal fractions stay.
const UNITS: [(&str, [f64; 2], &str); 40] = [
    ("m", [1.0, 1.0], "m"),
    ("km", [1e3, 1.0], "m"),
    ("cm", [1.0, 1e2], "m"),
    ("mm", [1.0, 1e3], "m"),
    ("um", [1.0, 1e6], "m"),
    ("µm", [1.0, 1e6], "m"),
    ("μm", [1.0, 1e6], "m"),
    ("in", [0.0254, 1.0], "m"),
    ("kg", [1.0, 1.0], "kg"),
    ("g", [1.0, 1e3], "kg"),
    ("t", [1e3, 1.0], "kg"),
    ("s", [1.0, 1.0], "s"),
    ("ms", [1.0, 1e3], "s"),
    ("us", [1.0, 1e6], "s"),
    ("µs", [1.0, 1e6], "s"),
    ("μs", [1.0, 1e6], "s"),
    ("min", [60.0, 1.0], "s"),
    ("N", [1.0, 1.0], "N"),
    ("kN", [1e3, 1.0], "N"),
    ("N/m", [1.0, 1.0], "N/m"),
    ("N/mm", [1e3, 1.0], "N/m"),
    ("Nm", [1.0, 1.0], "N m"),
    ("Pa", [1.0, 1.0], "Pa"),
    ("kPa", [1e3, 1.0], "Pa"),
    ("MPa", [1e6, 1.0], "Pa"),
    ("GPa", [1e9, 1.0], "Pa"),
    ("N/mm2", [1e6, 1.0], "Pa"),
    ("kg/m3", [1.0, 1.0], "kg/m3"),
    ("g/cm3", [1e3, 1.0], "kg/m3"),
    ("m/s", [1.0, 1.0], "m/s"),
    ("mm/s", [1.0, 1e3], "m/s"),
    ("m/s2", [1.0, 1.0], "m/s2"),
    ("Hz", [1.0, 1.0], "Hz"),
    ("rad", [1.0, 1.0], "rad"),
    ("rad/s", [1.0, 1.0], "rad/s"),
    ("rpm", [PI, 30.0], "rad/s"),
    ("°", [PI, 180.0], "rad"),
    ("deg", [PI, 180.0], "rad"),
    ("degree", [PI, 180.0], "rad"),
    ("degrees", [PI, 180.0], "rad"),
];

/// Quotation marks of printed text.
const PRINTED_QUOTES: [char; 9] = ['“', '”', '„', '«', '»', '‘', '’', '‚', '´'];

/// Characters that editors and web pages put in place of those of a keyboard: what they are called, and what to do.
const LOOKALIKES: [(&[char], &str, &str); 6] = [
    (&['\u{2212}'], "minus sign", "write -"),
    (
        &['\u{2010}', '\u{2011}', '\u{2013}', '\u{2014}'],
        "dash",
        "write -",
    ),
    (&['\u{a0}', '\u{202f}'], "no-break space", "write a space"),
    (
        &['\u{200b}', '\u{feff}'],
        "invisible character",
        "delete it",
    ),
    (&['×', '·', '⋅', '∙'], "multiplication sign", "write *"),
    (&PRINTED_QUOTES, "quotation mark", "write \""),
];

/// What to type in place of a character that only looks like one of a keyboard.
pub(crate) fn lookalike(c: char) -> Option<String> {
    let (_, name, advice) = LOOKALIKES.iter().find(|(these, ..)| these.contains(&c))?;
    let code = u32::from(c);
    Some(format!(
        "this {name} (U+{code:04X}) is not that of a keyboard: {advice}"
    ))
}

/// The first character of a text that could do harm, and what it is.
pub(super) fn first_harmful(text: &str) -> Option<(Range<usize>, String)> {
    let (at, c) = harmful(text).next()?;
    Some((at..at + c.len_utf8(), described(c)))
}

/// The first such character of a line outside of texts and comments, or the quotation mark with which a text seems to end.
pub(super) fn first_lookalike(line: &str) -> Option<(Range<usize>, String)> {
    let (mut quote, mut end) = (None, None);
    for (i, c) in line.char_indices() {
        let found = || lookalike(c).map(|said| (i..i + c.len_utf8(), said));
        match (quote, c) {
            (Some(open), _) if open == c => (quote, end) = (None, None),
            (Some(_), c) if PRINTED_QUOTES.contains(&c) => end = end.or_else(found),
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '#') => return None,
            (None, _) => {
                if let Some(found) = found() {
                    return Some(found);
                }
            }
        }
    }
    end
}

/// What is meant by the first value of a line that is no TOML, and where it stands in the line. `keyed` is false where the line is
/// a value alone.
pub(super) fn meant(line: &str, keyed: bool) -> Option<(Range<usize>, String)> {
    let pieces = pieces(line, keyed);
    for (k, piece) in pieces.iter().enumerate() {
        let text = &line[piece.at.clone()];
        if DeValue::parse(text).is_err() {
            if let Some(said) = sentence(text, piece.is_value) {
                return Some((piece.at.clone(), said));
            }
        } else if let Some(next) = pieces.get(k + 1)
            && piece.follows_key
            && !next.follows_key
            && let Some(said) = decimal_comma(text, &line[next.at.clone()])
        {
            return Some((piece.at.start..next.at.end, said));
        }
    }
    None
}

/// A value of a line, between brackets, braces and commas.
struct Piece {
    at: Range<usize>,
    /// True where a key stands before it, or where it begins a line that is a value.
    follows_key: bool,
    /// True where it is a value, and not perhaps a header.
    is_value: bool,
}

fn pieces(line: &str, keyed: bool) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let (mut start, mut quote, mut has_key) = (0, None, !keyed);
    let mut is_value = !keyed;
    let mut end_piece = |start: usize, end: usize, follows_key: bool, is_value: bool| {
        let text = &line[start..end];
        let trimmed = text.trim();
        let first = start + text.len() - text.trim_start().len();
        if !trimmed.is_empty() {
            pieces.push(Piece {
                at: first..first + trimmed.len(),
                follows_key,
                is_value,
            });
        }
    };
    for (i, c) in line.char_indices() {
        match (quote, c) {
            (Some(open), _) if open == c => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '=') => {
                (start, has_key, is_value) = (i + 1, true, true);
            }
            (None, '#') => {
                end_piece(start, i, has_key, is_value);
                return pieces;
            }
            (None, '[' | ']' | '{' | '}' | ',') => {
                end_piece(start, i, has_key, is_value);
                (start, has_key) = (i + 1, false);
            }
            _ => {}
        }
    }
    end_piece(start, line.len(), has_key, is_value);
    pieces
}

/// What a number and what follows its comma are, if together they are one number.
pub(crate) fn decimal_comma(whole: &str, rest: &str) -> Option<String> {
    let whole = whole.trim();
    let (length, digits) = (number_length(whole), number_length(rest));
    let is_fraction = rest.starts_with(|c: char| c.is_ascii_digit());
    let is_whole = length == whole.len() && !whole.contains('.');
    (is_whole && length > 0 && is_fraction)
        .then(|| format!("a number has a decimal point: {whole}.{}", &rest[..digits]))
}

/// What is meant by a comma between two digits, with no space beside it.
pub(super) fn comma_in_number(list: &str) -> Option<String> {
    let commas = list.match_indices(',').map(|(at, _)| list.split_at(at));
    let mut numbers = commas.filter_map(|(before, after)| {
        let digits = before.trim_end_matches(|c: char| c.is_ascii_digit());
        decimal_comma(&before[digits.len()..], &after[1..])
    });
    numbers.next()
}

/// What is meant by a text that is no value.
fn sentence(text: &str, is_value: bool) -> Option<String> {
    if let Some(rest) = text.strip_prefix(['\u{2212}', '\u{2013}']) {
        return Some(format!(
            "this minus sign is not that of a keyboard: write -{}",
            rest.trim()
        ));
    }
    let (number, rest) = text.split_at(number_length(text));
    if number.is_empty() {
        let is_word = |c: char| c.is_alphanumeric() || "_-.".contains(c);
        return match text.to_lowercase().as_str() {
            _ if !is_value => None,
            word @ ("true" | "false") => Some(format!("`{text}` is written {word}")),
            _ if text.starts_with(char::is_alphabetic) && text.chars().all(is_word) => {
                Some(format!("text stands in quotes: \"{text}\""))
            }
            _ => None,
        };
    }
    let value: f64 = number.parse().ok()?;
    match rest.trim() {
        "" if number.contains('.') => Some(format!(
            "a number has digits on both sides of its decimal point: {value:?}"
        )),
        "" => Some(format!("a number does not begin with zeros: {}", exact(value))),
        "pi" | "π" => Some(format!(
            "a number is written with digits, {:?}; as a function of time write \"{number}*pi\", in quotes",
            value * PI
        )),
        unit => quantity(number, unit).or_else(|| {
            let is_sum = unit.starts_with(['*', '/', '^', '+', '-', '(']);
            Some(match is_sum {
                true => "a number is written with digits; only functions of time can be formulas, in quotes".to_owned(),
                false => "numbers have no unit: all are in SI units (m, kg, s, N, Pa, rad)".to_owned(),
            })
        }),
    }
}

/// What a number with a unit is in SI units.
pub(crate) fn quantity(number: &str, unit: &str) -> Option<String> {
    let known = UNITS.iter().find(|(name, ..)| *name == unit)?;
    let (_, [factor, divisor], si) = *known;
    // fifteen digits, all of which a product has: 0.03/1000 differs from 3e-5 in the last bit
    let value = exact(rounded(number.parse::<f64>().ok()? * factor / divisor, 15));
    Some(match (factor == divisor, unit) {
        (true, _) => format!("numbers have no unit, all are in SI units: write {number}"),
        (false, "°" | "deg" | "degree" | "degrees") => {
            format!("numbers have no unit; angles are in radians: {number} degrees are {value}")
        }
        (false, _) => {
            format!("numbers have no unit; {number} {unit} is {value} {si} in SI units")
        }
    })
}

/// How many bytes a number takes at the start of a text, with or without digits before and after its point.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let count = text[from..].bytes().take_while(u8::is_ascii_digit).count();
        from + count
    };
    let sign = |from: usize| from + usize::from(text[from..].starts_with(['+', '-']));
    let first = sign(0);
    let mut end = digits(first);
    let mut some = end > first;
    if text[end..].starts_with('.') {
        let after = digits(end + 1);
        some |= after > end + 1;
        end = after;
    }
    if !some {
        return 0;
    }
    if text[end..].starts_with(['e', 'E']) {
        let exponent = sign(end + 1);
        let after = digits(exponent);
        if after > exponent {
            end = after;
        }
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(line: &str) -> String {
        meant(line, true).map_or(String::new(), |(at, said)| format!("{}: {said}", &line[at]))
    }

    #[test]
    fn numbers_of_people_are_understood() {
        for (line, wanted) in [
            ("length = 0,25", "0,25: a number has a decimal point: 0.25"),
            (
                "length = -0,25 # m",
                "-0,25: a number has a decimal point: -0.25",
            ),
            (
                "a = { x = 0,5, y = 1 }",
                "0,5: a number has a decimal point: 0.5",
            ),
            (
                "c = 0.03mm",
                "0.03mm: numbers have no unit; 0.03 mm is 3e-5 m in SI units",
            ),
            (
                "c = 0.03 mm # play",
                "0.03 mm: numbers have no unit; 0.03 mm is 3e-5 m in SI units",
            ),
            (
                "c = 1e-3 m",
                "1e-3 m: numbers have no unit, all are in SI units: write 1e-3",
            ),
            (
                "E = 210GPa",
                "210GPa: numbers have no unit; 210 GPa is 210000000000 Pa in SI units",
            ),
            (
                "rho = 7.8 g/cm3",
                "7.8 g/cm3: numbers have no unit; 7.8 g/cm3 is 7800 kg/m3 in SI units",
            ),
            (
                "w = 3 furlongs",
                "3 furlongs: numbers have no unit: all are in SI units (m, kg, s, N, Pa, rad)",
            ),
            (
                "p = [0.1, 30°]",
                "30°: numbers have no unit; angles are in radians: 30 degrees are 0.523598775598299",
            ),
            (
                "x = .5",
                ".5: a number has digits on both sides of its decimal point: 0.5",
            ),
            (
                "x = { y = [-5., 1] }",
                "-5.: a number has digits on both sides of its decimal point: -5.0",
            ),
            (
                "x = 1.e-3",
                "1.e-3: a number has digits on both sides of its decimal point: 0.001",
            ),
            ("x = 01", "01: a number does not begin with zeros: 1"),
            (
                "x = \u{2212}2",
                "\u{2212}2: this minus sign is not that of a keyboard: write -2",
            ),
            (
                "x = 1/3",
                "1/3: a number is written with digits; only functions of time can be formulas, in quotes",
            ),
            (
                "x = 2pi",
                "2pi: a number is written with digits, 6.283185307179586; as a function of time write \"2*pi\", in quotes",
            ),
            ("type = ground", "ground: text stands in quotes: \"ground\""),
            ("motion = True", "True: `True` is written true"),
            (
                "  [0.0, 1mm],",
                "1mm: numbers have no unit; 1 mm is 0.001 m in SI units",
            ),
        ] {
            assert_eq!(said(line), wanted);
        }
    }

    #[test]
    fn characters_of_no_keyboard_are_named() {
        for (line, wanted) in [
            (
                "a\u{a0}= 1",
                "\u{a0}: this no-break space (U+00A0) is not that of a keyboard: write a space",
            ),
            (
                "a = “b”",
                "“: this quotation mark (U+201C) is not that of a keyboard: write \"",
            ),
            (
                "a = \"b”",
                "”: this quotation mark (U+201D) is not that of a keyboard: write \"",
            ),
            (
                "a = [\"–\", –1]",
                "–: this dash (U+2013) is not that of a keyboard: write -",
            ),
            ("a = \"b – c\" # “", ""),
            ("a = \"b – c", ""),
        ] {
            let said = first_lookalike(line);
            let said = said.map(|(at, said)| format!("{}: {said}", &line[at]));
            assert_eq!(said.unwrap_or_default(), wanted, "{line}");
        }
    }

    #[test]
    fn what_is_no_value_is_left_to_the_parser() {
        for line in [
            "length 0.25",
            "[bodies.ground",
            "title = \"0.03mm",
            "x = [1, 2]",
            "x = { a = 1, b = 2 }",
            "x = 1 # 0,5 or 3mm",
            "x = ",
        ] {
            assert_eq!(said(line), "", "{line}");
        }
    }

    /// No factor is off: with a divisor of 1 or a factor of 1, and the SI unit itself among the units.
    #[test]
    fn units_lead_to_units_of_si() {
        for (name, [factor, divisor], si) in UNITS {
            assert!(factor == 1.0 || divisor == 1.0 || factor == PI, "{name}");
            let itself = UNITS.iter().any(|(n, [a, b], _)| *n == si && a == b);
            assert!(itself || si == "N m", "{name}");
        }
    }
}
