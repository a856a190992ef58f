//! An ablation on disk.
//!
//! | file | content |
//! |---|---|
//! | `ablation.json` | every variant: its effects, what it does, the differences, sizes and work |
//! | `ablation.md` | the same as a page |
//! | `timing.json` | processor time of every variant, and the machine |
//! | `ablation.svg` and, with the feature `png`, `ablation.png` | the picture, with processor time |
//!
//! The first two are the same bytes when the command is repeated. `ablation.json` comes last: without it there is no result.
//! A result that is replaced stands in `previous-result` inside the folder until then.

use super::Ablation;
use super::picture::figure;
use crate::pictures;
use folder::{Folder, Kind, OutputError, json};
use looselink::output::TIMING;

/// Names of the files.
const FILES: [&str; 5] = [
    "ablation.json",
    "ablation.md",
    TIMING,
    "ablation.svg",
    "ablation.png",
];

/// An ablation as a kind of result.
pub fn kind() -> Kind {
    Kind {
        name: "an ablation",
        files: FILES.map(str::to_owned).to_vec(),
    }
}

impl Ablation {
    /// Writes all files, `ablation.json` last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, folder: Folder) -> Result<(), OutputError> {
        let (svg, png) = pictures(&figure(self))?;
        let mut texts = vec![
            json(&self.repeatable())?,
            self.markdown().into_bytes(),
            json(&self.timing())?,
            svg,
        ];
        texts.extend(png);
        folder.write(&texts)
    }
}
