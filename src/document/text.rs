//! A text with its name, as faults show it: of long lines only what surrounds the fault, and no character that could do harm.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use texts::{harmful, harmless_line};

/// Bytes shown on each side of a fault, of its label and of its message. A line may be a table of a megabyte.
const SHOWN: usize = 400;

/// A scene or an override.
#[derive(Debug)]
pub(crate) struct Text {
    name: String,
    text: String,
    /// The text with question marks in place of the bytes of characters that could do harm, where there are any: bytes stay where
    /// they are.
    masked: Option<String>,
}

impl Text {
    pub(crate) fn new(name: &str, text: &str) -> Text {
        let mut masked = None;
        for (at, c) in harmful(text) {
            let masked = masked.get_or_insert_with(|| text.to_owned());
            masked.replace_range(at..at + c.len_utf8(), &"?".repeat(c.len_utf8()));
        }
        Text {
            name: name.to_owned(),
            text: text.to_owned(),
            masked,
        }
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn inner(&self) -> &str {
        &self.text
    }

    /// Line and column of a byte, from 0, columns in characters, and the byte its line starts at.
    pub(crate) fn place(&self, byte: usize) -> Option<(usize, usize, usize)> {
        let before = self.inner().get(..byte)?;
        let start = before.rfind('\n').map_or(0, |n| n + 1);
        let line = before.matches('\n').count();
        Some((line, before[start..].chars().count(), start))
    }
}

impl SourceCode for Text {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let shown = self.masked.as_ref().unwrap_or(&self.text);
        let whole = shown.read_span(span, lines_before, lines_after)?;
        let named = |data, span, line, column, count| {
            let name = harmless_line(&self.name).into_owned();
            let contents = MietteSpanContents::new_named(name, data, span, line, column, count);
            Ok(Box::new(contents) as Box<dyn SpanContents>)
        };
        if whole.data().len() <= 4 * SHOWN {
            let (line, column) = (whole.line(), whole.column());
            return named(
                whole.data(),
                *whole.span(),
                line,
                column,
                whole.line_count(),
            );
        }
        let (line, column, start) = self.place(span.offset()).ok_or(MietteError::OutOfBounds)?;
        let from = start.max(boundary(shown, span.offset().saturating_sub(SHOWN)));
        let end = span.offset() + span.len() + SHOWN;
        let line_end = shown[from..].find('\n').map_or(shown.len(), |n| from + n);
        let to = boundary(shown, end.min(line_end));
        let column = if lines_before == 0 { column } else { 0 };
        named(
            &shown.as_bytes()[from..to],
            (from, to - from).into(),
            line,
            column,
            1,
        )
    }
}

/// The beginning of what may be long.
pub(crate) fn shortened(text: &str) -> &str {
    &text[..boundary(text, 2 * SHOWN)]
}

/// The last boundary of a character at or before a byte.
fn boundary(text: &str, byte: usize) -> usize {
    let at_most = byte.min(text.len());
    (0..=at_most)
        .rev()
        .find(|byte| text.is_char_boundary(*byte))
        .unwrap_or(0)
}
