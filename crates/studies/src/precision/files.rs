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
use looselink::output::{Folder, OutputError, TIMING, json};
use serde::Serialize;
use std::io;

/// Names of the files.
pub const FILES: [&str; 5] = [
    "precision.json",
    "precision.md",
    TIMING,
    "precision.svg",
    "precision.png",
];

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

impl Outcome {
    /// Writes all files, `precision.json` last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, study: &Study, folder: &Folder) -> Result<(), OutputError> {
        let machine = machine();
        let times = Times {
            machine: &machine,
            runs: self.times(),
        };
        let page = page(self, &machine);
        write(folder, self, page, &times, &figure(study, self))
    }
}

impl Survey {
    /// Writes all files, `precision.json` last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, study: &Study, folder: &Folder) -> Result<(), OutputError> {
        let machine = machine();
        let times = Times {
            machine: &machine,
            runs: self.times(),
        };
        let page = self.page(study, &machine);
        write(folder, self, page, &times, &self.figure(study))
    }
}

fn write(
    folder: &Folder,
    found: &impl Serialize,
    page: String,
    times: &Times,
    figure: &plot::Figure,
) -> Result<(), OutputError> {
    let [svg, png] = plot::render(figure).map_err(|e| io::Error::other(e.to_string()))?;
    folder.write(&[json(found)?, page.into_bytes(), json(times)?, svg, png])
}
