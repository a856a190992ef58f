//! Work-precision diagrams.

use super::elements::Meshes;
use super::errors::NORMS;
use super::{Compared, CurvePoint, Errors, Found, Study, StudyOutcome, StudyPace};
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Curves that several studies have, each with the same colour in all of them.
const NAMED: [(&str, Color); 17] = [
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
    ("DOP853", palette::GOLD),
    ("DOP853, error controlled", palette::CLARET),
    ("ESDIRK of order 5", palette::LIME),
    ("ESDIRK of order 5, error controlled", palette::ROSE),
    ("auto, error controlled", palette::SLATE),
    ("IDA (second implementation)", palette::BLACK),
];

/// Errors against processor time, one panel a norm, and the error of position against the step or the accuracy.
pub(super) fn figure(study: &Study, outcome: &StudyOutcome) -> Figure {
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
    let failed = outcome.runs.iter().filter(|run| run.result.is_err());
    let failed = failed.map(|run| format!("{} at {}", run.curve, run.pace));
    let failures = match failed.collect::<Vec<String>>().as_slice() {
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
    let caption = format!(
        "{}. Scene {}, the first {}; errors are the largest over rows every {}. Reference: {}, {coarse} and {fine}; dashed: \
             the difference between the two, below which errors are not distinguished.{kept} {failures}",
        study.title,
        with(&study.scene_name(), &study.set, None),
        numbers::si(study.duration, "s"),
        numbers::si(study.interval, "s"),
        with("", &study.reference.set, study.reference.elements),
    );
    Figure::grid(panels, 2, caption)
}

/// A name, what is changed in it and how many elements its flexible links have.
fn with(name: &str, set: &[String], elements: Option<usize>) -> String {
    let mut parts = vec![name.to_owned()];
    parts.extend_from_slice(set);
    parts.extend(elements.map(|n| format!("{n} elements per flexible link")));
    parts.retain(|part| !part.is_empty());
    parts.join(", ")
}

impl<C: Compared> Found<C> {
    /// The colour of a curve; those not named above take the colours that are left, in turn.
    pub(super) fn color(&self, curve: &str) -> Color {
        let named = |name: &str| NAMED.iter().find(|(n, _)| *n == name);
        if let Some((_, color)) = named(curve) {
            return *color;
        }
        let curves = self.curves();
        let mut others = curves.iter().filter(|name| named(name).is_none());
        let place = others.position(|name| *name == curve).unwrap_or(0);
        let mut left = NAMED.iter().filter(|(name, _)| !curves.contains(name));
        let count = left.clone().count();
        let color = left.nth(place % count.max(1));
        color.map_or(palette::GREY, |(_, color)| *color)
    }

    /// The marks of every curve in its colour: `draw` makes them from the points that are there and positive.
    pub(super) fn marks(
        &self,
        point: impl Fn(usize, &CurvePoint<C::Measured>) -> Option<(f64, f64)>,
        draw: impl Fn(&str, Color, &[f64], &[f64]) -> Vec<Mark>,
    ) -> Vec<Mark> {
        let mut marks = Vec::new();
        for curve in self.curves() {
            let runs = self.runs.iter().enumerate();
            let points = runs.filter(|(_, run)| run.curve == curve);
            let points = points.filter_map(|(i, run)| point(i, run));
            let (x, y): (Vec<f64>, Vec<f64>) = points.filter(|(x, y)| *x > 0.0 && *y > 0.0).unzip();
            if !x.is_empty() {
                marks.extend(draw(curve, self.color(curve), &x, &y));
            }
        }
        marks
    }

    /// Processor time of a run.
    pub(super) fn seconds(&self, run: usize) -> Option<f64> {
        Some(self.timings[run].as_ref()?.median)
    }
}

fn lines(label: &str, color: Color, x: &[f64], y: &[f64]) -> Vec<Mark> {
    vec![
        Mark::curve("", color, x, y),
        Mark::points(label, color, x, y, 8),
    ]
}

fn against_time(
    outcome: &StudyOutcome,
    name: &str,
    unit: &'static str,
    of: fn(&Errors) -> f64,
) -> Panel {
    let mut marks = outcome.marks(
        |i, run| Some((outcome.seconds(i)?, of(&run.result.as_ref().ok()?.errors))),
        lines,
    );
    let floor = of(&outcome.reference.floor);
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
fn against_pace(outcome: &StudyOutcome, asked: bool) -> Panel {
    let abscissa = |pace: StudyPace| match (pace, asked) {
        (StudyPace::Step(step), false) => Some(step),
        (StudyPace::Accuracy { position, .. }, true) => Some(position),
        _ => None,
    };
    let mut marks = outcome.marks(
        |_, run| {
            Some((
                abscissa(run.pace)?,
                run.result.as_ref().ok()?.errors.position,
            ))
        },
        lines,
    );
    let heights = marks.iter().flat_map(|mark| &mark.y);
    let top = heights.copied().fold(f64::MIN_POSITIVE, f64::max);
    let all = outcome.runs.iter();
    let all: Vec<_> = all
        .filter_map(|run| Some((run, abscissa(run.pace)?)))
        .collect();
    for (run, x) in &all {
        if run.result.is_err() {
            marks.push(Mark::cross("", outcome.color(&run.curve), (*x, top)));
        }
    }
    if asked && !marks.is_empty() {
        let fold = |f: fn(f64, f64) -> f64, from| all.iter().map(|(_, x)| *x).fold(from, f);
        let ends = [fold(f64::min, f64::INFINITY), fold(f64::max, 0.0)];
        let tenfold = ends.map(|x| 10.0 * x);
        marks.push(Mark::curve("as asked", palette::GREY, &ends, &ends));
        marks.push(Mark::curve("ten times", palette::BLACK, &ends, &tenfold));
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
