//! A text with its name, as faults show it: of long lines only what surrounds the fault.

use miette::{MietteError, MietteSpanContents, NamedSource, SourceCode, SourceSpan, SpanContents};

/// Bytes shown on each side of a fault, of its label and of its message. A line may be a table of a megabyte.
const SHOWN: usize = 400;

/// A scene, a study or an override.
#[derive(Debug)]
pub(crate) struct Text(NamedSource<String>);

impl Text {
    pub(crate) fn new(name: &str, text: &str) -> Text {
        Text(NamedSource::new(name, text.to_owned()))
    }

    pub(crate) fn name(&self) -> &str {
        self.0.name()
    }

    pub(crate) fn inner(&self) -> &str {
        self.0.inner()
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
        let whole = self.0.read_span(span, lines_before, lines_after)?;
        if whole.data().len() <= 4 * SHOWN {
            return Ok(whole);
        }
        let text = self.inner();
        let (line, column, start) = self.place(span.offset()).ok_or(MietteError::OutOfBounds)?;
        let from = start.max(boundary(text, span.offset().saturating_sub(SHOWN)));
        let end = span.offset() + span.len() + SHOWN;
        let line_end = text[from..].find('\n').map_or(text.len(), |n| from + n);
        let to = boundary(text, end.min(line_end));
        Ok(Box::new(MietteSpanContents::new_named(
            self.name().to_owned(),
            &text.as_bytes()[from..to],
            (from, to - from).into(),
            line,
            if lines_before == 0 { column } else { 0 },
            1,
        )))
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
