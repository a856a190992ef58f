//! Quantities over time with a known error: between kept rows they are interpolated linearly.

use super::pack::{Pack, Packed};
use serde::Serialize;

/// Steps of a quantised number over its range.
const STEPS: f64 = 65535.0;

/// Some quantities at the same kept rows.
#[derive(Debug, Serialize)]
pub struct Group {
    keys: Packed,
    tracks: Vec<Track>,
}

/// One quantity at the kept rows of its group: offset + scale times what is stored.
#[derive(Debug, Serialize)]
struct Track {
    offset: f64,
    scale: f64,
    data: Packed,
}

/// One quantity at every row, and the error that its track may have.
#[derive(Debug, Clone)]
pub struct Signal {
    /// The values.
    pub values: Vec<f64>,
    /// Error allowed between kept rows.
    pub tolerance: f64,
}

impl Group {
    /// Keeps the rows that the tolerances need, as they are.
    pub fn exact(times: &[f64], signals: &[Signal], pack: &mut Pack) -> Group {
        Group::of(times, signals, pack, |values, pack| Track {
            offset: 0.0,
            scale: 1.0,
            data: pack.add(values.iter().copied()),
        })
    }

    /// Keeps the rows that the tolerances need, as 32-bit numbers.
    pub fn single(times: &[f64], signals: &[Signal], pack: &mut Pack) -> Group {
        Group::of(times, signals, pack, |values, pack| Track {
            offset: 0.0,
            scale: 1.0,
            data: pack.add(values.iter().map(|x| *x as f32)),
        })
    }

    /// Keeps the rows that the tolerances need, as 16-bit numbers between the least and the greatest value: their error is at most
    /// 1/131070 of that range.
    pub fn quantised(times: &[f64], signals: &[Signal], pack: &mut Pack) -> Group {
        Group::of(times, signals, pack, |values, pack| {
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let scale = (greatest - least) / STEPS;
            let steps = values.iter().map(|x| match scale > 0.0 {
                true => ((x - least) / scale).round() as u16,
                false => 0,
            });
            Track {
                offset: least,
                scale,
                data: pack.add(steps),
            }
        })
    }

    fn of(
        times: &[f64],
        signals: &[Signal],
        pack: &mut Pack,
        track: impl Fn(&[f64], &mut Pack) -> Track,
    ) -> Group {
        let keys = keys(times, signals);
        let tracks = signals.iter().map(|signal| {
            let values: Vec<f64> = keys.iter().map(|&row| signal.values[row]).collect();
            track(&values, pack)
        });
        let tracks = tracks.collect();
        Group {
            keys: pack.add(keys.iter().map(|&row| row as u32)),
            tracks,
        }
    }
}

/// Rows such that the line between two neighbouring ones passes every row between them within the tolerance of every signal. From
/// each kept row the slopes are followed that pass all rows so far; the row before the first that lies outside them is the next.
pub fn keys(times: &[f64], signals: &[Signal]) -> Vec<usize> {
    const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    let mut kept = vec![0];
    let mut slopes = vec![ANY; signals.len()];
    let mut from = 0;
    for row in 1..times.len() {
        let rise = |signal: &Signal, from: usize| signal.values[row] - signal.values[from];
        let span = |from: usize| times[row] - times[from];
        let fits = signals
            .iter()
            .zip(&slopes)
            .all(|(signal, [least, greatest])| {
                let slope = rise(signal, from) / span(from);
                *least <= slope && slope <= *greatest
            });
        if !fits {
            from = row - 1;
            kept.push(from);
            slopes.fill(ANY);
        }
        for (signal, slopes) in signals.iter().zip(&mut slopes) {
            let (rise, error, span) = (rise(signal, from), signal.tolerance, span(from));
            slopes[0] = slopes[0].max((rise - error) / span);
            slopes[1] = slopes[1].min((rise + error) / span);
        }
    }
    if times.len() > 1 {
        kept.push(times.len() - 1);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Every row is within the tolerance of the line between the kept rows around it.
        #[test]
        fn lines_between_kept_rows_pass_all_rows(
            steps in prop::collection::vec((0.1_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0), 1..200),
            tolerance in 0.0_f64..2.0,
        ) {
            let mut times = vec![0.0];
            let mut walks = [vec![0.0], vec![0.0]];
            for (dt, a, b) in &steps {
                times.push(times[times.len() - 1] + dt);
                for (walk, by) in walks.iter_mut().zip([a, b]) {
                    walk.push(walk[walk.len() - 1] + by);
                }
            }
            let signals = walks.map(|values| Signal { values, tolerance });
            let kept = keys(&times, &signals);
            prop_assert_eq!(kept[0], 0);
            prop_assert_eq!(kept[kept.len() - 1], times.len() - 1);
            for pair in kept.windows(2) {
                for row in pair[0]..=pair[1] {
                    let share = (times[row] - times[pair[0]]) / (times[pair[1]] - times[pair[0]]);
                    for signal in &signals {
                        let [a, b] = [pair[0], pair[1]].map(|row| signal.values[row]);
                        let error = (a + share * (b - a) - signal.values[row]).abs();
                        // rounding of some operations on numbers below 200
                        prop_assert!(error <= tolerance + 1e-12, "{} {}", error, tolerance);
                    }
                }
            }
        }
    }

    /// What moves evenly needs its ends alone.
    #[test]
    fn an_even_motion_keeps_two_rows() {
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        let values = times.iter().map(|t| 0.25 * t).collect();
        let signal = Signal {
            values,
            tolerance: 1e-9,
        };
        assert_eq!(keys(&times, &[signal]), [0, 99]);
    }
}
