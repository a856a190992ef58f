//! Studies beyond the time from which two runs go different ways: what their statistics cost.
//!
//! Of the part of a run from some time on: the envelope of each position, max |x|; their rms, (mean of the sum of x^2)^(1/2);
//! the share of time in contact, over all joints; the energy that contacts dissipate, and the energy that the integrator
//! loses. The first two are compared with a reference, relative; the third too, as it is; the last with the one before it.

use super::diagram::color;
use super::errors::larger;
use super::table::TIMES;
use super::{
    Columns, Effort, Made, Pace, Study, StudyError, Time, Timing, Work, distinct, named_warnings,
    points, references,
};
use crate::machine::Machine;
use crate::warning_list;
use looselink::simulate::Notice;
use plot::{Axis, Figure, Mark, Panel, palette};
use serde::Serialize;
use std::fmt::Write;

const WRITES: &str = "a string takes any text";
/// A smoke test simulates this part of the time.
const SMOKE: f64 = 0.02;

/// Statistics of one run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measures {
    /// Largest magnitude of every position \[m\].
    pub envelope: Vec<f64>,
    /// Root mean square of the vector of positions \[m\].
    pub rms: f64,
    /// Share of time in contact, mean over the joints.
    pub contact: f64,
    /// Energy dissipated in contact \[J\].
    pub dissipated: f64,
    /// Energy lost by the integrator \[J\].
    pub numerical: f64,
}

/// All runs of a study of statistics.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Survey {
    /// The study's title.
    pub title: String,
    /// The runs of the reference: coarse and fine.
    pub reference: [Measures; 2],
    /// Their warnings.
    pub reference_warnings: [Vec<String>; 2],
    /// All points, curve by curve.
    pub runs: Vec<Sampled>,
    /// Their times, in the same order.
    #[serde(skip)]
    pub timings: Vec<Option<Timing>>,
}

/// One point of a curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sampled {
    /// Name of the curve.
    pub curve: String,
    /// Step or accuracy.
    pub pace: Pace,
    /// What came of it.
    pub result: Result<(Measures, Work), String>,
    /// What a run that reached its end warns of.
    pub warnings: Vec<String>,
}

impl Measures {
    /// From the columns of a run by the names of their channels.
    ///
    /// # Errors
    /// A channel that it does not have.
    fn of(study: &Study, get: Columns) -> Result<Measures, StudyError> {
        let statistics = study.statistics.as_ref();
        let statistics = statistics.expect("a study of statistics says which");
        let first = (statistics.from / study.interval).round() as usize;
        let part = |name: &str| match get(name) {
            Some(column) => Ok(&column[first..]),
            None => Err(StudyError::plain(format!(
                "the scene has no channel {name:?}"
            ))),
        };
        let parts = |names: &[String]| names.iter().map(|n| part(n)).collect::<Result<Vec<_>, _>>();
        let mean =
            |x: &[f64], of: fn(f64) -> f64| x.iter().map(|x| of(*x)).sum::<f64>() / x.len() as f64;
        let gained = |name: &str| part(name).map(|x| x[x.len() - 1] - x[0]);
        let positions = parts(&study.position)?;
        let contacts = parts(&statistics.contact)?;
        let largest = |x: &&[f64]| x.iter().fold(0.0, |m, x| larger(m, *x));
        let squares = positions.iter().map(|x| mean(x, |x| x * x));
        let shares = contacts.iter().map(|x| mean(x, |x| x));
        Ok(Measures {
            envelope: positions.iter().map(largest).collect(),
            rms: squares.sum::<f64>().sqrt(),
            contact: shares.sum::<f64>() / contacts.len() as f64,
            dissipated: gained("energy.contact_dissipated")?,
            numerical: gained("energy.numerical")?,
        })
    }

    /// Largest deviation of the envelope and the rms, relative.
    pub fn deviation(&self, exact: &Measures) -> f64 {
        let pairs = self.envelope.iter().zip(&exact.envelope);
        let pairs = pairs.chain([(&self.rms, &exact.rms)]);
        pairs.fold(0.0, |m, (x, y)| larger(m, x / y - 1.0))
    }

    /// Energy lost by the integrator over energy dissipated in contact.
    pub fn loss(&self) -> f64 {
        self.numerical / self.dissipated
    }
}

impl Study {
    /// The same, much shorter, to see that it works.
    fn brief(&self) -> Study {
        let mut study = self.clone();
        let rows = (SMOKE * study.duration / study.interval).round();
        study.duration = rows * study.interval;
        if let Some(statistics) = &mut study.statistics {
            statistics.from = (0.5 * rows).round() * study.interval;
        }
        study
    }
}

impl Survey {
    /// Makes all runs of a study of statistics; `tell` is called before each with its name, and with its
    /// warnings.
    ///
    /// # Errors
    /// A study that cannot be made: a faulty scene, a channel that the scene does not have, a reference that fails.
    pub fn run(
        study: &Study,
        effort: Effort,
        tell: &mut dyn FnMut(Notice),
    ) -> Result<Survey, StudyError> {
        let brief = effort.smoke.then(|| study.brief());
        let study = brief.as_ref().unwrap_or(study);
        let (reference, reference_warnings) = references(study, tell, Measures::of)?;
        let mut survey = Survey {
            title: study.title.clone(),
            reference,
            reference_warnings,
            runs: Vec::new(),
            timings: Vec::new(),
        };
        points(study, effort, tell, &mut |curve, pace, made| {
            survey.add(study, curve, pace, made)
        })?;
        Ok(survey)
    }

    /// Adds a point, which may come from another program that has recorded the channels of the study at the same instants.
    ///
    /// # Errors
    /// A channel that it did not record.
    pub fn add(
        &mut self,
        study: &Study,
        curve: &str,
        pace: Pace,
        made: Result<Made, String>,
    ) -> Result<(), StudyError> {
        let (result, warnings, timing) = match made {
            Ok(made) => {
                let measures = Measures::of(study, made.columns)?;
                (Ok((measures, made.work)), made.warnings, Some(made.timing))
            }
            Err(error) => (Err(error), Vec::new(), None),
        };
        self.runs.push(Sampled {
            curve: curve.to_owned(),
            pace,
            result,
            warnings,
        });
        self.timings.push(timing);
        Ok(())
    }

    fn exact(&self) -> &Measures {
        &self.reference[1]
    }

    /// Names of the curves in the order of their first points.
    fn curves(&self) -> Vec<&str> {
        distinct(self.runs.iter().map(|run| &*run.curve))
    }

    /// The time of every point.
    pub fn times(&self) -> Vec<Time<'_>> {
        let runs = self.runs.iter().map(|run| (&*run.curve, run.pace));
        Time::of(runs, &self.timings)
    }

    /// All warnings, each after the name of its run.
    pub fn warnings(&self) -> Vec<String> {
        let runs = self.runs.iter();
        let runs = runs.map(|run| (&*run.curve, run.pace, &*run.warnings));
        named_warnings(&self.reference_warnings, runs)
    }

    /// What the statistics are and what they took, a line a run. `duration` is the simulated time \[s\].
    pub fn table(&self, duration: f64) -> String {
        let mut out = String::from(
            "| method | step or accuracy | envelopes | rms | deviation | in contact | dissipated in contact | lost by the integrator | processor time | runs | real-time factor | steps | rejected steps | onsets |\n\
             |---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        );
        let cells = |m: &Measures| {
            let envelope = m.envelope.iter().map(|e| numbers::si(*e, "m"));
            [
                envelope.collect::<Vec<_>>().join(", "),
                numbers::si(m.rms, "m"),
                numbers::percent(m.deviation(self.exact())),
                format!("{:.3}", m.contact),
                numbers::si(m.dissipated, "J"),
                format!(
                    "{} ({})",
                    numbers::si(m.numerical, "J"),
                    numbers::percent(m.loss())
                ),
            ]
            .join(" | ")
        };
        for (run, timing) in self.runs.iter().zip(&self.timings) {
            write!(out, "| {} | {} |", run.curve, run.pace).expect(WRITES);
            match (&run.result, timing) {
                (Ok((measures, work)), Some(timing)) => writeln!(
                    out,
                    " {} | {} | {} | {} | {} | {} | {} |",
                    cells(measures),
                    numbers::si(timing.median, "s"),
                    timing.seconds.len(),
                    numbers::digits(duration / timing.median),
                    work.steps,
                    work.rejected_steps,
                    work.onsets
                ),
                (Err(error), _) => writeln!(out, " failed: {error} {}|", "| ".repeat(11)),
                (Ok(_), None) => unreachable!("a run that reached its end was timed"),
            }
            .expect(WRITES);
        }
        for (name, measures) in ["coarse", "fine"].iter().zip(&self.reference) {
            writeln!(
                out,
                "| reference | {name} | {} | | | | | | |",
                cells(measures)
            )
            .expect(WRITES);
        }
        out
    }

    /// A page with the diagram, the table, and where it was measured.
    pub fn page(&self, study: &Study, machine: &Machine) -> String {
        format!(
            "# {}\n\n![Statistics](precision.png)\n\n{}\n{TIMES} {machine}.\n{}",
            self.title,
            self.table(study.duration),
            warning_list(&self.warnings())
        )
    }

    /// Deviations and losses against the processor time of a simulated second.
    pub fn figure(&self, study: &Study) -> Figure {
        let duration = study.duration;
        let panel = |title: &str, label: &str, of: &dyn Fn(&Measures) -> f64, bound: f64| {
            let mut marks = Vec::new();
            let curves = self.curves();
            for curve in &curves {
                let color = color(&curves, curve);
                let runs = self.runs.iter().zip(&self.timings);
                let points = runs.filter(|(run, _)| run.curve == *curve);
                let (x, y): (Vec<f64>, Vec<f64>) = points
                    .filter_map(|(run, timing)| {
                        let (measures, _) = run.result.as_ref().ok()?;
                        Some((timing.as_ref()?.median / duration, of(measures).abs()))
                    })
                    .filter(|(_, y)| *y > 0.0)
                    .unzip();
                if !x.is_empty() {
                    marks.push(Mark::points(curve, color, &x, &y, 9));
                }
            }
            marks.push(Mark::level("", palette::BLACK, bound));
            Panel {
                title: title.into(),
                note: String::new(),
                x: Axis::new("Processor time per simulated second", "s", 1.0).log(),
                y: Axis::new(label, "%", 100.0).log(),
                marks,
            }
        };
        let exact = self.exact();
        let scene = study
            .scene
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy();
        let [coarse, fine] = study.reference.paces();
        let from = study.statistics.as_ref().map_or(0.0, |s| s.from);
        let set = match study.reference.set.as_slice() {
            [] => String::new(),
            set => format!("{}, ", set.join(", ")),
        };
        Figure {
            rows: vec![
                vec![
                    panel(
                        "Energy lost by the integrator",
                        "Over the contact dissipation",
                        &Measures::loss,
                        0.05,
                    ),
                    panel(
                        "Envelopes and rms",
                        "Largest deviation",
                        &|m| m.deviation(exact),
                        0.01,
                    ),
                ],
                vec![panel(
                    "Share of time in contact",
                    "Deviation",
                    &|m| m.contact - exact.contact,
                    0.03,
                )],
            ],
            caption: format!(
                "{}. Scene {scene}, {} to {}, rows every {}. Reference: {set}{coarse} and {fine}, which deviate from each other by {} \
                 in envelopes and rms. Dashed: 5 %, 1 % and 3 %. Left of one second the simulation is faster than real time.",
                self.title,
                numbers::si(from, "s"),
                numbers::si(duration, "s"),
                numbers::si(study.interval, "s"),
                numbers::percent(self.reference[0].deviation(exact)),
            ),
        }
    }
}
