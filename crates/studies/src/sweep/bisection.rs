//! Where a measure reaches a value: the interval of a parameter is halved until it is short.

use super::statistics::EnsembleMean;
use super::{FieldValue, SweepParameter, SweepStudy};
use serde::{Deserialize, Serialize};

/// `[target]`
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepTarget {
    /// Name of the measure.
    pub measure: String,
    /// The value that it is to reach, in the unit of the measure.
    pub value: f64,
    /// The search ends when the interval is this part of the range; of a range with log spacing, of its logarithm.
    #[serde(default = "tolerance")]
    pub tolerance: f64,
}

fn tolerance() -> f64 {
    0.01
}

impl SweepTarget {
    /// A measure and its value, with the usual tolerance.
    pub fn new(measure: &str, value: f64) -> SweepTarget {
        SweepTarget {
            measure: measure.to_owned(),
            value,
            tolerance: tolerance(),
        }
    }

    pub(super) fn check(&self, study: &SweepStudy) -> Result<(), String> {
        if !study.measures.contains_key(&self.measure) {
            let known = study.measures.keys().map(String::as_str);
            let hint = looselink::document::did_you_mean(&self.measure, known);
            return Err(format!(
                "`target` names an unknown measure `{}`{hint}",
                self.measure
            ));
        }
        let [parameter] = study.parameter_list()[..] else {
            return Err("a bisection needs exactly one parameter".to_owned());
        };
        if parameter.range().is_none() {
            return Err("a bisection needs a parameter with `from` and `to`".to_owned());
        }
        if !(self.value.is_finite() && self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err("`target` needs a finite `value` and a `tolerance` between 0 and 1".into());
        }
        Ok(())
    }
}

/// A point of a bisection: its place in the range, and the mean of the measure there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visited {
    /// 0 at the start of the range, 1 at its end.
    pub place: f64,
    /// Mean over the starts and its interval.
    pub mean: EnsembleMean,
}

/// What comes next in a bisection.
#[derive(Debug, Clone, PartialEq)]
pub enum Search {
    /// The measure at this place of the range.
    Visit(f64),
    /// The measure reaches the value between these places; the first is on the side of the start of the range.
    Found([Visited; 2]),
    /// The measure is on one side of the value at both ends of the range.
    NoCrossing([Visited; 2]),
    /// The measure has no value at this place, because a run there has failed.
    NoValue(f64),
}

/// The places of a bisection one after the other. `at` gives the mean at a point that was visited: none for a point that was not,
/// and none inside for one whose runs have failed.
pub fn search(
    target: &SweepTarget,
    at: impl Fn(usize) -> Option<Option<EnsembleMean>>,
) -> (Search, Vec<f64>) {
    let mut places = Vec::new();
    let mut visit = |place: f64| {
        places.push(place);
        match at(places.len() - 1) {
            None => Err(Search::Visit(place)),
            Some(None) => Err(Search::NoValue(place)),
            Some(Some(mean)) => Ok(Visited { place, mean }),
        }
    };
    let below = |visited: &Visited| visited.mean.mean < target.value;
    let mut halve = || {
        let mut ends = [visit(0.0)?, visit(1.0)?];
        if below(&ends[0]) == below(&ends[1]) {
            return Err(Search::NoCrossing(ends));
        }
        while ends[1].place - ends[0].place > target.tolerance {
            let middle = visit(0.5 * (ends[0].place + ends[1].place))?;
            let replaced = usize::from(below(&middle) != below(&ends[0]));
            ends[replaced] = middle;
        }
        Ok(ends)
    };
    let found = halve().map_or_else(|search| search, Search::Found);
    (found, places)
}

/// What a bisection has found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Crossing {
    /// Name of the parameter.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// The measure and the value that it reaches.
    pub target: SweepTarget,
    /// Between these values of the parameter; there
    pub between: [FieldValue; 2],
    /// the measure has these means,
    pub means: [f64; 2],
    /// which are known to so much (half of the 95 % interval); absent with a single start.
    pub half_widths: [Option<f64>; 2],
    /// False where the means at the points that were visited rise and fall by more than their intervals.
    pub monotone: bool,
}

impl Crossing {
    /// In the words of a study with one parameter.
    pub(super) fn new(
        study: &SweepStudy,
        target: &SweepTarget,
        ends: [Visited; 2],
        visited: &[Visited],
    ) -> Crossing {
        let (name, parameter): (&String, &SweepParameter) = study
            .parameters
            .first()
            .expect("a bisection has one parameter");
        Crossing {
            parameter: name.clone(),
            unit: parameter.unit.clone(),
            target: target.clone(),
            between: ends.map(|end| parameter.at(end.place)),
            means: ends.map(|end| end.mean.mean),
            half_widths: ends.map(|end| end.mean.half_width),
            monotone: is_monotone(visited),
        }
    }

    /// True where the intervals of both means lie on their sides of the value.
    pub fn is_certain(&self) -> bool {
        let mut sides = self.means.iter().zip(&self.half_widths);
        sides.all(|(mean, half)| (mean - self.target.value).abs() > half.unwrap_or(0.0))
    }
}

/// True where the means rise or fall all the way from the start of the range to its end, as far as their intervals tell.
fn is_monotone(visited: &[Visited]) -> bool {
    let mut sorted = visited.to_vec();
    sorted.sort_by(|a, b| a.place.total_cmp(&b.place));
    let steps = sorted.windows(2).map(|pair| {
        let [(low, a), (high, b)] = [pair[0], pair[1]].map(|v| (v.mean.interval(), v.mean.mean));
        // the sign of a change that is longer than both intervals together
        match b - a {
            change if change > 0.0 && high.0 > low.1 => 1,
            change if change < 0.0 && high.1 < low.0 => -1,
            _ => 0,
        }
    });
    let steps: Vec<i32> = steps.collect();
    !(steps.contains(&1) && steps.contains(&-1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_that_rise_and_fall_are_not_monotone() {
        let visited = |means: &[f64]| -> Vec<Visited> {
            let count = means.len() as f64;
            let places = (0..means.len()).map(|k| k as f64 / count);
            let of = |(place, mean): (f64, &f64)| Visited {
                place,
                mean: EnsembleMean::of(&[*mean]).unwrap(),
            };
            places.zip(means).map(of).rev().collect()
        };
        assert!(is_monotone(&visited(&[1.0, 2.0, 2.0, 5.0])));
        assert!(is_monotone(&visited(&[3.0, 1.0])));
        assert!(!is_monotone(&visited(&[1.0, 3.0, 2.0, 5.0])));
        // within their intervals
        let noisy = |place, values: &[f64]| Visited {
            place,
            mean: EnsembleMean::of(values).unwrap(),
        };
        let points = [
            noisy(0.0, &[1.0, 1.1]),
            noisy(0.5, &[2.0, 3.0]),
            noisy(1.0, &[2.2, 2.4]),
        ];
        assert!(is_monotone(&points));
    }

    fn target() -> SweepTarget {
        SweepTarget {
            measure: "m".into(),
            value: 0.3,
            tolerance: 0.01,
        }
    }

    /// Runs a search to its end; the measure at u is `f(u)`.
    fn run(f: impl Fn(f64) -> Option<f64>) -> (Search, usize) {
        let mut means: Vec<Option<EnsembleMean>> = Vec::new();
        loop {
            let (next, places) = search(&target(), |point| means.get(point).copied());
            match next {
                Search::Visit(u) => means.push(f(u).and_then(|x| EnsembleMean::of(&[x]))),
                end => return (end, places.len()),
            }
        }
    }

    #[test]
    fn a_crossing_is_enclosed_in_either_direction() {
        for f in [(|u| u * u) as fn(f64) -> f64, |u| 0.6 - u] {
            let (end, visited) = run(|u| Some(f(u)));
            let Search::Found([a, b]) = end else {
                panic!("{end:?}")
            };
            // 2^-7 is the first power below 0.01
            assert_eq!((b.place - a.place, visited), (0.5_f64.powi(7), 9));
            assert!((f(a.place) < 0.3) != (f(b.place) < 0.3));
        }
    }

    #[test]
    fn a_search_says_why_it_ends() {
        assert!(matches!(run(|u| Some(u + 1.0)).0, Search::NoCrossing(_)));
        let fails = |u: f64| (u != 0.5).then_some(u);
        assert_eq!(run(fails).0, Search::NoValue(0.5));
    }
}
