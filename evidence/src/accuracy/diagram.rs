//! Errors against processor time, so that one can read them: the least time of all methods, six of them in colour, the rest grey.

use crate::accuracy::page::{AUTOMATIC, Motion, PAPER, winner, winners};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use studies::precision::{Found, MotionReference, Times};

/// Methods in colour.
const COLORED: usize = 6;
/// The least time of all methods.
const FRONTIER: Color = (222, 222, 205);
/// The other methods.
const OTHERS: Color = (185, 185, 185);
/// Errors of position that panels show \[m\].
const RANGE: [f64; 2] = [3e-14, 3e-5];

/// Errors at which curves are compared \[m\], four a decade.
pub fn levels() -> impl Iterator<Item = f64> {
    (0..=28).map(|k| 1e-5 * 10_f64.powf(-0.25 * f64::from(k)))
}

/// A panel a study, two beside each other.
pub fn work_and_precision(studies: &[&Motion]) -> Figure {
    let mut chosen = vec![PAPER, AUTOMATIC];
    for (curve, _) in winners(studies) {
        if !chosen.contains(&curve) && chosen.len() < COLORED {
            chosen.push(curve);
        }
    }
    let panels = studies.iter().enumerate();
    let panels = panels.map(|(k, one)| panel(one, &chosen, k == 0));
    let caption = "Largest error of position over the duration of a study against the processor time of the run, a dot a run. Star: the \
                   method follows a requested accuracy; without it the step is fixed. The band is the least time of all methods that were run, \
                   between runs on the line through them.";
    Figure::grid(panels.collect(), 2, caption.to_owned())
}

fn panel(one: &Motion, chosen: &[&str], first: bool) -> Panel {
    let label = |text: &str| {
        if first {
            text.to_owned()
        } else {
            String::new()
        }
    };
    let least = levels().filter_map(|error| {
        let (_, time) = winner(one, error, Times::Interpolated, |_| true)?;
        Some((time.seconds, error))
    });
    let (x, y): (Vec<f64>, Vec<f64>) = least.unzip();
    let text = label("least time of all methods");
    let mut marks = vec![Mark::curve(&text, FRONTIER, &x, &y).width(16)];
    let mut others = label("other methods");
    let mut names = Vec::new();
    let curves = one.found.curves().into_iter();
    let (front, back): (Vec<&str>, Vec<&str>) = curves.partition(|c| chosen.contains(c));
    for curve in back.into_iter().chain(front) {
        let (x, y) = points(&one.found, curve);
        let place = chosen.iter().position(|name| *name == curve);
        let color = place.map_or(OTHERS, |place| palette::SERIES[place]);
        let text = match place {
            None => std::mem::take(&mut others),
            Some(_) => String::new(),
        };
        marks.push(Mark::curve("", color, &x, &y).width(if place.is_some() { 4 } else { 2 }));
        marks.push(Mark::points(&text, color, &x, &y, 6));
        if let (Some(_), Some(x), Some(y)) = (place, x.last(), y.last()) {
            names.push(Mark::name(
                &curve.replace(", error controlled", "*"),
                color,
                (*x, *y),
            ));
        }
    }
    marks.extend(names);
    let floor = one.found.reference.floor.position;
    let text = label("uncertainty of the reference");
    marks.push(Mark::level(&text, palette::BLACK, floor));
    Panel {
        title: one.name.clone(),
        note: one.found.title.clone(),
        x: Axis::new("Processor time", "s", 1.0).log(),
        y: Axis::new("Error of position", "m", 1.0)
            .log()
            .over(RANGE[0].max(0.3 * floor), RANGE[1]),
        marks,
    }
}

/// Times and errors of the runs of a curve.
fn points(found: &Found<MotionReference>, curve: &str) -> (Vec<f64>, Vec<f64>) {
    let runs = found.runs.iter().zip(&found.timings);
    let own = runs.filter(|(run, _)| run.curve == curve);
    let points = own.filter_map(|(run, timing)| {
        Some((
            timing.as_ref()?.median,
            run.result.as_ref().ok()?.errors.position,
        ))
    });
    points.filter(|(_, error)| *error > 0.0).unzip()
}
