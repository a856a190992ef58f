//! Faults of a scene, each with the place it stands at.

use miette::{Diagnostic, NamedSource, SourceSpan};
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::sync::Arc;

/// A piece of the scene text or of an override.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    source: u32,
    start: u32,
    len: u32,
}

impl Span {
    /// `range` in bytes of source number `source`.
    pub(super) fn new(source: usize, range: Range<usize>) -> Span {
        // Scene files are limited to far less than 4 GiB; a longer override would be cut, never wrapped.
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Span {
            source: small(source),
            start: small(range.start),
            len: small(range.end.saturating_sub(range.start)),
        }
    }

    /// Number of the source: 0 is the file, overrides follow in their order.
    pub(super) fn source(self) -> u32 {
        self.source
    }
}

/// The texts a scene was read from: the file is number 0, override k is number k + 1.
#[derive(Debug, Clone)]
pub(super) struct Sources(Vec<Arc<NamedSource<String>>>);

impl Sources {
    pub(super) fn new(name: &str, text: &str, overrides: &[String]) -> Sources {
        let mut sources = vec![Arc::new(NamedSource::new(name, text.to_owned()))];
        sources.extend(
            overrides
                .iter()
                .map(|o| Arc::new(NamedSource::new("--set", o.clone()))),
        );
        Sources(sources)
    }

    /// The whole text of a source.
    pub(super) fn text(&self, source: usize) -> &str {
        self.0[source].inner()
    }

    /// The overrides in order.
    pub(super) fn overrides(&self) -> impl Iterator<Item = &str> {
        self.0[1..].iter().map(|s| s.inner().as_str())
    }

    /// The text that `span` covers.
    pub(super) fn written(&self, span: Span) -> &str {
        let start = span.start as usize;
        self.text(span.source as usize)
            .get(start..start + span.len as usize)
            .unwrap_or("")
    }

    /// Hexadecimal SHA-256; every text is preceded by its length, so that no two lists of texts collide.
    pub(super) fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        for source in &self.0 {
            hasher.update((source.inner().len() as u64).to_le_bytes());
            hasher.update(source.inner().as_bytes());
        }
        hasher
            .finalize()
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }
}

/// A fault of a scene: what is wrong, where, and what to do about it.
///
/// Printed with `miette` it shows file, line and column and underlines the offending text.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{message}")]
pub struct SceneError {
    message: String,
    label: String,
    #[help]
    help: Option<String>,
    #[source_code]
    text: Option<Arc<NamedSource<String>>>,
    #[label("{label}")]
    span: Option<SourceSpan>,
}

impl SceneError {
    /// A fault at `span`.
    pub(super) fn new(sources: &Sources, span: Span, message: String, label: String) -> SceneError {
        SceneError {
            message,
            label,
            help: None,
            text: sources.0.get(span.source as usize).cloned(),
            span: Some((span.start as usize, span.len as usize).into()),
        }
    }

    /// A fault of a file that could not be read at all.
    pub(super) fn unreadable(message: String) -> SceneError {
        SceneError {
            message,
            label: String::new(),
            help: None,
            text: None,
            span: None,
        }
    }

    /// The same fault with advice.
    pub fn with_help(mut self, help: impl Into<String>) -> SceneError {
        self.help = Some(help.into());
        self
    }

    /// File, line and column (both from 1, columns in characters), if the fault stands in a text.
    pub fn place(&self) -> Option<(&str, usize, usize)> {
        let (text, span) = (self.text.as_ref()?, self.span?);
        let before = text.inner().get(..span.offset())?;
        let line_start = before.rfind('\n').map_or(0, |n| n + 1);
        let line = before.matches('\n').count() + 1;
        Some((text.name(), line, before[line_start..].chars().count() + 1))
    }

    /// The text that is underlined.
    pub fn underlined(&self) -> &str {
        let (Some(text), Some(span)) = (&self.text, self.span) else {
            return "";
        };
        text.inner()
            .get(span.offset()..span.offset() + span.len())
            .unwrap_or("")
    }
}

/// The known name nearest to `name`, when it is near enough to be meant.
pub(super) fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    // A third of the letters may differ: `lenght` finds `length`, `mass` does not find `model`.
    let limit = ((name.chars().count() + 1) / 3).max(1);
    known
        .into_iter()
        .map(|k| {
            (
                strsim::damerau_levenshtein(&name.to_lowercase(), &k.to_lowercase()),
                k,
            )
        })
        .filter(|(distance, _)| *distance <= limit)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

/// The end of a message about an unknown name: a suggestion, or nothing.
pub(super) fn did_you_mean<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> String {
    nearest(name, known).map_or(String::new(), |k| format!("; did you mean `{k}`?"))
}
