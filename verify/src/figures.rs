//! The pictures of the report.

use crate::compare::flexible::{Convergence, QUANTITIES};
use crate::trajectory::{ComparisonPlan, tolerances};
use miette::Result;
use numbers::si;
use plot::{Axis, Figure, Mark, Panel, palette};

/// A channel with its label, unit and the factor from SI.
const SHOWN: [(&str, &str, &str, f64); 3] = [
    ("error.x", "Platform error eₓ", "µm", 1e6),
    ("platform.ax", "Platform acceleration aₓ", "m/s²", 1.0),
    ("B1.force", "Force in B1", "N", 1.0),
];

/// A scene with Looselink at two steps, the coarse one first, and the reference: both curves on the left, their difference on the right.
pub fn overlay(
    plan: &ComparisonPlan,
    steps: [f64; 2],
    relative: f64,
    horizon: &str,
) -> Result<Figure> {
    let tolerances = tolerances(relative);
    let (cpp, rust) = rayon::join(|| plan.cpp(&tolerances), || steps.map(|h| plan.rust(h)));
    let ([coarse, fine], cpp) = (rust, cpp?);
    let rust = [coarse?, fine?];
    let h = steps.map(|step| si(step, "s"));
    let t = cpp.get("t");
    let panel = |title: String, y: Axis, marks: Vec<Mark>| Panel {
        title,
        note: String::new(),
        x: Axis::new("Time t", "ms", 1e3).over(0.0, plan.duration),
        y,
        marks,
    };
    let rows = SHOWN.map(|(name, label, unit, factor)| {
        let both = vec![
            Mark::series("IDA", palette::VERMILION, t, cpp.get(name)).width(7),
            Mark::series("Looselink", palette::BLUE, t, rust[1].get(name)).width(2),
        ];
        let difference = [palette::GREEN, palette::BLUE].into_iter().enumerate();
        let difference = difference.map(|(i, color)| {
            let pairs = rust[i].get(name).iter().zip(cpp.get(name));
            let values: Vec<f64> = pairs.map(|(r, c)| (r - c).abs()).collect();
            Mark::series(&format!("h = {}", h[i]), color, t, &values).width(2)
        });
        let log = Axis::new("Difference", unit, factor).log();
        vec![
            panel(label.into(), Axis::new(label, unit, factor), both),
            panel(format!("{label}: difference"), log, difference.collect()),
        ]
    });
    Ok(Figure {
        rows: rows.to_vec(),
        caption: format!(
            "Scene {}. Looselink: Bathe's scheme, h = {} and {}; reference: IDA with relative tolerance \
             {relative:.0e}, positions {:.0e} m. Left: Looselink at the smaller step on top of the reference. Right: |Looselink \
             − reference| at every recorded instant; no line where both are zero. {horizon}",
            plan.scene,
            h[0],
            h[1],
            1e-3 * relative
        ),
    })
}

/// Difference from IDA against the step, for one and for four elements.
pub fn convergence(runs: &[Convergence]) -> Figure {
    let panel = |run: &Convergence| {
        let h = &run.plan.steps;
        let mut marks = Vec::new();
        let colors = [
            palette::BLUE,
            palette::VERMILION,
            palette::GREEN,
            palette::GREY,
        ];
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
            title: run.plan.name.clone(),
            note: format!("the first {}", si(run.plan.plan.duration, "s")),
            x: Axis::new("Step h", "µs", 1e6).log(),
            y: Axis::new("Difference from IDA over the largest value", "", 1.0).log(),
            marks,
        }
    };
    Figure {
        rows: vec![runs.iter().map(panel).collect()],
        caption: "Case 2: largest difference between Looselink (Bathe's scheme) and IDA at its tightest tolerance, \
                  over the largest value of the quantity (of the platform's position: over its largest deviation from the \
                  ideal path)."
            .into(),
    }
}
