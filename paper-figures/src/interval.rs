//! Means of ensembles with their 95 % intervals, and what they decide.

/// Starts of every ensemble.
pub const STARTS: usize = 16;
/// Starts of three ensembles together.
pub const OF_THREE: usize = 3 * STARTS;
/// 97.5 % quantile of Student's t distribution with [`OF_THREE`] - 1 degrees of freedom.
const STUDENT_OF_THREE: f64 = 2.011_740_514;
/// The same with [`STARTS`] - 1 degrees of freedom.
const STUDENT: f64 = 2.131_449_546;
/// The same with 2 [`STARTS`] - 2 degrees of freedom, for the difference of two means.
const STUDENT_OF_TWO: f64 = 2.042_272_456;

/// How a criterion comes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CriterionVerdict {
    /// Met.
    Holds,
    /// Missed.
    Fails,
    /// The interval straddles the limit.
    Undecided,
}

impl CriterionVerdict {
    /// Of a quantity that is known.
    pub fn of(holds: bool) -> CriterionVerdict {
        if holds {
            CriterionVerdict::Holds
        } else {
            CriterionVerdict::Fails
        }
    }

    /// Both are met; one missed is enough to miss.
    pub fn and(self, other: CriterionVerdict) -> CriterionVerdict {
        match (self, other) {
            (CriterionVerdict::Fails, _) | (_, CriterionVerdict::Fails) => CriterionVerdict::Fails,
            (CriterionVerdict::Holds, CriterionVerdict::Holds) => CriterionVerdict::Holds,
            _ => CriterionVerdict::Undecided,
        }
    }

    /// The opposite.
    pub fn not(self) -> CriterionVerdict {
        match self {
            CriterionVerdict::Holds => CriterionVerdict::Fails,
            CriterionVerdict::Fails => CriterionVerdict::Holds,
            CriterionVerdict::Undecided => CriterionVerdict::Undecided,
        }
    }

    /// One is met at least.
    pub fn or(self, other: CriterionVerdict) -> CriterionVerdict {
        match (self, other) {
            (CriterionVerdict::Holds, _) | (_, CriterionVerdict::Holds) => CriterionVerdict::Holds,
            (CriterionVerdict::Fails, CriterionVerdict::Fails) => CriterionVerdict::Fails,
            _ => CriterionVerdict::Undecided,
        }
    }
}

/// A mean and the half width of its 95 % interval, from independent values.
#[derive(Debug, Clone, Copy)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// Student's half width.
    pub half: f64,
}

impl Interval {
    /// Of one value a start, of one ensemble or of three together.
    ///
    /// # Panics
    /// When there are not that many values.
    pub fn of(values: &[f64]) -> Interval {
        let student = match values.len() {
            STARTS => STUDENT,
            OF_THREE => STUDENT_OF_THREE,
            n => panic!("an ensemble of {n} runs is incomplete"),
        };
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let half = student * (squares / (n - 1.0) / n).sqrt();
        Interval { mean, half }
    }

    /// Whether the mean lies between two limits.
    pub fn within(&self, low: f64, high: f64) -> CriterionVerdict {
        let (least, largest) = (self.mean - self.half, self.mean + self.half);
        if least >= low && largest <= high {
            CriterionVerdict::Holds
        } else if largest < low || least > high {
            CriterionVerdict::Fails
        } else {
            CriterionVerdict::Undecided
        }
    }

    /// Whether the mean lies above a limit.
    pub fn above(&self, limit: f64) -> CriterionVerdict {
        self.within(limit, f64::INFINITY)
    }

    /// Whether the mean lies below a limit.
    pub fn below(&self, limit: f64) -> CriterionVerdict {
        self.within(f64::NEG_INFINITY, limit)
    }

    /// The difference of two means of [`STARTS`] values each, over its standard error.
    pub fn apart(&self, other: &Interval) -> f64 {
        let error = self.half.hypot(other.half) / STUDENT;
        (self.mean - other.mean).abs() / error
    }

    /// By how much two single values, whose scatter is known from [`OF_THREE`], differ at the most with a probability of
    /// 95 %, over the mean. Student's t, as of normally distributed values.
    pub fn two_apart(&self) -> f64 {
        self.half * (2.0 * OF_THREE as f64).sqrt() / self.mean.abs()
    }

    /// Whether two means of [`STARTS`] values each differ at the 95 % level.
    pub fn differs(&self, other: &Interval) -> bool {
        self.apart(other) > STUDENT_OF_TWO
    }

    /// Mean and interval, each number written by `show`.
    pub fn reported(&self, show: impl Fn(f64) -> String) -> String {
        format!("{} ± {}", show(self.mean), show(self.half))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interval_of_an_arithmetic_sequence() {
        let values: Vec<f64> = (0..STARTS).map(|i| i as f64).collect();
        let interval = Interval::of(&values);
        // variance of 0..15: n (n + 1) / 12 = 22.667
        let half = 2.131_449_546 * (272.0 / 12.0 / 16.0_f64).sqrt();
        assert!((interval.mean - 7.5).abs() < 1e-12 && (interval.half - half).abs() < 1e-12);
        // limits on both sides of both ends
        let (low, high) = (7.5 - half, 7.5 + half);
        let (undecided, far) = (CriterionVerdict::Undecided, 1e3);
        for (part, holds, fails) in [
            (-0.01, CriterionVerdict::Holds, undecided),
            (0.01, undecided, CriterionVerdict::Fails),
        ] {
            let inward = part * half;
            assert_eq!(interval.within(low + inward, far), holds);
            assert_eq!(interval.above(low + inward), holds);
            assert_eq!(interval.within(-far, high - inward), holds);
            assert_eq!(interval.below(high - inward), holds);
            assert_eq!(interval.within(high + inward, far), fails);
            assert_eq!(interval.above(high + inward), fails);
            assert_eq!(interval.within(-far, low - inward), fails);
            assert_eq!(interval.below(low - inward), fails);
        }
    }

    #[test]
    fn single_values_differ_by_less_than_their_limit_with_95_percent() {
        // s^2 = n (n + 1) / 12 = 196, so t s sqrt(2) = 2.01174 * 14 * sqrt(2)
        let values: Vec<f64> = (0..OF_THREE).map(|i| i as f64).collect();
        let limit = Interval::of(&values).two_apart() * 23.5;
        assert!((limit - 2.011_740_514 * 14.0 * 2.0_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn means_differ_when_they_are_two_standard_errors_apart() {
        let at = |mean| Interval {
            mean,
            half: STUDENT,
        };
        // standard error of the difference: the square root of 2
        assert!(!at(0.0).differs(&at(2.8)));
        assert!(at(0.0).differs(&at(3.0)));
    }
}
