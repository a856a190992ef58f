//! An ablation on disk.
//!
//! | file | content |
//! |---|---|
//! | `ablation.json` | every variant: its effects, what it does, the differences, sizes and work |
//! | `ablation.md` | the same as a page |
//! | `timing.json` | processor time of every variant, and the machine |
//! | `ablation.svg`, `ablation.png` | the picture, with processor time |
//!
//! The first two are the same bytes when the command is repeated. `ablation.json` comes last: without it there is no result.
//! A result that is replaced stands in `previous-result` inside the folder until then.

use super::Ablation;
use super::picture::figure;
use crate::output::{OutputError, TIMING, json, prepare, refuse_occupied, write_result};
use std::io;
use std::path::{Path, PathBuf};

const ABLATION: &str = "ablation.json";
const PAGE: &str = "ablation.md";
const PICTURES: [&str; 2] = ["ablation.svg", "ablation.png"];

/// A folder that may receive an ablation.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    replace: bool,
}

impl Folder {
    /// Looks at `path` without changing anything; with `replace` what stands there may be replaced.
    ///
    /// # Errors
    /// A result that may not be replaced, or a path that is not a folder.
    pub fn new(path: &Path, replace: bool) -> Result<Folder, OutputError> {
        let [svg, png] = PICTURES;
        refuse_occupied(path, &[ABLATION, PAGE, svg, png, TIMING], replace)?;
        Ok(Folder {
            path: path.to_owned(),
            replace,
        })
    }

    /// Creates the folder, so that one that cannot be written is known before the runs.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn prepare(&self) -> Result<(), OutputError> {
        prepare(&self.path)
    }

    /// Writes all files; `ablation.json` comes last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, ablation: &Ablation) -> Result<(), OutputError> {
        let pictures =
            plot::render(&figure(ablation)).map_err(|e| io::Error::other(e.to_string()))?;
        let mut files = vec![
            (ABLATION, json(&ablation.repeatable())?),
            (PAGE, ablation.markdown().into_bytes()),
            (TIMING, json(&ablation.timing())?),
        ];
        files.extend(PICTURES.into_iter().zip(pictures));
        write_result(&self.path, &files, self.replace)
    }
}
