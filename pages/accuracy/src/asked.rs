//! Whether an accuracy that was asked for is reached.

use crate::MadeStudy;
use numbers::{digits, si};
use plot::{Axis, Figure, Mark, Panel, palette};
use std::fmt::Write;
use studies::machine::median;
use studies::precision::StudyPace;

/// Name of the figure.
pub const FIGURE: &str = "asked";

/// A run with an accuracy.
struct AccurateRun {
    /// Study and curve.
    name: String,
    /// What was asked for \[m\].
    asked: f64,
    /// Achieved over asked, of the positions of the study and of all coordinates, where the reference is exact enough to tell.
    ratios: [Option<f64>; 2],
    has_impacts: bool,
}

/// All runs with an accuracy.
pub struct AccurateRuns {
    runs: Vec<AccurateRun>,
    /// Runs left out because they took one step from row to row.
    longest: usize,
}

impl AccurateRuns {
    /// Those of the studies.
    pub fn new(made: &[MadeStudy]) -> AccurateRuns {
        let mut all = AccurateRuns {
            runs: Vec::new(),
            longest: 0,
        };
        for one in made {
            let floor = &one.outcome.reference.floor;
            let rows = (one.study.duration / one.study.interval).round() as u64;
            for run in &one.outcome.runs {
                let (StudyPace::Accuracy { position, .. }, Ok(measured)) = (run.pace, &run.result)
                else {
                    continue;
                };
                if measured.work.steps <= rows {
                    all.longest += 1;
                    continue;
                }
                let errors = &measured.errors;
                let of_study = Some((errors.position, floor.position));
                let ratios = [of_study, errors.motion.zip(floor.motion)].map(|pair| {
                    let exact = pair.filter(|(error, floor)| *error > 2.0 * floor);
                    exact.map(|(error, _)| error / position)
                });
                all.runs.push(AccurateRun {
                    name: format!("{}, {}", one.name, run.curve),
                    asked: position,
                    ratios,
                    has_impacts: measured.work.onsets > 0,
                });
            }
        }
        all
    }

    /// Runs with the ratio of positions, 0, or of coordinates, 1.
    fn judged(&self, which: usize) -> impl Iterator<Item = (&AccurateRun, f64)> {
        let judged = self.runs.iter();
        judged.filter_map(move |run| Some((run, run.ratios[which]?)))
    }

    /// How many of these reach the accuracy, the median of the ratios and the largest.
    fn summary(&self, which: usize, impacts: Option<bool>) -> String {
        let among = |run: &AccurateRun| impacts.is_none_or(|impacts| run.has_impacts == impacts);
        let all: Vec<_> = self.judged(which).filter(|(run, _)| among(run)).collect();
        let ratios: Vec<f64> = all.iter().map(|(_, ratio)| *ratio).collect();
        let within = |bound: f64| ratios.iter().filter(|ratio| **ratio <= bound).count();
        let Some((run, largest)) = all.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return "no run can be judged".to_owned();
        };
        format!(
            "{} of {} runs reach it and {} stay within three times of it; the median is {}, the largest {} ({}, {})",
            within(1.0),
            ratios.len(),
            within(3.0),
            digits(median(&ratios)),
            digits(*largest),
            run.name,
            si(run.asked, "m")
        )
    }

    /// Ratio against accuracy, the two kinds of ratios beside each other.
    pub fn figure(&self) -> Figure {
        let panel = |which: usize, title: &str| {
            let dots = |label: &str, color, impacts: bool| {
                let runs = self.judged(which);
                let runs = runs.filter(|(run, _)| run.has_impacts == impacts);
                let (x, y): (Vec<f64>, Vec<f64>) =
                    runs.map(|(run, ratio)| (run.asked, ratio)).unzip();
                Mark::points(label, color, &x, &y, 5)
            };
            Panel {
                title: title.to_owned(),
                note: String::new(),
                x: Axis::new("accuracy asked for", "m", 1.0)
                    .log()
                    .over(3e-13, 3e-4),
                y: Axis::new("error achieved / asked for", "", 1.0)
                    .log()
                    .over(1e-6, 1e3),
                marks: vec![
                    Mark::level("as asked for", palette::BLACK, 1.0),
                    dots("without impacts", palette::BLUE, false),
                    dots("with impacts", palette::VERMILION, true),
                ],
            }
        };
        let panels = vec![
            panel(0, "positions of the study"),
            panel(1, "all coordinates of all bodies"),
        ];
        let caption = "Error achieved over accuracy asked for, one dot per run of a study with a method that follows an accuracy. \
                       Impacts amplify earlier errors.";
        Figure::grid(panels, 2, caption.to_owned())
    }

    /// The section of the page.
    pub fn section(&self) -> String {
        let mut out = format!(
            "## Is the requested accuracy reached?\n\n![Error achieved over accuracy asked for](pages/accuracy/figures/{FIGURE}.png)\n\n\
             An accuracy is a bound of the error of every coordinate of every body, as a distance, if nothing amplifies it. The ratio of \
             a run is the achieved error over the requested accuracy.\n\n\
             * Positions that the studies ask for: {}.\n\
             * All coordinates, motions without impacts: {}.\n\
             * All coordinates, motions with impacts, which amplify errors: {}. \
             [pages/accuracy/GUARANTEE.md](pages/accuracy/GUARANTEE.md) measures the amplification of every dynamic scene.\n\n\
             Left out are runs whose error is below twice the uncertainty of the reference, and {} runs that took one step from row to \
             row: the accuracy did not decide on their steps. This table has the ratios of the positions; the column `achieved / requested` of \
             the studies has those of all coordinates.\n\n",
            self.summary(0, None),
            self.summary(1, Some(false)),
            self.summary(1, Some(true)),
            self.longest
        );
        let judged: Vec<_> = self.judged(0).collect();
        let mut asked: Vec<f64> = judged.iter().map(|(run, _)| run.asked).collect();
        asked.sort_by(|a, b| b.total_cmp(a));
        asked.dedup();
        let heads: Vec<String> = asked.iter().map(|p| si(*p, "m")).collect();
        let rule = "---|".repeat(asked.len());
        write!(
            out,
            "| study, method | {} |\n|---|{rule}\n",
            heads.join(" | ")
        )
        .expect("a string takes any text");
        for names in judged.chunk_by(|a, b| a.0.name == b.0.name) {
            let cells = asked.iter().map(|asked| {
                let found = names.iter().find(|(run, _)| run.asked == *asked);
                found.map_or(String::new(), |(_, ratio)| digits(*ratio))
            });
            let cells: Vec<String> = cells.collect();
            writeln!(out, "| {} | {} |", names[0].0.name, cells.join(" | "))
                .expect("a string takes any text");
        }
        out + "\n"
    }
}
