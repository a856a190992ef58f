//! The course of all runs over time.

use super::{axis, empty};
use crate::sweep::Sweep;
use crate::sweep::merge::Points;
use plot::{Axis, Mark, Panel, palette};

pub fn panel(sweep: &Sweep, points: &Points, place: usize) -> Panel {
    let (name, plan) = sweep.study.envelopes.get_index(place).expect("in range");
    let (duration, same) = points.duration;
    // runs of different lengths are compared at equal parts of their time
    let (x, scale) = match same {
        true => (Axis::new("Time", "s", 1.0), duration),
        false => (Axis::new("Time / duration", "", 1.0), 1.0),
    };
    let mut panel = empty(name, x, axis(name, &sweep.envelope_units()[place]));
    panel.note = plan.channels.join(", ");
    let parts = &points.envelopes[place].parts;
    let known = parts.iter().enumerate().filter(|(_, part)| part.runs > 0);
    let width = scale / parts.len() as f64;
    let mut columns: [Vec<f64>; 5] = Default::default();
    for (k, part) in known {
        let (low, high) = part.means();
        let of = [part.least, low, high, part.largest];
        // a step of the staircase
        for end in [k, k + 1] {
            columns[0].push(end as f64 * width);
            for (column, value) in columns[1..].iter_mut().zip(of) {
                column.push(value);
            }
        }
    }
    let [t, least, low, high, largest] = &columns;
    let blue = palette::BLUE;
    panel
        .marks
        .push(Mark::band("all runs", blue, t, least, largest));
    for _ in 0..2 {
        panel.marks.push(Mark::band("", blue, t, low, high));
    }
    panel
}
