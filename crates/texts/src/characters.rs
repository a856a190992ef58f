//! Characters that do something other than show themselves.

use std::borrow::Cow;

/// Control characters, which command terminals and which XML 1.0 forbids; separators of lines that only some programs take for
/// such; overrides and isolates of the direction, which show a text in another order than it is read; annotations, which hide a
/// part of it; and code points that Unicode keeps free of characters. Tabs and line feeds do no harm.
fn is_harmful(c: char) -> bool {
    match c {
        '\t' | '\n' => false,
        '\u{2028}' | '\u{2029}' => true,
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        '\u{fff9}'..='\u{fffb}' | '\u{fdd0}'..='\u{fdef}' => true,
        c => c.is_control() || u32::from(c) & 0xfffe == 0xfffe,
    }
}

/// True of a character that is not seen, so that two names which differ by it look alike: those that Unicode lets programs ignore
/// (`Default_Ignorable_Code_Point` of Unicode 16).
pub fn is_invisible(c: char) -> bool {
    matches!(
        u32::from(c),
        0xad | 0x34f
            | 0x61c
            | 0x115f..=0x1160
            | 0x17b4..=0x17b5
            | 0x180b..=0x180f
            | 0x200b..=0x200f
            | 0x202a..=0x202e
            | 0x2060..=0x206f
            | 0x3164
            | 0xfe00..=0xfe0f
            | 0xfeff
            | 0xffa0
            | 0xfff0..=0xfff8
            | 0x1bca0..=0x1bca3
            | 0x1d173..=0x1d17a
            | 0xe0000..=0xe0fff
    )
}

/// The characters of a text that could do harm, and where they stand. The carriage return of a line that ends as on Windows is none.
pub fn harmful(text: &str) -> impl Iterator<Item = (usize, char)> {
    let ends_line = |at: usize| text[at..].starts_with("\r\n");
    let found = text.char_indices();
    found.filter(move |(at, c)| is_harmful(*c) && !ends_line(*at))
}

/// The first character that could do harm in a text of one line, in which a line feed does.
pub fn harmful_in_line(text: &str) -> Option<char> {
    let line_feed = text.contains('\n').then_some('\n');
    harmful(text).map(|(_, c)| c).next().or(line_feed)
}

/// A character as Unicode calls it, such as `U+001B`.
fn code_point(c: char) -> String {
    format!("U+{:04X}", u32::from(c))
}

/// A character that could do harm, and what it is, such as `U+001B, a control character`.
pub fn described(c: char) -> String {
    let what = match c {
        '\u{2028}' | '\u{2029}' => "a separator of lines",
        '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => "which turns the direction of a text",
        '\u{fff9}'..='\u{fffb}' => "which hides a part of a text",
        '\n' => "a line feed",
        c if c.is_control() => "a control character",
        c if is_invisible(c) => "which is invisible",
        _ => "which is no character",
    };
    format!("{}, {what}", code_point(c))
}

/// A text for a terminal: characters that could do harm are called by their code points, and lines end with a line feed.
pub fn harmless(text: &str) -> Cow<'_, str> {
    if text.chars().all(|c| !is_harmful(c)) {
        return Cow::Borrowed(text);
    }
    let unix = text.replace("\r\n", "\n");
    let shown = unix.chars().map(|c| match is_harmful(c) {
        true => code_point(c),
        false => c.to_string(),
    });
    Cow::Owned(shown.collect())
}

/// The same in one line: a line feed is called by its code point, too, so that a text cannot pretend to be two messages.
pub fn harmless_line(text: &str) -> Cow<'_, str> {
    match harmless(text) {
        line if line.contains('\n') => Cow::Owned(line.replace('\n', &code_point('\n'))),
        line => line,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_harm_is_called_by_its_code_point() {
        for (text, shown) in [
            ("\u{1b}[2J", "U+001B[2J"),
            ("a\u{7}\u{8}\u{7f}\u{9b}", "aU+0007U+0008U+007FU+009B"),
            ("a\u{202e}b\u{2066}", "aU+202EbU+2066"),
            (
                "\u{2028}\u{fffe}\u{1ffff}\u{fdd0}",
                "U+2028U+FFFEU+1FFFFU+FDD0",
            ),
            ("a\rb\r\nc\r", "aU+000Db\ncU+000D"),
            ("tab\tand\nline", "tab\tand\nline"),
            ("Kurbel ä, 曲柄, 👩‍🔬", "Kurbel ä, 曲柄, 👩‍🔬"),
        ] {
            assert_eq!(harmless(text), shown);
            assert_eq!(harmful(&harmless(text)).count(), 0, "{text:?}");
        }
        let places: Vec<_> = harmful("a\r\n\u{1b}\r").collect();
        assert_eq!(places, [(3, '\u{1b}'), (4, '\r')]);
        assert_eq!(harmless_line("a\nb\r\n"), "aU+000AbU+000A");
    }
}
