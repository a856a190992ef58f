//! The pictures of the report.

use crate::compare::cost::Curves;
use crate::compare::flexible::{Convergence, QUANTITIES, elements};
use crate::trajectory::{Plan, Trajectory, tolerances};
use miette::Result;
use plot::{Axis, Figure, Mark, Panel, palette, si};
use rayon::prelude::*;

/// A channel with its label, unit and the factor from SI.
const SHOWN: [(&str, &str, &str, f64); 3] = [
    ("error.x", "Platform error eₓ", "µm", 1e6),
    ("platform.ax", "Platform acceleration aₓ", "m/s²", 1.0),
    ("B1.force", "Force in B1", "N", 1.0),
];

/// One scene with Looselink at two steps and the reference.
pub struct Overlay {
    plan: Plan,
    /// Coarse and fine.
    steps: [f64; 2],
    relative: f64,
    rust: [Trajectory; 2],
    cpp: Trajectory,
}

/// Runs a scene for its picture.
///
/// # Errors
/// A run that fails.
pub fn overlay(plan: Plan, steps: [f64; 2], relative: f64) -> Result<Overlay> {
    let tolerances = tolerances(relative, 1e-3 * relative, 0.1 * relative);
    let (cpp, rust) = rayon::join(
        || plan.cpp(&tolerances),
        || {
            let runs = steps.par_iter().with_max_len(1).map(|&h| plan.rust(h));
            runs.collect::<Result<Vec<_>>>()
        },
    );
    Ok(Overlay {
        rust: rust?.try_into().expect("one run for each of two steps"),
        cpp: cpp?,
        plan,
        steps,
        relative,
    })
}

fn time_axis(plan: &Plan) -> Axis {
    Axis::new("Time t", "ms", 1e3).over(0.0, plan.duration)
}

impl Overlay {
    /// Both curves on the left, their difference on the right.
    pub fn figure(&self, horizon: &str) -> Figure {
        let rows = SHOWN.iter().map(|shown| {
            let (name, label, unit, factor) = *shown;
            vec![
                self.both(name, label, unit, factor),
                self.difference(name, label, unit, factor),
            ]
        });
        let [coarse, fine] = self.steps.map(|h| si(h, "s"));
        Figure {
            rows: rows.collect(),
            caption: format!(
                "Scene {}. Looselink: Bathe's scheme, h = {coarse} and {fine}; reference: IDA with relative tolerance \
                 {:.0e}, positions {:.0e} m. Left: Looselink at the smaller step on top of the reference. Right: |Looselink \
                 − reference| at every recorded instant; no line where both are zero. {horizon}",
                self.plan.scene,
                self.relative,
                1e-3 * self.relative
            ),
        }
    }

    fn both(&self, name: &str, label: &str, unit: &'static str, factor: f64) -> Panel {
        let (cpp, rust) = (&self.cpp, &self.rust[1]);
        Panel {
            title: label.into(),
            note: String::new(),
            x: time_axis(&self.plan),
            y: Axis::new(label, unit, factor),
            marks: vec![
                Mark::series("IDA", palette::VERMILION, &cpp.t, cpp.get(name)).width(7),
                Mark::series("Looselink", palette::BLUE, &rust.t, rust.get(name)).width(2),
            ],
        }
    }

    fn difference(&self, name: &str, label: &str, unit: &'static str, factor: f64) -> Panel {
        let series = |run: &Trajectory, step: f64, color| {
            let pairs = run.get(name).iter().zip(self.cpp.get(name));
            let difference: Vec<f64> = pairs.map(|(r, c)| (r - c).abs()).collect();
            let label = format!("h = {}", si(step, "s"));
            Mark::series(&label, color, &run.t, &difference).width(2)
        };
        Panel {
            title: format!("{label}: difference"),
            note: String::new(),
            x: time_axis(&self.plan),
            y: Axis::new("Difference", unit, factor).log(),
            marks: vec![
                series(&self.rust[0], self.steps[0], palette::GREEN),
                series(&self.rust[1], self.steps[1], palette::BLUE),
            ],
        }
    }
}

/// Difference from IDA against the step, for one and for four elements.
pub fn convergence(runs: &[Convergence]) -> Figure {
    let panel = |run: &Convergence| {
        let h = &run.steps;
        let mut marks = Vec::new();
        let colors = [
            palette::BLUE,
            palette::VERMILION,
            palette::GREEN,
            palette::GREY,
        ];
        for (q, ((name, _, relative), color)) in QUANTITIES.iter().zip(colors).enumerate() {
            // positions in units of the largest deviation, so that all fit on one axis
            let size = run.sizes[q];
            let scaled: Vec<f64> = run.differences[q].iter().map(|d| d / size).collect();
            let label = if *relative {
                (*name).to_owned()
            } else {
                "platform position".to_owned()
            };
            marks.push(Mark::curve(&label, color, h, &scaled));
            marks.push(Mark::points("", color, h, &scaled, 7));
        }
        let top = run.differences[0][0] / run.sizes[0];
        let slope: Vec<f64> = h
            .iter()
            .map(|h_i| 0.3 * top * (h_i / h[0]).powi(2))
            .collect();
        marks.push(Mark::curve("slope 2", palette::BLACK, h, &slope));
        let elements = format!("{} per link", elements(run.elements));
        Panel {
            title: elements,
            note: String::new(),
            x: Axis::new("Step h", "µs", 1e6).log(),
            y: Axis::new("Difference from IDA over the largest value", "", 1.0).log(),
            marks,
        }
    };
    Figure {
        rows: vec![runs.iter().map(panel).collect()],
        caption: "Case 2 over 0.1 s: largest difference between Looselink (Bathe's scheme) and IDA at its tightest tolerance, \
                  over the largest value of the quantity (of the platform's position: over its largest deviation from the \
                  ideal path)."
            .into(),
    }
}

/// Achieved error against processor time.
pub fn cost(all: &[Curves]) -> Figure {
    let panel = |curves: &Curves| {
        let curve = |label: &str, color, points: &[crate::compare::cost::Point]| {
            let x: Vec<f64> = points.iter().map(|p| p.error).collect();
            let y: Vec<f64> = points.iter().map(|p| p.seconds).collect();
            [
                Mark::curve(label, color, &x, &y),
                Mark::points("", color, &x, &y, 7),
            ]
        };
        let mut marks = Vec::new();
        marks.extend(curve("Looselink, Bathe", palette::BLUE, &curves.rust));
        marks.extend(curve("reference, IDA", palette::VERMILION, &curves.cpp));
        Panel {
            title: curves.plan.name(),
            note: format!("first {}", si(curves.plan.duration, "s")),
            x: Axis::new("Largest error of the platform", "m", 1.0).log(),
            y: Axis::new("Processor time", "s", 1.0).log(),
            marks,
        }
    };
    Figure {
        rows: vec![all.iter().map(panel).collect()],
        caption: "Processor time against achieved error, one core, the shortest of three runs; the error of each program is its difference from the \
                  finest run of the other. Looselink with fixed steps from 4 µs to 62.5 ns, IDA with relative tolerances from \
                  1e-6 to 1e-12. A curve turns vertical where it reaches the error of that finest run."
            .into(),
    }
}
