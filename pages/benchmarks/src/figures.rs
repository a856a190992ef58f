//! The figures of the page.

use crate::Measured;
use crate::family::Family;
use crate::growth::{self, SizeOf, exponent};
use crate::meshes::ERRORS;
use crate::rivals::{Code, STUDIES, best};
use crate::steps::StepCost;
use accuracy::settings::levels;
use numbers::{digits, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use studies::precision::Times;

/// Radius of dots.
const DOT: u32 = 6;

/// Colors of the kinds of mechanism.
const COLORS: [Color; Family::ALL.len()] = [
    palette::BLUE,
    palette::VERMILION,
    palette::GREEN,
    palette::PURPLE,
];

/// Instructions and floating-point operations of every step.
pub fn steps(measured: &Measured) -> Figure {
    let names = measured.steps.iter().map(|step| step.name.clone());
    let dots = |label: &str, color: Color, of: &dyn Fn(&StepCost) -> Option<u64>| {
        let rows = measured.steps.iter().enumerate();
        let points = rows.filter_map(|(row, step)| Some((of(step)? as f64, row as f64)));
        let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
        Mark::points(label, color, &x, &y, DOT)
    };
    let panel = Panel {
        title: "One step of 10 µs".to_owned(),
        note: String::new(),
        x: Axis::new("count a step", "", 1.0).log(),
        y: Axis::categories(names.collect()),
        marks: vec![
            dots("instructions, baseline", palette::GREY, &|step| {
                Some(step.before?.instructions)
            }),
            dots("instructions", palette::BLUE, &|step| {
                Some(step.now.instructions)
            }),
            dots("floating-point operations", palette::ORANGE, &|step| {
                Some(step.now.operations)
            }),
        ],
    };
    let caption = format!(
        "Instructions of a step of 10 µs and the floating-point operations among them, mean over the steps between 2 and 12 ms of \
         motion, counted by callgrind in the release build. The baseline is commit {}.",
        measured.baseline
    );
    Figure::grid(vec![panel], 1, caption)
}

/// Costs over the size.
pub fn growth(measured: &Measured) -> Figure {
    let panels = vec![
        over_bodies(
            measured,
            "a) Compilation",
            ("processor time", "s"),
            &|cost| Some(cost.compile),
        ),
        over_bodies(measured, "b) A step", ("processor time", "s"), &|cost| {
            Some(cost.step)
        }),
        over_bodies(
            measured,
            "c) Memory",
            ("largest memory of the process", "MB"),
            &|cost| Some(cost.memory? as f64),
        ),
        over_elements(measured),
    ];
    let caption = format!(
        "a) to c): rigid bodies, Bathe's method with a step of {}, the first {} steps. \
         The exponents are those of the largest decade. d): case 2, 20 ms, time to reach an error of position on the same mesh, \
         on the line between neighbouring steps.",
        si(growth::STEP, "s"),
        growth::STEPS,
    );
    Figure::grid(panels, 2, caption)
}

fn over_bodies(
    measured: &Measured,
    title: &str,
    (label, unit): (&str, &str),
    cost: &SizeOf,
) -> Panel {
    let mut marks = Vec::new();
    for (family, color) in Family::ALL.into_iter().zip(COLORS) {
        let (bodies, costs) = sizes(measured, family, cost);
        if bodies.is_empty() {
            continue;
        }
        let exponent = digits(exponent(&bodies, &costs));
        let label = format!("{}, exponent {exponent}", family.name());
        marks.push(Mark::series(&label, color, &bodies, &costs));
        marks.push(Mark::points("", color, &bodies, &costs, DOT));
    }
    let factor = if unit == "MB" { 1e-6 } else { 1.0 };
    Panel {
        title: title.to_owned(),
        note: String::new(),
        x: Axis::new("bodies", "", 1.0).log(),
        y: Axis::new(label, unit, factor).log(),
        marks,
    }
}

/// Sizes and costs of the mechanisms of one kind.
pub fn sizes(measured: &Measured, family: Family, cost: &SizeOf) -> (Vec<f64>, Vec<f64>) {
    let sizes = measured.sizes.iter().filter(|size| size.family == family);
    sizes
        .filter_map(|size| Some((size.bodies as f64, cost(size)?)))
        .unzip()
}

/// Elements and times of a curve at an error.
fn mesh(measured: &Measured, curve: &str, error: usize) -> (Vec<f64>, Vec<f64>) {
    let meshes = measured.meshes.iter().filter(|mesh| mesh.curve == curve);
    meshes
        .filter_map(|mesh| Some((mesh.elements as f64, mesh.times[error]?.seconds)))
        .unzip()
}

/// Names of the curves, in their order.
pub fn curves(measured: &Measured) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for mesh in &measured.meshes {
        if !names.contains(&&*mesh.curve) {
            names.push(&mesh.curve);
        }
    }
    names
}

fn over_elements(measured: &Measured) -> Panel {
    let mut marks = Vec::new();
    let mut colors = [
        palette::GREEN,
        palette::PURPLE,
        palette::ORANGE,
        palette::SKY,
    ]
    .iter();
    for curve in curves(measured) {
        for (k, error) in ERRORS.iter().enumerate() {
            let (elements, times) = mesh(measured, curve, k);
            if elements.len() < 2 {
                continue;
            }
            let color = *colors.next().unwrap_or(&palette::GREY);
            let label = format!(
                "{curve}, {}, exponent {}",
                si(*error, "m"),
                digits(exponent(&elements, &times))
            );
            marks.push(Mark::series(&label, color, &elements, &times));
            marks.push(Mark::points("", color, &elements, &times, DOT));
        }
    }
    Panel {
        title: "d) Elements of the links".to_owned(),
        note: String::new(),
        x: Axis::new("elements a link", "", 1.0).log(),
        y: Axis::new("processor time", "s", 1.0).log(),
        marks,
    }
}

/// Errors against processor time, a panel a study.
pub fn rivals(measured: &Measured) -> Figure {
    let panels = STUDIES.iter().enumerate().map(|(k, study)| {
        let letter = char::from(b'a' + k as u8);
        let mut marks = Vec::new();
        for (code, color) in Code::ALL.into_iter().zip([
            palette::BLUE,
            palette::VERMILION,
            palette::GREEN,
            palette::BLACK,
        ]) {
            let curves = &measured.rivals.curves;
            let own = curves
                .iter()
                .filter(|c| c.study == *study && c.code == code);
            let points = own.flat_map(|curve| curve.points.iter().filter(|p| p[0] > curve.floor));
            let (errors, times): (Vec<f64>, Vec<f64>) = points.map(|[e, t]| (*e, *t)).unzip();
            marks.push(Mark::points("", color, &times, &errors, 3));
            let line = levels().filter_map(|error| {
                let found = best(curves, study, code, error, Times::Interpolated)?;
                Some((found.seconds, error))
            });
            let (times, errors): (Vec<f64>, Vec<f64>) = line.unzip();
            marks.push(Mark::curve(code.name(), color, &times, &errors).width(4));
        }
        Panel {
            title: format!("{letter}) {study}"),
            note: String::new(),
            x: Axis::new("processor time", "s", 1.0).log(),
            y: Axis::new("error of position", "m", 1.0)
                .log()
                .over(1e-12, 1e-4),
            marks,
        }
    });
    let caption = "Studies of the folder studies, of 3 to 20 ms of motion. Dots: runs of all methods. Lines: the fastest method that \
                   comes below an error and stays there with finer steps, interpolated between runs; they are vertical where its \
                   coarsest run is already below the error. The error is the largest difference of position from a converged \
                   solution: Exudyn's own for Exudyn, Looselink's for all others; errors below the difference of two such solutions \
                   are left out."
        .to_owned();
    Figure::grid(panels.collect(), 2, caption)
}
