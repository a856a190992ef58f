//! Markdown (CommonMark with the tables of GitHub): texts that show themselves and nothing else, no HTML, no links, no second line.
//!
//! What stands in code spans is shown as it is, so those of a text stay.

use crate::harmless_line;

/// A text within a line.
pub fn text(text: &str) -> String {
    written(&harmless_line(text.trim()))
}

/// A text in a cell of a table. What stands between its bars is written piece by piece: not even a code span may hold every bar.
pub fn cell(text: &str) -> String {
    let line = harmless_line(text.trim());
    let pieces: Vec<String> = line.split('|').map(written).collect();
    pieces.join("\\|")
}

/// A text that begins a line, as in a list.
pub fn line(text: &str) -> String {
    let line = self::text(text);
    let digits = line.trim_start_matches(|c: char| c.is_ascii_digit());
    let counted = digits.starts_with(['.', ')']) && digits.len() < line.len();
    match line.starts_with(['+', '-', '=', '>']) {
        true => format!("\\{line}"),
        false if counted => format!("{}\\{digits}", &line[..line.len() - digits.len()]),
        false => line,
    }
}

/// A text as a code span.
pub fn code(text: &str) -> String {
    span(&harmless_line(text))
}

/// A piece of a line with a backslash before every character that has a meaning outside of code spans.
fn written(piece: &str) -> String {
    // programs make links of addresses, however their characters are written
    let has_address = ["://", "www.", "mailto:", "@"];
    if has_address.iter().any(|mark| piece.contains(mark)) {
        return span(piece);
    }
    let mut written = String::new();
    let mut rest = piece;
    while let Some(at) = rest.find('`') {
        let (before, marked) = rest.split_at(at);
        let (own, after) = match code_span(marked) {
            Some(length) => marked.split_at(length),
            None => marked.split_at(run(marked)),
        };
        let is_span = !own.trim_matches('`').is_empty();
        written += &plain(before);
        written += &if is_span {
            own.to_owned()
        } else {
            "\\`".repeat(own.len())
        };
        rest = after;
    }
    written + &plain(rest)
}

/// Text outside of code spans.
fn plain(text: &str) -> String {
    let is_word = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    let (mut escaped, mut before) = (String::new(), None);
    let mut rest = text.chars();
    while let Some(c) = rest.next() {
        let after = rest.clone().next();
        let is_special = match c {
            '\\' | '*' | '[' | ']' | '<' | '~' | '#' => true,
            // within a word it is itself
            '_' => !(is_word(before) && is_word(after)),
            '&' => after == Some('#') || is_word(after),
            _ => false,
        };
        if is_special {
            escaped.push('\\');
        }
        escaped.push(c);
        before = Some(c);
    }
    escaped
}

/// The number of backticks at the beginning.
fn run(text: &str) -> usize {
    text.len() - text.trim_start_matches('`').len()
}

/// The length of the code span at the beginning: it ends at the next run of as many backticks.
fn code_span(text: &str) -> Option<usize> {
    let fence = run(text);
    let mut at = fence;
    while let Some(next) = text[at..].find('`') {
        at += next;
        let length = run(&text[at..]);
        at += length;
        if length == fence {
            return Some(at);
        }
    }
    None
}

/// A line as a code span: longer runs of backticks than any inside, and blanks where one stands at an end.
fn span(line: &str) -> String {
    let runs = line.split(|c| c != '`').map(str::len);
    let fence = "`".repeat(runs.max().unwrap_or(0) + 1);
    let has_blanks = line.starts_with(' ') && line.ends_with(' ') && !line.trim().is_empty();
    let blank = match has_blanks || line.starts_with('`') || line.ends_with('`') || line.is_empty()
    {
        true => " ",
        false => "",
    };
    format!("{fence}{blank}{line}{blank}{fence}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::markdown::mdast::{InlineCode, Node, Text};
    use ::markdown::{ParseOptions, to_mdast};
    use proptest::prelude::*;

    #[test]
    fn texts_of_our_own_stay_as_they_are() {
        for own in [
            "`integrator.step` must be greater than zero",
            "Bathe, onsets not located",
            "peak_force of B1.force (run 3): 2 % & more",
            "+ friction (on clearance)",
        ] {
            assert_eq!(cell(own), own);
        }
        assert_eq!(line("+ friction"), "\\+ friction");
        assert_eq!(line("1. step"), "1\\. step");
        assert_eq!(cell("a|b `c` `d|e`"), "a\\|b `c` \\`d\\|e\\`");
        assert_eq!(code("a`b"), "``a`b``");
        assert_eq!(text("https://x.y/z"), "`https://x.y/z`");
    }

    /// What a reader sees of the headings, cells and items of a page; code spans as their content.
    fn seen(node: &Node, blocks: &mut Vec<String>) -> Result<(), String> {
        match node {
            Node::Heading(_) | Node::TableCell(_) | Node::ListItem(_) => blocks.push(String::new()),
            Node::Root(_) | Node::Table(_) | Node::TableRow(_) | Node::Paragraph(_) => {}
            Node::List(list) if !list.ordered => {}
            Node::Text(Text { value, .. }) | Node::InlineCode(InlineCode { value, .. }) => {
                *blocks.last_mut().ok_or("outside")? += value;
            }
            other => return Err(format!("{other:?}")),
        }
        let parts = node.children().into_iter().flatten();
        parts.into_iter().try_for_each(|part| seen(part, blocks))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// In headings, tables and lists a text is seen as it is, but for blanks at its ends and the marks of code spans, and
        /// nothing else is.
        #[test]
        fn texts_are_seen_as_they_are(text in "([-+*_`~#<>|&;:/.)(\\]\\[!\\\\a1@^\\PC ]|http://a|www.a|a@b.c){0,12}") {
            let page = format!(
                "# {}\n\n| a | b |\n| --- | --- |\n| {} | {} |\n\n* {}\n",
                super::text(&text), cell(&text), cell(&code(&text)), line(&text)
            );
            let parsed = to_mdast(&page, &ParseOptions::gfm()).unwrap();
            let mut blocks = Vec::new();
            let others = seen(&parsed, &mut blocks);
            prop_assert_eq!(others, Ok(()), "{}", page);
            let unmarked = |text: &str| text.replace(['`', ' '], "");
            let found: Vec<String> = blocks.iter().map(|block| unmarked(block)).collect();
            let wanted = unmarked(&harmless_line(text.trim()));
            let whole = unmarked(&harmless_line(&text));
            prop_assert_eq!(found, [&*wanted, "a", "b", &*wanted, &*whole, &*wanted], "{}", page);
        }
    }
}
