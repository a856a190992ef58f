//! Studies of a scene: how much processor time each accuracy costs ([`precision`]), what each effect contributes and costs
//! ([`ablation`]), and what a scene does over ranges of its values ([`sweep`]).
#![forbid(unsafe_code)]

pub mod ablation;
pub mod machine;
pub mod precision;
mod study_file;
mod study_texts;
pub mod sweep;

pub use study_file::StudyError;

use folder::OutputError;
use plot::Figure;
use std::io;
use texts::markdown::line;

/// A figure as the bytes of an SVG file and, with the feature `png`, of a PNG file.
pub(crate) fn pictures(figure: &Figure) -> Result<(Vec<u8>, Option<Vec<u8>>), OutputError> {
    let svg = plot::svg(figure);
    let png = plot::png(&svg).map_err(|e| io::Error::other(e.to_string()))?;
    Ok((svg.into_bytes(), png))
}

/// Warnings of several runs as a part of a page in Markdown; empty where no run warns.
pub(crate) fn warning_list(warnings: &[String]) -> String {
    let lines = warnings
        .iter()
        .map(|warning| format!("* {}\n", line(warning)));
    match warnings.is_empty() {
        true => String::new(),
        false => format!("\nWarnings:\n\n{}", lines.collect::<String>()),
    }
}
