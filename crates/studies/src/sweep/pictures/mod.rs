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
use plot::{Axis, Figure, Panel, palette};

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
    // the first parameter with numbers, over which a grid is drawn
    let abscissa = parameters.iter().position(|(_, p)| numeric(p));
    let curves = abscissa.map(|place| curves(&parameters, place));
    // words cannot be the ordinate of a map, so they have more curves
    let worded = parameters.iter().filter(|(_, p)| !numeric(p)).count();
    let most_curves = match worded + 1 == parameters.len() {
        true => palette::SERIES.len(),
        false => CURVES,
    };
    let ends = merged.crossing.as_ref().and_then(|crossing| {
        let [from, to] = &crossing.between;
        Some([from.number()?, to.number()?])
    });
    for m in 0..study.measures.len() {
        let of = MeasurePoints::new(sweep, points, m);
        match (study.design, &parameters[..], abscissa) {
            (DesignKind::Grid, [(_, x), (_, y)], _)
                if worded == 0 && distinct(x) > 1 && distinct(y) > CURVES =>
            {
                mapped = true;
                thinned |= x.levels().max(y.levels()) > heat_map::MOST;
                panels.push(heat_map::panel(&of, parameters[0], parameters[1]));
            }
            (DesignKind::Grid, _, Some(place)) if curves <= Some(most_curves) => {
                thinned |= parameters[place].1.levels() > response::MOST;
                panels.push(response::panel(&of, &parameters, place));
            }
            (_, _, None) if points.values.len() <= comparison::MOST => {
                panels.push(comparison::panel(&of, &parameters));
            }
            _ => {
                thinned |= points.values.len() > scatter::MOST && abscissa.is_some();
                let target = study.target.as_ref();
                let shown = parameters.iter().enumerate();
                let shown = shown.filter(|(_, (_, parameter))| numeric(parameter));
                let shown = shown.map(|(j, p)| scatter::panel(&of, j, *p, target, ends));
                panels.extend(shown);
            }
        }
    }
    if panels.is_empty() {
        notes.push("Parameters with so many words are not drawn: see sweep.csv.".to_owned());
    }
    if thinned {
        notes.push("Of many points some are drawn.".to_owned());
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
            "Courses, over the runs of all points: dark from the mean least to the mean largest value of a run, pale from the least \
             to the largest of all."
                .to_owned(),
        );
    }
    let columns = match panels.len() {
        // names of lines take the room of a panel
        _ if panels.iter().any(|panel| !panel.y.names.is_empty()) => 1,
        n if n > 4 => 3,
        n => n.min(2),
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

/// Curves of a grid over the parameter with this place.
fn curves(parameters: &[(&String, &SweepParameter)], place: usize) -> usize {
    let others = parameters.iter().enumerate().filter(|(j, _)| *j != place);
    let others = others.map(|(_, (_, p))| p.levels());
    others.fold(1, usize::saturating_mul)
}

/// The least distance at which at most `most` of `count` points are drawn and the values of no parameter of a grid are passed
/// over: it has no divisor in common with the number of points.
fn stride(count: usize, most: usize) -> usize {
    let divisor = |a: usize, b: usize| {
        let (mut a, mut b) = (a, b);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let mut strides = count.div_ceil(most).max(1)..;
    let found = strides.find(|stride| divisor(*stride, count.max(1)) == 1);
    found.expect("there are numbers that do not divide another")
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
    let title = &merged.title;
    let stop = if title.ends_with(['.', '?', '!']) {
        ""
    } else {
        "."
    };
    let mut text = format!("{title}{stop} Scene {}", merged.scene);
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

#[cfg(test)]
mod tests {
    use super::stride;

    #[test]
    fn points_that_are_drawn_have_all_values_of_a_grid() {
        for (levels, most) in [([70, 70, 5], 5000), ([20, 20, 20], 5000), ([3, 3, 3], 5000)] {
            let count: usize = levels.iter().product();
            let drawn = (0..count).step_by(stride(count, most));
            let drawn: Vec<usize> = drawn.collect();
            assert!(drawn.len() <= most && 4 * drawn.len() > count.min(most));
            // the last parameter varies fastest
            let mut seen = vec![false; levels[2]];
            drawn
                .iter()
                .for_each(|point| seen[point % levels[2]] = true);
            assert!(seen.iter().all(|seen| *seen), "{levels:?}");
        }
        assert_eq!([stride(0, 9), stride(1, 9), stride(9, 9)], [1; 3]);
    }
}
