//! Texts that could do harm: each is refused by name before any run, or shown as it is, and all that is written can be read.

mod readers;
mod scenes;
mod studies;
mod terminal;

use serde::Deserialize;

/// A text of `corpus.toml`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct HostileText {
    text: String,
    refused: Option<String>,
    refused_as_name: Option<String>,
}

impl HostileText {
    /// The character for which it is no name in a study.
    fn refused_name(&self) -> Option<&str> {
        self.refused.as_deref().or(self.refused_as_name.as_deref())
    }
}

fn corpus() -> Vec<HostileText> {
    #[derive(Deserialize)]
    struct Corpus {
        texts: Vec<HostileText>,
    }
    let corpus: Corpus = toml::from_str(include_str!("corpus.toml")).unwrap();
    assert!(corpus.texts.len() >= 60);
    corpus.texts
}

/// A small scene with a contact.
fn scene() -> String {
    let text = include_str!("../../../../scenes/bouncing-journal.toml");
    let fewer = text.replace("duration = 0.02", "duration = 1.2e-3");
    fewer.replace("= 1.6e-6", "= 2e-5")
}

/// The scene with another title, in TOML.
fn titled(title: &str) -> String {
    let known = "\"a free journal bounces in its bearing\"";
    scene().replace(known, title)
}

/// A text of TOML in which no character stands as it is but letters, digits and blanks.
fn quoted(text: &str) -> String {
    let escaped = text.chars().map(|c| match c {
        c if c.is_ascii_alphanumeric() || c == ' ' => c.to_string(),
        c => format!("\\U{:08X}", u32::from(c)),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// Asserts that what is shown could not command a terminal.
#[track_caller]
fn assert_harmless(shown: &str, case: &str) {
    let found = shown.chars().find(|c| match u32::from(*c) {
        0x09 | 0x0a => false,
        0x00..0x20 | 0x7f..0xa0 | 0x2028..=0x202e | 0x2066..=0x2069 => true,
        code => matches!(code, 0xfff9..=0xfffb | 0xfffe..=0xffff),
    });
    assert_eq!(found, None, "{case}: {shown:?}");
}
