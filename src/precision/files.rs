//! A study on disk.
//!
//! | file | content |
//! |---|---|
//! | `precision.json` | errors, work and warnings of all points |
//! | `timing.json` | the processor time of every timed run, and the machine |
//! | `precision.md` | both as a table, and the warnings |
//! | `precision.svg`, `precision.png` | the diagrams |
//!
//! The first is the same bytes when the study is repeated. It comes last: without it there is no result. A result that is
//! replaced stands in `previous-result` inside the folder until then.

use super::{Outcome, Pace, Study, Survey, Timing, figure, page};
use crate::machine::{Machine, machine};
use crate::output::{OutputError, TIMING, json, prepare, refuse_occupied, write_result};
use serde::Serialize;
use std::io;
use std::path::{Path, PathBuf};

const PRECISION: &str = "precision.json";
const PAGE: &str = "precision.md";
const PICTURES: [&str; 2] = ["precision.svg", "precision.png"];

/// A folder that may receive a study.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    replace: bool,
}

#[derive(Serialize)]
struct Times<'a> {
    machine: &'a Machine,
    runs: Vec<Time<'a>>,
}

/// The time of a point of a curve.
#[derive(Debug, Serialize)]
pub struct Time<'a> {
    curve: &'a str,
    pace: Pace,
    /// Absent for a run that failed.
    timing: Option<&'a Timing>,
}

impl<'a> Time<'a> {
    pub(super) fn of(
        runs: impl Iterator<Item = (&'a str, Pace)>,
        timings: &'a [Option<Timing>],
    ) -> Vec<Time<'a>> {
        let times = runs.zip(timings).map(|((curve, pace), timing)| Time {
            curve,
            pace,
            timing: timing.as_ref(),
        });
        times.collect()
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

    /// Writes all files, `precision.json` last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, study: &Study, outcome: &Outcome) -> Result<(), OutputError> {
        let machine = machine();
        let times = Times {
            machine: &machine,
            runs: outcome.times(),
        };
        let page = page(outcome, &machine);
        self.write_all(&times, page, &figure(study, outcome), outcome)
    }

    /// As [`Folder::write`], of a study of statistics.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write_survey(&self, study: &Study, survey: &Survey) -> Result<(), OutputError> {
        let machine = machine();
        let times = Times {
            machine: &machine,
            runs: survey.times(),
        };
        let page = survey.page(study, &machine);
        self.write_all(&times, page, &survey.figure(study), survey)
    }

    fn write_all(
        &self,
        times: &Times,
        page: String,
        figure: &plot::Figure,
        found: &impl Serialize,
    ) -> Result<(), OutputError> {
        let pictures = plot::render(figure).map_err(|e| io::Error::other(e.to_string()))?;
        let mut files = vec![
            (PRECISION, json(found)?),
            (PAGE, page.into_bytes()),
            (TIMING, json(times)?),
        ];
        files.extend(PICTURES.into_iter().zip(pictures));
        write_result(&self.path, &files, self.replace)
    }
}
