//! Studies beyond the time from which two runs go different ways: what their statistics cost.
//!
//! Of the part of a run from some time on: the envelope of each position, max |x|; their rms, (mean of the sum of x^2)^(1/2);
//! the share of time in contact, over all joints; the energy that contacts dissipate, and the energy that the integrator
//! loses. The first two are compared with a reference, relative; the third too, as it is; the last with the one before it.

use super::errors::larger;
use super::{ColumnLookup, Compared, CurvePoint, Study, Survey, WorkCounts, column};
use crate::StudyError;
use numbers::{digits, percent, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use serde::{Deserialize, Serialize};

/// Statistics of one run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunStatistics {
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

/// The reference of a study of statistics.
#[derive(Debug, Serialize, Deserialize)]
pub struct StatisticsReference {
    /// Its runs: coarse and fine.
    #[serde(rename = "reference")]
    pub runs: [RunStatistics; 2],
}

impl Compared for StatisticsReference {
    type Kept = RunStatistics;
    type Measured = (RunStatistics, WorkCounts);
    const FIGURE: &str = "Statistics";

    fn keep(
        study: &Study,
        get: ColumnLookup,
        _: Option<Vec<f64>>,
    ) -> Result<RunStatistics, StudyError> {
        let sampling = study.statistics.as_ref();
        let sampling = sampling.expect("a study of statistics says which");
        let first = (sampling.from / study.interval).round() as usize;
        let part = |name: &str| Ok(&column(get, name)?[first..]);
        let parts = |names: &[String]| {
            let parts = names.iter().map(|name| part(name));
            parts.collect::<Result<Vec<_>, StudyError>>()
        };
        let mean =
            |x: &[f64], of: fn(f64) -> f64| x.iter().map(|x| of(*x)).sum::<f64>() / x.len() as f64;
        let gained = |name: &str| part(name).map(|x| x[x.len() - 1] - x[0]);
        let positions = parts(&study.position)?;
        let contacts = parts(&sampling.contact)?;
        let largest = |x: &&[f64]| x.iter().fold(0.0, |m, x| larger(m, *x));
        let squares = positions.iter().map(|x| mean(x, |x| x * x));
        let shares = contacts.iter().map(|x| mean(x, |x| x));
        Ok(RunStatistics {
            envelope: positions.iter().map(largest).collect(),
            rms: squares.sum::<f64>().sqrt(),
            contact: shares.sum::<f64>() / contacts.len() as f64,
            dissipated: gained("energy.contact_dissipated")?,
            numerical: gained("energy.numerical")?,
        })
    }

    fn new(coarse: RunStatistics, fine: RunStatistics) -> StatisticsReference {
        StatisticsReference {
            runs: [coarse, fine],
        }
    }

    fn measure(&self, kept: RunStatistics, work: WorkCounts) -> (RunStatistics, WorkCounts) {
        (kept, work)
    }

    fn table(survey: &Survey, study: &Study) -> String {
        let heads = [
            "envelopes",
            "rms",
            "deviation",
            "in contact",
            "dissipated in contact",
            "lost by the integrator",
            "processor time",
            "runs",
            "real-time factor",
            "steps",
            "rejected steps",
            "onsets",
        ];
        let [_, exact] = &survey.reference.runs;
        let reference = ["coarse", "fine"].into_iter().zip(&survey.reference.runs);
        survey.tabulate(
            &heads,
            |_, (measures, work), timing| {
                let cost = [
                    si(timing.median, "s"),
                    timing.seconds.len().to_string(),
                    digits(study.duration / timing.median),
                    work.steps.to_string(),
                    work.rejected_steps.to_string(),
                    work.onsets.to_string(),
                ];
                [measures.cells(exact), cost].concat()
            },
            reference.map(|(name, measures)| {
                let name = ["reference", name].map(str::to_owned);
                [&name[..], &measures.cells(exact)].concat()
            }),
        )
    }

    /// Deviations and losses against the processor time of a simulated second.
    fn figure(survey: &Survey, study: &Study) -> Figure {
        let duration = study.duration;
        let dots = |curve: &str, color: Color, x: &[f64], y: &[f64]| {
            vec![Mark::points(curve, color, x, y, 9)]
        };
        let panel = |title: &str, label: &str, of: &dyn Fn(&RunStatistics) -> f64, bound: f64| {
            let point = |i, run: &CurvePoint<(RunStatistics, WorkCounts)>| {
                let (measures, _) = run.result.as_ref().ok()?;
                Some((survey.seconds(i)? / duration, of(measures).abs()))
            };
            let mut marks = survey.marks(point, dots);
            marks.push(Mark::level("", palette::BLACK, bound));
            Panel {
                title: title.into(),
                note: String::new(),
                x: Axis::new("Processor time per simulated second", "s", 1.0).log(),
                y: Axis::new(label, "%", 100.0).log(),
                marks,
            }
        };
        let [rough, exact] = &survey.reference.runs;
        let deviation = |m: &RunStatistics| m.deviation(exact);
        let contact = |m: &RunStatistics| m.contact - exact.contact;
        let loss = "Energy lost by the integrator";
        let panels = vec![
            panel(
                loss,
                "Over the contact dissipation",
                &RunStatistics::loss,
                0.05,
            ),
            panel("Envelopes and rms", "Largest deviation", &deviation, 0.01),
            panel("Share of time in contact", "Deviation", &contact, 0.03),
        ];
        let [coarse, fine] = study.reference.paces();
        let from = study.statistics.as_ref().map_or(0.0, |s| s.from);
        let set = study.reference.set.iter().map(|set| format!("{set}, "));
        let caption = format!(
            "{}. Scene {}, {} to {}, rows every {}. Reference: {}{coarse} and {fine}, which deviate from each other by {} \
             in envelopes and rms. Dashed: 5 %, 1 % and 3 %. Left of one second the simulation is faster than real time.",
            study.title,
            study.scene_name(),
            si(from, "s"),
            si(duration, "s"),
            si(study.interval, "s"),
            set.collect::<String>(),
            percent(rough.deviation(exact)),
        );
        Figure::grid(panels, 2, caption)
    }
}

impl RunStatistics {
    /// Largest deviation of the envelope and the rms, relative.
    pub fn deviation(&self, exact: &RunStatistics) -> f64 {
        let pairs = self.envelope.iter().zip(&exact.envelope);
        let pairs = pairs.chain([(&self.rms, &exact.rms)]);
        pairs.fold(0.0, |m, (x, y)| larger(m, x / y - 1.0))
    }

    /// Energy lost by the integrator over energy dissipated in contact.
    pub fn loss(&self) -> f64 {
        self.numerical / self.dissipated
    }

    /// Its part of a line of a table.
    fn cells(&self, exact: &RunStatistics) -> [String; 6] {
        let envelope = self.envelope.iter().map(|e| si(*e, "m"));
        let (numerical, loss) = (si(self.numerical, "J"), percent(self.loss()));
        [
            envelope.collect::<Vec<_>>().join(", "),
            si(self.rms, "m"),
            percent(self.deviation(exact)),
            format!("{:.3}", self.contact),
            si(self.dissipated, "J"),
            format!("{numerical} ({loss})"),
        ]
    }
}
