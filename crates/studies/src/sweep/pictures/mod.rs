//! The picture of a sweep: what each measure does, and the course of the runs.

mod comparison;
mod course;
mod heat_map;
mod influence;
mod response;
mod scatter;

use super::design::DesignKind;
use super::merge::{Merged, Points};
use super::{FieldValue, Spacing, Sweep, SweepParameter};
use plot::{Axis, Figure, Panel};

/// Curves of a panel; more values of a second parameter are a map.
const CURVES: usize = 6;

/// All panels of a sweep, two or three beside each other, and what they show.
pub fn figure(sweep: &Sweep, merged: &Merged, points: &Points) -> Figure {
    let study = &sweep.study;
    let parameters: Vec<(&String, &SweepParameter)> = study.parameters.iter().collect();
    let mut panels = Vec::new();
    let mut notes = Vec::new();
    let (mut mapped, mut thinned) = (false, false);
    let numeric = |p: &SweepParameter| p.values.iter().all(|value| value.number().is_some());
    // place of the first parameter with numbers, over which a grid is drawn
    let numbers = parameters.iter().position(|(_, p)| numeric(p));
    let numbers = numbers.unwrap_or(parameters.len());
    for m in 0..study.measures.len() {
        let of = MeasurePoints::new(sweep, points, m);
        match (study.design, &parameters[..]) {
            (DesignKind::Grid, [(_, x), (_, y)])
                if numeric(x) && numeric(y) && distinct(x) > 1 && distinct(y) > CURVES =>
            {
                mapped = true;
                thinned |= x.levels().max(y.levels()) > heat_map::MOST;
                panels.push(heat_map::panel(&of, parameters[0], parameters[1]));
            }
            (DesignKind::Grid, _) if curves(&parameters, numbers) <= CURVES => {
                panels.push(response::panel(&of, &parameters, numbers));
            }
            (DesignKind::Grid, _)
                if numbers == parameters.len() && points.values.len() <= comparison::MOST =>
            {
                panels.push(comparison::panel(&of, &parameters));
            }
            _ => {
                thinned |= points.values.len() > scatter::MOST;
                let shown = parameters.iter().enumerate();
                let shown = shown.filter(|(_, (_, parameter))| numeric(parameter));
                panels
                    .extend(shown.map(|(j, p)| scatter::panel(&of, j, *p, study.target.as_ref())));
            }
        }
    }
    if thinned {
        notes.push("Of many points some are drawn, at equal distances.".to_owned());
    }
    if study.starts_of_a_point() > 1 {
        let starts = study.starts_of_a_point();
        notes.push(match mapped {
            true => format!("Values are means over {starts} starts."),
            false => format!("Bands and lines: 95 % interval of the mean over {starts} starts."),
        });
    }
    let charts = merged.indices.iter();
    let charts = charts.map(|(name, of)| vec![influence::panel(name, of)]);
    let mut rows: Vec<Vec<Panel>> = charts.collect();
    if let Some(of) = merged.indices.values().map(|of| of.samples).min() {
        notes.push(format!(
            "Sobol indices from {of} samples with their 95 % intervals; what chaos adds to a measure counts as taking part."
        ));
    }
    if !study.envelopes.is_empty() {
        notes.push(
            "Courses: dark from the mean least to the mean largest value of a run, pale from the least to the largest of all."
                .to_owned(),
        );
    }
    let columns = if panels.len() > 4 {
        3
    } else {
        2.min(panels.len())
    };
    rows.extend(Figure::grid(panels, columns, String::new()).rows);
    let courses = 0..study.envelopes.len();
    rows.extend(courses.map(|k| vec![course::panel(sweep, points, k)]));
    Figure {
        rows,
        caption: caption(sweep, merged, &notes),
    }
}

/// Different values of a parameter with numbers.
fn distinct(parameter: &SweepParameter) -> usize {
    let levels = (0..parameter.levels()).filter_map(|k| parameter.level(k).number());
    let mut levels: Vec<f64> = levels.collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels.len()
}

/// Curves of a grid over the parameter with this place; as many as one can imagine if there is none.
fn curves(parameters: &[(&String, &SweepParameter)], place: usize) -> usize {
    if place == parameters.len() {
        return usize::MAX;
    }
    let others = parameters.iter().enumerate().filter(|(j, _)| *j != place);
    let others = others.map(|(_, (_, p))| p.levels());
    others.fold(1, usize::saturating_mul)
}

/// A measure at every point.
struct MeasurePoints<'a> {
    name: &'a str,
    description: String,
    unit: &'a str,
    points: &'a Points,
    measure: usize,
}

impl<'a> MeasurePoints<'a> {
    fn new(sweep: &'a Sweep, points: &'a Points, measure: usize) -> MeasurePoints<'a> {
        let measures = &sweep.study.measures;
        let (name, kind) = measures.get_index(measure).expect("in range");
        MeasurePoints {
            name,
            description: kind.description(),
            unit: &sweep.units()[measure],
            points,
            measure,
        }
    }

    /// Its mean at a point, and the ends of the interval.
    fn at(&self, point: usize) -> Option<(f64, f64, f64)> {
        let mean = self.points.means[self.measure][point]?;
        let (low, high) = mean.interval();
        Some((mean.mean, low, high))
    }

    /// The number that a parameter has at a point.
    fn abscissa(&self, point: usize, parameter: usize) -> f64 {
        let value = &self.points.values[point][parameter];
        value.number().unwrap_or(f64::NAN)
    }

    /// A panel with its name and description, over some abscissa.
    fn panel(&self, x: Axis) -> Panel {
        self.panel_over(x, axis(self.name, self.unit))
    }

    /// The same with another ordinate.
    fn panel_over(&self, x: Axis, y: Axis) -> Panel {
        Panel {
            note: self.description.clone(),
            ..empty(self.name, x, y)
        }
    }
}

/// A value of a parameter for a legend.
fn label(name: &str, parameter: &SweepParameter, value: &FieldValue) -> String {
    let name = name.replace('_', " ");
    match (value.number(), parameter.unit.as_str()) {
        (None, _) | (_, "" | "1") => format!("{name} {value}"),
        // half a hertz is not 500 mHz
        (Some(x), unit) if (0.1..1.0).contains(&x.abs()) => format!("{name} {value} {unit}"),
        (Some(x), unit) => format!("{name} {}", numbers::si(x, unit)),
    }
}

/// An axis with the name of a column as its label.
fn axis(name: &str, unit: &str) -> Axis {
    let unit = if unit == "1" { "" } else { unit };
    Axis::new(&name.replace('_', " "), unit, 1.0)
}

/// The axis of a parameter.
fn parameter_axis((name, parameter): (&String, &SweepParameter)) -> Axis {
    let axis = axis(name, &parameter.unit);
    match parameter.spacing {
        Spacing::Log => axis.log(),
        Spacing::Linear => axis,
    }
}

/// A panel without marks.
fn empty(title: &str, x: Axis, y: Axis) -> Panel {
    Panel {
        title: title.replace('_', " "),
        note: String::new(),
        x,
        y,
        marks: Vec::new(),
    }
}

/// Scene, number of runs, what changed in every run, and the notes of the panels.
fn caption(sweep: &Sweep, merged: &Merged, notes: &[String]) -> String {
    let study = &sweep.study;
    let mut text = format!("{}. Scene {}", merged.title, merged.scene);
    // the method is said in words
    let changes = study.set.iter();
    let varies = |change: &str| {
        let path = change.split('=').next().unwrap_or_default().trim();
        let parameters = study.parameters.values();
        parameters
            .flat_map(|p| &p.fields)
            .any(|field| field.path() == path)
    };
    for change in changes.filter(|c| !c.starts_with("integrator.") && !varies(c)) {
        text += &format!(", {change}");
    }
    text += &format!("; {}; {} runs", sweep.method(), merged.runs);
    let without = merged.status["failed"] + merged.status["refused"];
    if without > 0 {
        text += &format!(", {without} of them without result");
    }
    if merged.warned > 0 {
        text += &format!(", {} with warnings", merged.warned);
    }
    text += ".";
    if let Some(answer) = super::page::answer(sweep, merged) {
        text += &format!(" {}", answer.replace('`', ""));
    }
    for note in notes {
        text += &format!(" {note}");
    }
    text
}
