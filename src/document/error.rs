//! Faults of a scene, each with the place it stands at.

use super::text::{Text, shortened};
use miette::{Diagnostic, LabeledSpan};
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::sync::Arc;
use texts::harmless_line;

/// Name of the text of an override.
const CHANGE: &str = "--set";

/// A piece of the scene text or of an override.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    source: u32,
    start: u32,
    len: u32,
}

impl Span {
    /// `range` in bytes of source number `source`.
    pub(crate) fn new(source: usize, range: Range<usize>) -> Span {
        // Scene files are limited to far less than 4 GiB; a longer override would be cut, never wrapped.
        let small = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Span {
            source: small(source),
            start: small(range.start),
            len: small(range.end.saturating_sub(range.start)),
        }
    }

    /// Number of the source: 0 is the file, overrides follow in their order.
    pub(crate) fn source(self) -> u32 {
        self.source
    }
}

/// The texts a scene was read from: the file is number 0, override k is number k + 1.
#[derive(Debug, Clone)]
pub(crate) struct Sources(Vec<Arc<Text>>);

impl Sources {
    pub(crate) fn new(name: &str, text: &str, overrides: &[String]) -> Sources {
        let mut sources = vec![Arc::new(Text::new(name, text))];
        sources.extend(overrides.iter().map(|o| Arc::new(Text::new(CHANGE, o))));
        Sources(sources)
    }

    /// The whole text of a source.
    pub(crate) fn text(&self, source: usize) -> &str {
        self.0[source].inner()
    }

    /// The overrides in order.
    pub(crate) fn overrides(&self) -> impl Iterator<Item = &str> {
        self.0[1..].iter().map(|s| s.inner())
    }

    /// The text that `span` covers.
    pub(crate) fn written(&self, span: Span) -> &str {
        let start = span.start as usize;
        self.text(span.source as usize)
            .get(start..start + span.len as usize)
            .unwrap_or("")
    }

    /// Hexadecimal SHA-256; every text is preceded by its length, so that no two lists of texts collide.
    pub(crate) fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        for source in &self.0 {
            hasher.update((source.inner().len() as u64).to_le_bytes());
            hasher.update(source.inner().as_bytes());
        }
        numbers::hexadecimal(&hasher.finalize())
    }
}

/// A fault of a scene: what is wrong, where, and what to do about it.
///
/// Printed with `miette` it shows file, line and column and underlines the offending text.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{message}")]
pub struct SceneError {
    message: String,
    #[help]
    help: Option<String>,
    /// The text in which it stands.
    text: Option<Arc<Text>>,
    /// The same where an excerpt of it may be shown.
    #[source_code]
    excerpt: Option<Arc<Text>>,
    /// What can be said without a word of a text that may be no scene.
    discreet: Option<Box<SceneError>>,
    /// The place, and one that contradicts it.
    #[label(collection)]
    labels: Vec<LabeledSpan>,
}

impl SceneError {
    /// A fault at `span`.
    pub(crate) fn new(
        sources: &Sources,
        span: Span,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> SceneError {
        let written = sources.written(span);
        let underlined = match shortened(written) {
            // the first line of what is too long to be shown
            short if short.len() < written.len() => short.lines().next().map_or(0, str::len),
            whole => whole.len(),
        };
        let label = LabeledSpan::new(Some(shown(label.into())), span.start as usize, underlined);
        let text = sources.0.get(span.source as usize).cloned();
        SceneError {
            message: shown(message.into()),
            help: None,
            excerpt: text.clone(),
            text,
            discreet: None,
            labels: vec![label],
        }
    }

    /// The same fault with a second place, which contradicts the first. Only one text can be shown: a place in another one
    /// is reported as advice.
    pub(crate) fn against(mut self, sources: &Sources, span: Span, label: &str) -> SceneError {
        let mut other = SceneError::new(sources, span, "", label);
        match (&self.text, &other.text) {
            (Some(one), Some(two)) if Arc::ptr_eq(one, two) => {
                self.labels.append(&mut other.labels);
                self
            }
            _ => {
                let (name, line, column) = other.place().unwrap_or_default();
                let label = other.labels[0].label().unwrap_or_default();
                let help = format!("{label}: {name}:{line}:{column}");
                self.with_help(help)
            }
        }
    }

    /// A fault of a file that could not be read at all.
    pub(crate) fn unreadable(message: String) -> SceneError {
        SceneError {
            message: shown(message),
            help: None,
            text: None,
            excerpt: None,
            discreet: None,
            labels: Vec::new(),
        }
    }

    /// The same fault with advice, after any that it has.
    pub fn with_help(mut self, help: impl Into<String>) -> SceneError {
        let help = shown(help.into());
        self.help = Some(match self.help {
            Some(before) => format!("{before}\n{help}"),
            None => help,
        });
        self
    }

    /// The same fault of a text that may be no scene at all; `discreet` says nothing that stands in it.
    pub(crate) fn or(mut self, discreet: SceneError) -> SceneError {
        self.discreet.get_or_insert(Box::new(discreet));
        self
    }

    /// The same fault of a file that another file names, which may be any file of the user: where it stands and what was expected,
    /// no excerpt, and of a file that is no scene not a word of what stands in it. A fault of an override stays as it is.
    #[must_use]
    pub fn without_contents(self) -> SceneError {
        let mut error = match self.discreet {
            Some(discreet) => *discreet,
            None => self,
        };
        if error.excerpt.is_none() || error.change().is_some() {
            return error;
        }
        let (name, line, column) = error.place().unwrap_or_default();
        let message = &error.message;
        error.message = shown(format!("`{name}`, line {line}, column {column}: {message}"));
        error.excerpt = None;
        error
    }

    /// File, line and column (both from 1, columns in characters), if the fault stands in a text.
    pub fn place(&self) -> Option<(&str, usize, usize)> {
        let (text, span) = (self.text.as_ref()?, self.labels.first()?);
        let (line, column, _) = text.place(span.offset())?;
        Some((text.name(), line + 1, column + 1))
    }

    /// The advice that was added.
    pub fn advice(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The override `path=value` in which it stands, if it does not stand in the file.
    pub fn change(&self) -> Option<&str> {
        let text = self.text.as_ref()?;
        (text.name() == CHANGE).then(|| text.inner())
    }

    /// The text that is underlined.
    pub fn underlined(&self) -> &str {
        let (Some(text), Some(span)) = (&self.excerpt, self.labels.first()) else {
            return "";
        };
        text.inner()
            .get(span.offset()..span.offset() + span.len())
            .unwrap_or("")
    }
}

/// A message that may quote what users wrote: in one line, without characters that could do harm, and of something long without the
/// rest of it.
fn shown(message: String) -> String {
    match shortened(&message) {
        short if short.len() < message.len() => format!("{} ...", harmless_line(short)),
        whole => harmless_line(whole).into_owned(),
    }
}

/// Words in double quotes, with commas between them.
pub(crate) fn quoted<'w>(words: impl IntoIterator<Item = &'w str>) -> String {
    let words: Vec<_> = words.into_iter().map(|w| format!("{w:?}")).collect();
    words.join(", ")
}
