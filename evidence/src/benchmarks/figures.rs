//! The pictures of the page.

use crate::accuracy::levels;
use crate::benchmarks::Measured;
use crate::benchmarks::family::Family;
use crate::benchmarks::growth::{self, SizeOf};
use crate::benchmarks::rivals::{Code, STUDIES, best};
use numbers::si;
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use studies::precision::Times;

/// Radius of dots.
const DOT: u32 = 7;

/// Colours of the kinds of mechanism, and of the codes.
const COLORS: [Color; 4] = [
    palette::BLUE,
    palette::VERMILION,
    palette::GREEN,
    palette::PURPLE,
];

/// Costs over the size.
pub fn growth(measured: &Measured) -> Figure {
    let panel = |title: &str, axis: Axis, legend: bool, cost: &SizeOf| {
        let mut marks = Vec::new();
        for (family, color) in Family::ALL.into_iter().zip(COLORS) {
            let (bodies, costs) = sizes(measured, family, cost);
            if bodies.is_empty() {
                continue;
            }
            let label = if legend { family.name() } else { "" };
            marks.push(Mark::series("", color, &bodies, &costs));
            marks.push(Mark::points(label, color, &bodies, &costs, DOT));
        }
        Panel {
            title: title.to_owned(),
            note: String::new(),
            x: Axis::new("Number of bodies", "", 1.0).log(),
            y: axis.log(),
            marks,
        }
    };
    let time = Axis::new("Processor time", "s", 1.0);
    let memory = Axis::new("Largest memory", "B", 1.0);
    let count = Axis::new("Instructions", "", 1.0);
    let panels = vec![
        panel("a) Compilation", time.clone(), true, &|cost| {
            Some(cost.compile)
        }),
        panel("b) A step", time, false, &|cost| Some(cost.step)),
        panel("c) Memory of the process", memory, false, &|cost| {
            Some(cost.memory? as f64)
        }),
        panel("d) A step", count, false, &|cost| {
            Some(cost.instructions? as f64)
        }),
    ];
    let caption = format!(
        "Rigid bodies, Bathe's method with a step of {}, the first {} steps.",
        si(growth::STEP, "s"),
        growth::STEPS,
    );
    Figure::grid(panels, 2, caption)
}

/// Sizes and costs of the mechanisms of one kind.
pub fn sizes(measured: &Measured, family: Family, cost: &SizeOf) -> (Vec<f64>, Vec<f64>) {
    let sizes = measured.sizes.iter().filter(|size| size.family == family);
    sizes
        .filter_map(|size| Some((size.bodies as f64, cost(size)?)))
        .unzip()
}

/// Errors against processor time, a panel a study.
pub fn rivals(measured: &Measured) -> Figure {
    let curves = &measured.rivals.all_curves();
    let panels = STUDIES.iter().enumerate().map(|(k, study)| {
        let mut marks = Vec::new();
        for (code, color) in Code::ALL.into_iter().zip(COLORS) {
            let own = curves
                .iter()
                .filter(|c| c.study == *study && c.code == code);
            let points = own.flat_map(|curve| curve.points.iter().filter(|p| p[0] > curve.floor));
            let (errors, times): (Vec<f64>, Vec<f64>) = points.map(|[e, t]| (*e, *t)).unzip();
            marks.push(Mark::points("", color, &times, &errors, 3));
            let line = levels().filter_map(|error| {
                let (_, seconds) = best(curves, study, code, error, Times::Interpolated)?;
                Some((seconds, error))
            });
            let (times, errors): (Vec<f64>, Vec<f64>) = line.unzip();
            let label = if k == 0 { code.name() } else { "" };
            marks.push(Mark::curve(label, color, &times, &errors).width(4));
        }
        Panel {
            title: (*study).to_owned(),
            note: String::new(),
            x: Axis::new("Processor time", "s", 1.0).log(),
            y: Axis::new("Error of position", "m", 1.0)
                .log()
                .over(1e-12, 1e-4),
            marks,
        }
    });
    let caption = "The first milliseconds of the studies, as long as the page says. Dots: runs of all methods of a code. Lines: the fastest \
                   method that comes below an error and stays there with finer steps, interpolated between its runs.";
    Figure::grid(panels.collect(), 2, caption.to_owned())
}
