//! The pictures of the report.

use crate::compare::flexible::{Convergence, QUANTITIES};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use miette::Result;
use numbers::si;
use plot::{Axis, Figure, Mark, Panel, palette};

/// A channel with its label, unit and the factor from SI.
const SHOWN: [(&str, &str, &str, f64); 3] = [
    ("error.x", "Platform error eₓ", "µm", 1e6),
    ("platform.ax", "Platform acceleration aₓ", "m/s²", 1.0),
    ("B1.force", "Force in B1", "N", 1.0),
];

/// One scene with Looselink at two steps and the reference.
pub struct Overlay {
    plan: ComparisonPlan,
    /// Coarse and fine.
    steps: [f64; 2],
    relative: f64,
    rust: [Trajectory; 2],
    cpp: Trajectory,
}

/// Runs a scene for its picture.
pub fn overlay(plan: ComparisonPlan, steps: [f64; 2], relative: f64) -> Result<Overlay> {
    let tolerances = tolerances(relative);
    let (cpp, rust) = rayon::join(|| plan.cpp(&tolerances), || steps.map(|h| plan.rust(h)));
    let ([coarse, fine], cpp) = (rust, cpp?);
    let rust = [coarse?, fine?];
    Ok(Overlay {
        plan,
        steps,
        relative,
        rust,
        cpp,
    })
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
        let marks = vec![
            Mark::series("IDA", palette::VERMILION, cpp.get("t"), cpp.get(name)).width(7),
            Mark::series("Looselink", palette::BLUE, rust.get("t"), rust.get(name)).width(2),
        ];
        self.panel(label.into(), Axis::new(label, unit, factor), marks)
    }

    fn difference(&self, name: &str, label: &str, unit: &'static str, factor: f64) -> Panel {
        let series = |run: &Trajectory, step: f64, color| {
            let pairs = run.get(name).iter().zip(self.cpp.get(name));
            let difference: Vec<f64> = pairs.map(|(r, c)| (r - c).abs()).collect();
            let label = format!("h = {}", si(step, "s"));
            Mark::series(&label, color, run.get("t"), &difference).width(2)
        };
        let marks = vec![
            series(&self.rust[0], self.steps[0], palette::GREEN),
            series(&self.rust[1], self.steps[1], palette::BLUE),
        ];
        let y = Axis::new("Difference", unit, factor).log();
        self.panel(format!("{label}: difference"), y, marks)
    }

    fn panel(&self, title: String, y: Axis, marks: Vec<Mark>) -> Panel {
        let x = Axis::new("Time t", "ms", 1e3).over(0.0, self.plan.duration);
        let note = String::new();
        Panel {
            title,
            note,
            x,
            y,
            marks,
        }
    }
}

/// Difference from IDA against the step, for one and for four elements.
pub fn convergence(runs: &[Convergence]) -> Figure {
    let panel = |run: &Convergence| {
        let h = &run.steps;
        let mut marks = Vec::new();
        #[rustfmt::skip]
        let colors = [palette::BLUE, palette::VERMILION, palette::GREEN, palette::GREY];
        for (((name, ..), curve), color) in QUANTITIES.iter().zip(&run.curves).zip(colors) {
            // in units of the largest value, so that all fit on one axis
            let scaled: Vec<f64> = curve.by_step.iter().map(|d| d / curve.size).collect();
            let name = name.trim_end_matches(" [m]");
            marks.push(Mark::curve(name, color, h, &scaled));
            marks.push(Mark::points("", color, h, &scaled, 7));
        }
        let top = run.curves[0].by_step[0] / run.curves[0].size;
        let slope = h.iter().map(|h_i| 0.3 * top * (h_i / h[0]).powi(2));
        let slope: Vec<f64> = slope.collect();
        marks.push(Mark::curve("slope 2", palette::BLACK, h, &slope));
        Panel {
            title: run.name(),
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
