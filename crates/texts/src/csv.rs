//! Cells of CSV (RFC 4180) that no spreadsheet takes for formulas.
//!
//! A text that begins as a formula gets an apostrophe in front, which spreadsheets show and do not evaluate; [`text_of`] takes it
//! away again. Blanks and apostrophes before the beginning of a formula do not hide it, so that every text is read back as it was.

use std::borrow::Cow;

/// What stands before a formula, so that it is none.
const APOSTROPHE: char = '\'';

/// True of a text that a spreadsheet would evaluate: it begins with `=`, `+`, `-` or `@`, in full width, too, or with a tab or an end
/// of a line, and is no number.
fn is_formula(text: &str) -> bool {
    let begin = text.trim_start_matches([' ', APOSTROPHE]);
    let begins = begin.starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠', '\t', '\r', '\n']);
    begins && !begin.parse::<f64>().is_ok_and(f64::is_finite)
}

/// A text as the content of a cell, without quotation marks.
pub fn content(text: &str) -> Cow<'_, str> {
    match is_formula(text) {
        true => Cow::Owned(format!("{APOSTROPHE}{text}")),
        false => Cow::Borrowed(text),
    }
}

/// The text that [`content`] was made of.
pub fn text_of(content: &str) -> &str {
    match content.strip_prefix(APOSTROPHE) {
        Some(text) if is_formula(text) => text,
        _ => content,
    }
}

/// A text as a cell, in quotation marks where they are needed.
pub fn cell(text: &str) -> Cow<'_, str> {
    let content = content(text);
    match content.contains([',', '"', '\n', '\r']) {
        true => Cow::Owned(format!("\"{}\"", content.replace('"', "\"\""))),
        false => content,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn formulas_are_texts() {
        for (text, written) in [
            ("=1+1", "'=1+1"),
            ("-x", "'-x"),
            ("-1+cmd|' /C calc'!A0", "'-1+cmd|' /C calc'!A0"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("  =1", "'  =1"),
            ("'=1", "''=1"),
            ("＝1", "'＝1"),
            ("-inf", "'-inf"),
            ("\t=1", "'\t=1"),
            ("-1.5e3", "-1.5e3"),
            ("+2", "+2"),
            ("a=1", "a=1"),
            ("'a", "'a"),
            ("a,b", "\"a,b\""),
            ("=\"a\"", "\"'=\"\"a\"\"\""),
            ("a\nb", "\"a\nb\""),
        ] {
            assert_eq!(cell(text), written);
        }
    }

    proptest! {
        /// A reader of CSV, and then ours, give the text back; no cell is a formula.
        #[test]
        fn cells_are_read_back(texts in prop::collection::vec("[-=+@' \t\r\n,\"1a\\PC]{0,6}", 2..5)) {
            let cells: Vec<_> = texts.iter().map(|text| cell(text)).collect();
            let line = cells.join(",") + "\n";
            let reader = ::csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes()).into_records();
            let records: Vec<_> = reader.collect::<Result<_, _>>().unwrap();
            prop_assert_eq!(records.len(), 1);
            let read: Vec<&str> = records[0].iter().map(text_of).collect();
            prop_assert_eq!(&read, &texts);
            for content in &records[0] {
                prop_assert!(content.starts_with('\'') || !is_formula(content));
            }
        }
    }
}
