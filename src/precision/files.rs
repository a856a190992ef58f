//! A study on disk.
//!
//! | file | content |
//! |---|---|
//! | `precision.json` | errors and work of all points |
//! | `timing.json` | their processor times, and the machine |
//! | `precision.md` | both as tables |
//! | `precision.svg`, `precision.png` | the diagrams |
//!
//! The first is the same bytes when the study is repeated.

use super::{Outcome, Pace, Study, Survey, Timing, figure, page};
use crate::machine::{Machine, machine};
use crate::output::{OutputError, TIMING, json, naming, refuse_occupied, replace};
use serde::Serialize;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const PRECISION: &str = "precision.json";
const PAGE: &str = "precision.md";
const PICTURE: &str = "precision";
const PICTURES: [&str; 2] = ["precision.svg", "precision.png"];

/// A folder that may receive a study.
#[derive(Debug)]
pub struct Folder(PathBuf);

#[derive(Serialize)]
struct Times<'a> {
    machine: &'a Machine,
    runs: Vec<Time<'a>>,
}

#[derive(Serialize)]
struct Time<'a> {
    curve: &'a str,
    pace: Pace,
    seconds: Option<Timing>,
}

impl<'a> Times<'a> {
    fn new(
        machine: &'a Machine,
        runs: impl Iterator<Item = (&'a str, Pace)>,
        seconds: &[Option<Timing>],
    ) -> Times<'a> {
        let runs = runs.zip(seconds).map(|((curve, pace), seconds)| Time {
            curve,
            pace,
            seconds: *seconds,
        });
        Times {
            machine,
            runs: runs.collect(),
        }
    }
}

impl Folder {
    /// Looks at `path` without changing anything; with `replace` what stands there may be replaced.
    ///
    /// # Errors
    /// A result that may not be replaced, or a path that is not a folder.
    pub fn new(path: &Path, replace: bool) -> Result<Folder, OutputError> {
        let [svg, png] = PICTURES;
        refuse_occupied(path, &[PRECISION, PAGE, svg, png, TIMING], replace)?;
        Ok(Folder(path.to_owned()))
    }

    /// Writes all files, `precision.json` last, and returns the page.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, study: &Study, outcome: &Outcome) -> Result<String, OutputError> {
        let machine = machine();
        let runs = outcome.runs.iter().map(|run| (&*run.curve, run.pace));
        let times = Times::new(&machine, runs, &outcome.timings);
        let page = page(outcome, &machine);
        self.write_all(&times, page, &figure(study, outcome), outcome)
    }

    /// As [`Folder::write`], of a study of statistics.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_survey(&self, study: &Study, survey: &Survey) -> Result<String, OutputError> {
        let machine = machine();
        let runs = survey.runs.iter().map(|run| (&*run.curve, run.pace));
        let times = Times::new(&machine, runs, &survey.timings);
        let page = survey.page(study, &machine);
        self.write_all(&times, page, &survey.figure(study), survey)
    }

    fn write_all(
        &self,
        times: &Times,
        page: String,
        figure: &plot::Figure,
        found: &impl Serialize,
    ) -> Result<String, OutputError> {
        let folder = &self.0;
        fs::create_dir_all(folder).map_err(|e| naming(folder, e))?;
        replace(folder, TIMING, &json(times)?)?;
        replace(folder, PAGE, page.as_bytes())?;
        plot::save(figure, folder, PICTURE).map_err(|e| io::Error::other(e.to_string()))?;
        replace(folder, PRECISION, &json(found)?)?;
        Ok(page)
    }
}
