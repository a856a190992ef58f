//! Fig. 9: acceleration against velocity of the platform along x. a) case 2, b) case 3, c) case 4. The paper calls the
//! curve a Poincare map; it is a phase portrait. Below it stands a section once a period.

use crate::campaign::{Campaign, DURATION, FROM, ROWS_A_PERIOD};
use crate::figures::{caption, step_label};
use crate::numbers::Numbers;
use crate::runs::CaseRecording;
use crate::signal::{mean, rms};
use numbers::digits;
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Draws the figure.
pub fn figure(c: &Campaign, numbers: &mut Numbers) -> Figure {
    let portrait = |title: &str, shown: &[(&CaseRecording, Color)]| {
        let (_, v) = c.ideal.between("platform.vx", FROM, DURATION);
        let (_, a) = c.ideal.between("platform.ax", FROM, DURATION);
        let mut marks: Vec<Mark> = shown
            .iter()
            .map(|&(r, color)| {
                let (_, v) = r.between("platform.vx", FROM, DURATION);
                Mark::curve(
                    &step_label(r),
                    color,
                    v,
                    r.between("platform.ax", FROM, DURATION).1,
                )
            })
            .collect();
        marks.push(Mark::curve("case 1 (ideal)", palette::GREY, v, a));
        Panel {
            title: title.into(),
            note: String::new(),
            x: Axis::new("Velocity ẋ", "m/s", 1.0),
            y: Axis::new("Acceleration ẍ", "m/s²", 1.0),
            marks,
        }
    };
    let [coarse2, fine2, loose, both] = &c.sections;
    let top = vec![
        portrait(
            "a) Case 2",
            &[
                (&c.flexible, palette::BLUE),
                (&c.flexible_coarse, palette::VERMILION),
            ],
        ),
        portrait("b) Case 3", &[(&c.loose, palette::BLUE)]),
        portrait("c) Case 4", &[(&c.both, palette::BLUE)]),
    ];
    let mut section = |title: &str, name: &str, shown: &[(&CaseRecording, Color)]| {
        let points: Vec<(Vec<f64>, Vec<f64>)> = shown.iter().map(|(r, _)| section(c, r)).collect();
        let spread = numbers.put(
            format!("fig9.{name}.section_spread_acceleration"),
            spread(&points[0].1),
        );
        let marks = shown
            .iter()
            .zip(&points)
            .map(|((r, color), (v, a))| Mark::points(&step_label(r), *color, v, a, 7));
        let marks = marks
            .chain([Mark::cross("ideal", palette::BLACK, (0.0, 0.0))])
            .collect();
        Panel {
            title: title.into(),
            note: format!(
                "{} points, rms spread of ẍ {}\u{a0}m/s².",
                c.settings.periods,
                digits(spread)
            ),
            x: Axis::new("ẋ − ẋ ideal", "µm/s", 1e6),
            y: Axis::new("ẍ − ẍ ideal", "m/s²", 1.0),
            marks,
        }
    };
    let bottom = vec![
        section(
            "a) Case 2, once a period",
            "case2",
            &[(fine2, palette::BLUE), (coarse2, palette::VERMILION)],
        ),
        section(
            "b) Case 3, once a period",
            "case3",
            &[(loose, palette::BLUE)],
        ),
        section(
            "c) Case 4, once a period",
            "case4",
            &[(both, palette::BLUE)],
        ),
    ];
    let text = format!(
        "Top: acceleration against velocity of the platform along x over cycles 2 and 3, the curve the paper calls a \
         Poincaré map. Bottom: stroboscopic section, one point a period at t = kT over {} periods after the first {}, \
         as deviation from the ideal mechanism; a periodic motion gives one point. Its spread is that of the first step in the legend. \
         Controlled: steps that keep the errors within 10 ms below 1 µm and 100 nJ.",
        c.settings.periods, c.settings.skipped
    );
    Figure {
        rows: vec![top, bottom],
        caption: caption(
            &text,
            &[
                &c.flexible,
                &c.flexible_coarse,
                &c.loose,
                &c.both,
                coarse2,
                fine2,
                loose,
                both,
            ],
        ),
    }
}

/// Deviation of velocity and acceleration from the ideal ones once a period, after the periods left out.
pub fn section(c: &Campaign, recording: &CaseRecording) -> (Vec<f64>, Vec<f64>) {
    let from = f64::from(c.settings.skipped + 1) / c.geometry.frequency;
    let (t, v) = recording.between("platform.vx", from, f64::MAX);
    let (_, a) = recording.between("platform.ax", from, f64::MAX);
    let deviation = |y: &[f64], ideal: &dyn Fn(f64) -> f64| {
        let pairs = t.iter().zip(y).step_by(ROWS_A_PERIOD as usize);
        pairs.map(|(&t, y)| y - ideal(t)).collect()
    };
    (
        deviation(v, &|t| c.geometry.velocity_x(t)),
        deviation(a, &|t| c.geometry.acceleration_x(t)),
    )
}

/// Root mean square distance from the mean.
pub fn spread(y: &[f64]) -> f64 {
    let mean = mean(y);
    rms(&y.iter().map(|v| v - mean).collect::<Vec<f64>>())
}
