//! Work-precision diagrams.

use super::elements::Meshes;
use super::errors::NORMS;
use super::{Outcome, Pace, Study};
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Curves that several studies have, each with the same colour in all of them.
const NAMED: [(&str, Color); 12] = [
    ("Bathe", palette::BLUE),
    ("trapezoidal", palette::GREEN),
    ("generalised-alpha 0.8", palette::PURPLE),
    ("HHT 0.8", palette::WINE),
    ("backward Euler", palette::BROWN),
    ("velocity Verlet", palette::ORANGE),
    ("Dormand-Prince", palette::VERMILION),
    ("Bathe, onsets not located", palette::SKY),
    ("Bathe, error controlled", palette::INDIGO),
    ("trapezoidal, error controlled", palette::TEAL),
    ("Dormand-Prince, error controlled", palette::OLIVE),
    ("IDA (second implementation)", palette::BLACK),
];

/// The colour of a curve; those not named above take the colours that are left, in turn.
pub(super) fn color(curves: &[&str], curve: &str) -> Color {
    let named = |name: &str| NAMED.iter().find(|(n, _)| *n == name);
    if let Some((_, color)) = named(curve) {
        return *color;
    }
    let mut others = curves.iter().filter(|name| named(name).is_none());
    let place = others.position(|name| *name == curve).unwrap_or(0);
    let mut left = NAMED.iter().filter(|(name, _)| !curves.contains(name));
    let count = left.clone().count();
    let color = left.nth(place % count.max(1));
    color.map_or(palette::GREY, |(_, color)| *color)
}

/// Errors against processor time, one panel a norm, and the error of position against the step or the accuracy.
pub fn figure(study: &Study, outcome: &Outcome) -> Figure {
    let mut panels = Vec::new();
    for (name, unit, of) in NORMS {
        let asked = match name {
            "acceleration" => !study.acceleration.is_empty(),
            "impulse" => !study.force.is_empty(),
            _ => true,
        };
        if asked {
            panels.push(against_time(outcome, name, unit, of));
        }
    }
    if study.compares_elements() {
        let meshes = Meshes::new(study, outcome);
        meshes.mark_cheapest(&mut panels[0]);
        panels.insert(1, meshes.errors());
        panels.insert(2, meshes.times());
    }
    panels.push(against_pace(outcome, false));
    panels.push(against_pace(outcome, true));
    panels.retain(|panel| !panel.marks.is_empty());
    let failed: Vec<String> = outcome
        .runs
        .iter()
        .filter(|run| run.result.is_err())
        .map(|run| format!("{} at {}", run.curve, run.pace))
        .collect();
    let failures = match failed.as_slice() {
        [] => "No run failed.".to_owned(),
        list => format!("Failed: {} (crosses).", list.join("; ")),
    };
    let kept = match study.compares_elements() {
        true => {
            " An error is reached where finer steps keep it: few elements and a long step may cancel by luck, and the reference \
             has elements too."
        }
        false => "",
    };
    let [coarse, fine] = study.reference.paces();
    let scene = study
        .scene
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let caption = format!(
        "{}. Scene {}, the first {}; errors are the largest over rows every {}. Reference: {}, {coarse} and {fine}; dashed: \
             the difference between the two, below which errors are not distinguished.{kept} {failures}",
        outcome.title,
        with(&scene, &study.set, None),
        numbers::si(study.duration, "s"),
        numbers::si(study.interval, "s"),
        with("", &study.reference.set, study.reference.elements),
    );
    Figure::grid(panels, 2, caption)
}

/// A name, what is changed in it and how many elements its flexible links have.
fn with(name: &str, set: &[String], elements: Option<usize>) -> String {
    let name = Some(name.to_owned()).filter(|name| !name.is_empty());
    let elements = elements.map(|n| format!("{n} elements per flexible link"));
    let parts = name.into_iter().chain(set.iter().cloned()).chain(elements);
    parts.collect::<Vec<String>>().join(", ")
}

/// Points of a curve that reached the end, as (abscissa, error).
fn points(
    outcome: &Outcome,
    curve: &str,
    abscissa: impl Fn(usize) -> Option<f64>,
    of: fn(&super::Errors) -> f64,
) -> (Vec<f64>, Vec<f64>) {
    let runs = outcome.runs.iter().enumerate();
    runs.filter(|(_, run)| run.curve == curve)
        .filter_map(|(i, run)| Some((abscissa(i)?, of(&run.result.as_ref().ok()?.errors))))
        .filter(|(x, error)| *x > 0.0 && *error > 0.0)
        .unzip()
}

fn lines(label: &str, color: Color, (x, y): (Vec<f64>, Vec<f64>)) -> Vec<Mark> {
    if x.is_empty() {
        return Vec::new();
    }
    vec![
        Mark::curve("", color, &x, &y),
        Mark::points(label, color, &x, &y, 8),
    ]
}

fn against_time(
    outcome: &Outcome,
    name: &str,
    unit: &'static str,
    of: fn(&super::Errors) -> f64,
) -> Panel {
    let seconds = |i: usize| outcome.timings[i].as_ref().map(|t| t.median);
    let mut marks = Vec::new();
    for curve in outcome.curves() {
        let color = color(&outcome.curves(), curve);
        marks.extend(lines(curve, color, points(outcome, curve, seconds, of)));
    }
    let floor = of(&outcome.floor);
    if floor > 0.0 && name != "energy" {
        marks.push(Mark::level("", palette::BLACK, floor));
    }
    Panel {
        title: format!("Error of {name}"),
        note: String::new(),
        x: Axis::new("Processor time", "s", 1.0).log(),
        y: Axis::new("Error", unit, 1.0).log(),
        marks,
    }
}

/// Against the accuracies asked for with `asked`, else against steps.
fn against_pace(outcome: &Outcome, asked: bool) -> Panel {
    let abscissa = |i: usize| match (outcome.runs[i].pace, asked) {
        (Pace::Step(step), false) => Some(step),
        (Pace::Accuracy { position, .. }, true) => Some(position),
        _ => None,
    };
    let mut marks = Vec::new();
    for curve in outcome.curves() {
        let color = color(&outcome.curves(), curve);
        let found = points(outcome, curve, abscissa, |e| e.position);
        marks.extend(lines(curve, color, found));
    }
    let top = marks
        .iter()
        .fold(f64::MIN_POSITIVE, |top, mark| match mark.shape {
            plot::Shape::Points { .. } => mark.y.iter().copied().fold(top, f64::max),
            _ => top,
        });
    for (i, run) in outcome.runs.iter().enumerate() {
        if let (Err(_), Some(x)) = (&run.result, abscissa(i)) {
            let color = color(&outcome.curves(), &run.curve);
            marks.push(Mark::cross("", color, (x, top)));
        }
    }
    if asked && !marks.is_empty() {
        let all: Vec<f64> = (0..outcome.runs.len()).filter_map(abscissa).collect();
        let low = all.iter().copied().fold(f64::INFINITY, f64::min);
        let high = all.iter().copied().fold(0.0, f64::max);
        let ends = [low, high];
        marks.push(Mark::curve("as asked", palette::GREY, &ends, &ends));
        marks.push(Mark::curve(
            "ten times",
            palette::BLACK,
            &ends,
            &ends.map(|x| 10.0 * x),
        ));
    }
    let (title, label, unit) = match asked {
        true => (
            "Error of position against the accuracy",
            "Requested accuracy",
            "m",
        ),
        false => ("Error of position against the step", "Step h", "s"),
    };
    Panel {
        title: title.into(),
        note: String::new(),
        x: Axis::new(label, unit, 1.0).log(),
        y: Axis::new("Error", "m", 1.0).log(),
        marks,
    }
}
