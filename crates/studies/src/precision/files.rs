//! A study on disk.
//!
//! | file | content |
//! |---|---|
//! | `precision.json` | errors, work and warnings of all points |
//! | `timing.json` | the processor time of every timed run, and the machine |
//! | `precision.md` | both as a table, and the warnings |
//! | `precision.svg` and, with the feature `png`, `precision.png` | the diagrams |
//!
//! The first is the same bytes when the study is repeated. It comes last: without it there is no result. A result that is
//! replaced stands in `previous-result` inside the folder until then.

use super::{Compared, Found, RunTiming, Study, StudyPace};
use crate::machine::Machine;
use crate::{pictures, warning_list};
use folder::{Folder, Kind, OutputError, json};
use looselink::output::TIMING;
use serde::Serialize;
use texts::markdown::text;

/// Names of the files.
const FILES: [&str; 5] = [
    "precision.json",
    "precision.md",
    TIMING,
    "precision.svg",
    "precision.png",
];

/// A study as a kind of result.
pub fn kind() -> Kind {
    Kind {
        name: "a study of precision",
        files: FILES.map(str::to_owned).to_vec(),
    }
}

/// What the processor times of a table are.
const TIMES: &str = "Processor time of the integration on one core, without reading and compiling \
    the scene: the median over the number of runs in column `runs`, after one that is not timed; `timing.json` has every single time.";

#[derive(Serialize)]
struct Times<'a> {
    machine: &'a Machine,
    runs: Vec<Time<'a>>,
}

/// The time of a point of a curve.
#[derive(Debug, Serialize)]
pub struct Time<'a> {
    curve: &'a str,
    pace: StudyPace,
    /// Absent for a run that failed.
    timing: Option<&'a RunTiming>,
}

impl<C: Compared> Found<C> {
    /// The time of every point.
    pub fn times(&self) -> Vec<Time<'_>> {
        let runs = self.runs.iter().zip(&self.timings);
        let times = runs.map(|(run, timing)| Time {
            curve: &run.curve,
            pace: run.pace,
            timing: timing.as_ref(),
        });
        times.collect()
    }

    /// A page with the diagrams and the table, and where it was measured.
    pub fn page(&self, study: &Study, machine: &Machine) -> String {
        format!(
            "# {}\n\n![{}](precision.svg)\n\n{}\n{TIMES} {machine}.\n{}",
            text(&self.title),
            C::FIGURE,
            C::table(self, study),
            warning_list(&self.warnings())
        )
    }

    /// Writes all files, `precision.json` last.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(
        &self,
        study: &Study,
        machine: &Machine,
        folder: Folder,
    ) -> Result<(), OutputError> {
        let (svg, png) = pictures(&C::figure(self, study))?;
        let page = self.page(study, machine).into_bytes();
        let runs = self.times();
        let times = json(&Times { machine, runs })?;
        let mut texts = vec![json(self)?, page, times, svg];
        texts.extend(png);
        folder.write(&texts)
    }
}
