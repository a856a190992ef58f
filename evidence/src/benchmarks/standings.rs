//! How the fastest of our methods, and each alone, stands against another code. Only runs that were made count.

use crate::benchmarks::rivals::{Code, RivalCurve, STUDIES, best, is_known};
use studies::machine::median;
use studies::precision::Times;

/// Errors at which codes are compared \[m\].
pub const LEVELS: [f64; 7] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];

/// A method of ours, or the fastest one of each study and error, against the fastest method of another code.
#[derive(Debug)]
pub struct Standing {
    /// Where both reach the error.
    pub ratios: Vec<TimeRatio>,
    /// Errors in studies that have this method, which only one of both reaches: ours, the other. Errors that the converged solution of
    /// one cannot tell are left out.
    pub reached_alone: [usize; 2],
}

/// Times of two codes for an error.
#[derive(Debug, PartialEq)]
pub struct TimeRatio {
    /// Study.
    pub study: String,
    /// Error of position \[m\].
    pub error: f64,
    /// Time of the other code over that of our method.
    pub ratio: f64,
}

impl Standing {
    /// Against this code, of a method in all studies that have it.
    pub fn new(curves: &[RivalCurve], rival: Code, method: Option<&str>) -> Standing {
        let is_own = |c: &&RivalCurve| {
            c.code == Code::Looselink && method.is_none_or(|method| c.method == method)
        };
        let own: Vec<RivalCurve> = curves.iter().filter(is_own).cloned().collect();
        let mut standing = Standing {
            ratios: Vec::new(),
            reached_alone: [0; 2],
        };
        let studies = STUDIES.into_iter();
        for study in studies.filter(|study| own.iter().any(|c| c.study == *study)) {
            let known = |&error: &f64| {
                let mut both = [Code::Looselink, rival].into_iter();
                both.all(|code| is_known(curves, study, code, error))
            };
            for error in LEVELS.into_iter().filter(known) {
                let of = |curves: &[RivalCurve], code| {
                    Some(best(curves, study, code, error, Times::Measured)?.1)
                };
                match (of(&own, Code::Looselink), of(curves, rival)) {
                    (Some(own), Some(other)) => standing.ratios.push(TimeRatio {
                        study: study.to_owned(),
                        error,
                        ratio: other / own,
                    }),
                    (Some(_), None) => standing.reached_alone[0] += 1,
                    (None, Some(_)) => standing.reached_alone[1] += 1,
                    (None, None) => {}
                }
            }
        }
        standing
    }

    /// Median and least ratio, where there are any.
    pub fn summary(&self) -> Option<[f64; 2]> {
        let ratios: Vec<f64> = self.ratios.iter().map(|r| r.ratio).collect();
        let least = ratios.iter().copied().reduce(f64::min)?;
        Some([median(&ratios), least])
    }
}

#[cfg(test)]
mod tests {
    use super::{Standing, TimeRatio};
    use crate::benchmarks::rivals::{Code, RivalCurve};

    fn curve(study: &str, code: Code, method: &str, points: &[[f64; 2]]) -> RivalCurve {
        RivalCurve {
            study: study.to_owned(),
            code,
            method: method.to_owned(),
            settings: None,
            points: points.to_vec(),
            floor: 3e-9,
        }
    }

    fn curves() -> Vec<RivalCurve> {
        vec![
            curve("case2", Code::Looselink, "a", &[[1e-6, 1.0], [1e-7, 4.0]]),
            curve("case2", Code::Looselink, "b", &[[1e-7, 2.0], [1e-8, 5.0]]),
            curve("case3", Code::Looselink, "b", &[[1e-6, 3.0]]),
            // 1e-7 lies between two runs: the time is that of the second
            curve("case2", Code::Exudyn, "c", &[[1e-6, 6.0], [5e-8, 8.0]]),
            // below its floor
            curve("case2", Code::Exudyn, "d", &[[1e-9, 0.1]]),
            curve("case3", Code::Exudyn, "c", &[[1e-6, 1.5], [1e-8, 9.0]]),
        ]
    }

    fn standing(method: Option<&str>) -> Standing {
        Standing::new(&curves(), Code::Exudyn, method)
    }

    fn ratio(study: &str, error: f64, ratio: f64) -> TimeRatio {
        TimeRatio {
            study: study.to_owned(),
            error,
            ratio,
        }
    }

    #[test]
    fn ratios_are_of_runs_that_were_made() {
        // "d" takes 0.1 s wherever its error counts
        let own = standing(Some("a"));
        let expected = [ratio("case2", 1e-6, 0.1), ratio("case2", 1e-7, 0.1 / 4.0)];
        assert_eq!(own.ratios, expected);
        // the other code reaches 1e-8 too; study case3 does not have the method
        assert_eq!(own.reached_alone, [0, 1]);
        assert_eq!(own.summary(), Some([0.5 * (0.1 + 0.1 / 4.0), 0.1 / 4.0]));
        let mut without = curves();
        without.remove(4);
        let own = Standing::new(&without, Code::Exudyn, Some("a"));
        let expected = [ratio("case2", 1e-6, 6.0), ratio("case2", 1e-7, 8.0 / 4.0)];
        assert_eq!(own.ratios, expected);
    }

    #[test]
    fn the_fastest_method_is_that_of_each_pair() {
        let fastest = standing(None);
        let expected = [
            ratio("case2", 1e-6, 0.1),
            ratio("case2", 1e-7, 0.1 / 2.0),
            ratio("case2", 1e-8, 0.1 / 5.0),
            ratio("case3", 1e-6, 0.5),
        ];
        assert_eq!(fastest.ratios, expected);
        assert_eq!(fastest.reached_alone, [0, 2]);
        let alone = standing(Some("b"));
        assert_eq!(alone.summary().unwrap()[1], 0.1 / 5.0);
        assert_eq!(alone.ratios[0], ratio("case2", 1e-6, 0.1 / 2.0));
    }

    #[test]
    fn methods_without_a_common_error_have_no_summary() {
        let mut curves = curves();
        curves.retain(|c| c.code == Code::Looselink);
        // its solution is known in one of the studies, above its floor
        curves.push(curve("case2", Code::IdaOnOurs, "e", &[]));
        let fastest = Standing::new(&curves, Code::IdaOnOurs, None);
        assert!(fastest.summary().is_none());
        assert_eq!(fastest.reached_alone, [3, 0]);
    }
}
