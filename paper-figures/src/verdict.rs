//! How a criterion comes out.

use serde::Serialize;
use statistics::Interval;

/// How a criterion comes out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum CriterionVerdict {
    /// Met.
    Holds,
    /// Missed.
    Fails,
    /// The interval straddles the limit.
    Undecided,
}

use CriterionVerdict::{Fails, Holds, Undecided};

impl CriterionVerdict {
    /// Of a quantity that is known.
    pub fn of(holds: bool) -> CriterionVerdict {
        if holds { Holds } else { Fails }
    }

    /// All are met; one missed is enough to miss.
    pub fn all(each: impl IntoIterator<Item = CriterionVerdict>) -> CriterionVerdict {
        each.into_iter().fold(Holds, CriterionVerdict::and)
    }

    /// Both are met; one missed is enough to miss.
    pub fn and(self, other: CriterionVerdict) -> CriterionVerdict {
        match (self, other) {
            (Fails, _) | (_, Fails) => Fails,
            (Holds, Holds) => Holds,
            _ => Undecided,
        }
    }

    /// The opposite.
    pub fn not(self) -> CriterionVerdict {
        match self {
            Holds => Fails,
            Fails => Holds,
            Undecided => Undecided,
        }
    }
}

/// Whether a mean lies between two limits.
pub fn within(mean: &Interval, low: f64, high: f64) -> CriterionVerdict {
    let (least, largest) = (mean.mean - mean.half, mean.mean + mean.half);
    if least >= low && largest <= high {
        Holds
    } else if largest < low || least > high {
        Fails
    } else {
        Undecided
    }
}

/// Whether means lie above a limit, all of them.
pub fn above(means: &[Interval], limit: f64) -> CriterionVerdict {
    CriterionVerdict::all(means.iter().map(|m| within(m, limit, f64::INFINITY)))
}

/// Whether means lie below a limit, all of them.
pub fn below(means: &[Interval], limit: f64) -> CriterionVerdict {
    CriterionVerdict::all(means.iter().map(|m| within(m, f64::NEG_INFINITY, limit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_that_contains_the_limit_decides_nothing() {
        let mean = Interval {
            mean: 7.5,
            half: 2.5,
        };
        let above = |limit| above(&[mean], limit);
        assert_eq!(
            (above(8.0), above(5.0), above(10.1)),
            (Undecided, Holds, Fails)
        );
        assert_eq!(below(&[mean], 4.9), Fails);
        assert_eq!(within(&mean, 9.0, 20.0), Undecided);
        assert_eq!(within(&mean, 0.0, 20.0), Holds);
    }

    #[test]
    fn verdicts_are_joined_as_a_logic_with_an_unknown() {
        assert_eq!(
            [Holds.and(Undecided), Fails.and(Undecided)],
            [Undecided, Fails]
        );
        assert_eq!([Holds.not(), Undecided.not()], [Fails, Undecided]);
    }
}
