//! Fig. 9: acceleration against velocity of the platform along x. a) case 2, b) case 3, c) case 4. The paper calls the
//! curve a Poincare map; it is a phase portrait. Below it stands a section once a period.

use super::{caption, flexible};
use crate::figures::{FigureRuns, PERIODS, ROWS_A_PERIOD, SKIPPED};
use crate::kinematics::MechanismGeometry;
use crate::runs::{CaseRecording, DURATION, FROM};
use crate::signal::{mean, rms};
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Draws the figure.
pub fn figure(runs: &FigureRuns) -> Figure {
    let portrait = |title: &str, shown: &[(&CaseRecording, Color)]| {
        let curve = |label: &str, (run, color): (&CaseRecording, Color)| {
            let between = |channel| run.between(channel, FROM, DURATION).1;
            Mark::curve(label, color, between("platform.vx"), between("platform.ax"))
        };
        let mut marks: Vec<Mark> = shown
            .iter()
            .map(|run| curve(&run.0.plan.pace.label(), *run))
            .collect();
        marks.push(curve("case 1 (ideal)", (runs.get("ideal"), palette::GREY)));
        Panel {
            title: title.into(),
            note: String::new(),
            x: Axis::new("Velocity ẋ", "m/s", 1.0),
            y: Axis::new("Acceleration ẍ", "m/s²", 1.0),
            marks,
        }
    };
    let names = ["flexible", "coarse", "loose", "both"];
    let many = names.map(|name| runs.get(&format!("{name}, many periods")));
    let [fine2, coarse2, loose, both] = many;
    let section = |title: &str, shown: &[(&CaseRecording, Color)]| {
        let points = |(run, color): &(&CaseRecording, Color)| {
            let (v, a) = section(&runs.geometry, run);
            Mark::points(&run.plan.pace.label(), *color, &v, &a, 7)
        };
        let mut marks: Vec<Mark> = shown.iter().map(points).collect();
        marks.push(Mark::cross("ideal", palette::BLACK, (0.0, 0.0)));
        Panel {
            title: title.into(),
            note: String::new(),
            x: Axis::new("Velocity ẋ − ẋ ideal", "µm/s", 1e6),
            y: Axis::new("Acceleration ẍ − ẍ ideal", "m/s²", 1.0),
            marks,
        }
    };
    let top = vec![
        portrait("a) Case 2", &flexible(runs)),
        portrait("b) Case 3", &[(runs.get("loose"), palette::BLUE)]),
        portrait("c) Case 4", &[(runs.get("both"), palette::BLUE)]),
    ];
    let two = [(fine2, palette::BLUE), (coarse2, palette::VERMILION)];
    let bottom = vec![
        section("a) Case 2, once a period", &two),
        section("b) Case 3, once a period", &[(loose, palette::BLUE)]),
        section("c) Case 4, once a period", &[(both, palette::BLUE)]),
    ];
    let text = format!(
        "Top: acceleration against velocity of the platform along x over cycles 2 and 3, the curve the paper calls a \
         Poincaré map. Bottom: stroboscopic section, one point a period at t = kT over {PERIODS} periods after the first \
         {SKIPPED}, as deviation from the ideal mechanism; a periodic motion gives one point. Controlled: \
         steps that keep the errors within 10 ms below 1 µm and 100 nJ."
    );
    let made_with = [names.map(|name| runs.get(name)), many].concat();
    Figure {
        rows: vec![top, bottom],
        caption: caption(&text, &made_with),
    }
}

/// Deviation of velocity and acceleration from the ideal ones once a period, after the periods left out.
pub fn section(g: &MechanismGeometry, recording: &CaseRecording) -> (Vec<f64>, Vec<f64>) {
    let from = f64::from(SKIPPED + 1) / g.frequency;
    let deviation = |channel: &str, ideal: &dyn Fn(f64) -> f64| {
        let (t, y) = recording.between(channel, from, f64::MAX);
        let pairs = t.iter().zip(y).step_by(ROWS_A_PERIOD as usize);
        pairs.map(|(&t, y)| y - ideal(t)).collect()
    };
    (
        deviation("platform.vx", &|t| g.velocity_x(t)),
        deviation("platform.ax", &|t| g.acceleration_x(t)),
    )
}

/// Root mean square distance from the mean.
pub fn spread(y: &[f64]) -> f64 {
    let mean = mean(y);
    rms(&y.iter().map(|v| v - mean).collect::<Vec<f64>>())
}
