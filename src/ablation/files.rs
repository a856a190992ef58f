//! An ablation on disk.
//!
//! | file | content |
//! |---|---|
//! | `ablation.json` | every variant: its effects, what it does, the differences, sizes and work |
//! | `ablation.md` | the same as a page |
//! | `timing.json` | processor time of every variant, and the machine |
//! | `ablation.svg`, `ablation.png` | the picture, with processor time |
//!
//! The first two are the same bytes when the command is repeated.

use super::Ablation;
use super::picture::figure;
use crate::output::{OutputError, TIMING, json, naming, refuse_occupied, replace};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const ABLATION: &str = "ablation.json";
const PAGE: &str = "ablation.md";
const PICTURE: &str = "ablation";
const PICTURES: [&str; 2] = ["ablation.svg", "ablation.png"];

/// A folder that may receive an ablation.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// Looks at `path` without changing anything; with `replace` what stands there may be replaced.
    ///
    /// # Errors
    /// A result that may not be replaced, or a path that is not a folder.
    pub fn new(path: &Path, replace: bool) -> Result<Folder, OutputError> {
        let [svg, png] = PICTURES;
        refuse_occupied(path, &[ABLATION, PAGE, svg, png, TIMING], replace)?;
        Ok(Folder(path.to_owned()))
    }

    /// Writes all files; `ablation.json` comes last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, ablation: &Ablation) -> Result<(), OutputError> {
        let folder = &self.0;
        fs::create_dir_all(folder).map_err(|e| naming(folder, e))?;
        replace(folder, TIMING, &json(&ablation.timing())?)?;
        replace(folder, PAGE, ablation.markdown().as_bytes())?;
        plot::save(&figure(ablation), folder, PICTURE)
            .map_err(|e| io::Error::other(e.to_string()))?;
        replace(folder, ABLATION, &json(&ablation.repeatable())?)
    }
}
