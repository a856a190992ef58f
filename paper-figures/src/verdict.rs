//! How a criterion comes out.

use minijinja::Value;
use serde::Serialize;
use statistics::Interval;

/// How a criterion comes out, the worst first: of several that have to be met, the least counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum CriterionVerdict {
    /// Missed.
    Fails,
    /// The interval straddles the limit.
    Undecided,
    /// Met.
    Holds,
}

use CriterionVerdict::{Fails, Holds, Undecided};

impl CriterionVerdict {
    /// The opposite.
    pub fn not(self) -> CriterionVerdict {
        match self {
            Holds => Fails,
            Fails => Holds,
            Undecided => Undecided,
        }
    }

    /// With no values for the templates but those that all of them have.
    pub fn alone(self) -> (CriterionVerdict, Value) {
        (self, Value::UNDEFINED)
    }
}

/// Of a quantity that is known.
pub fn holds(condition: bool) -> CriterionVerdict {
    if condition { Holds } else { Fails }
}

/// Whether a number lies between two others.
pub fn between(x: f64, low: f64, high: f64) -> CriterionVerdict {
    holds((low..=high).contains(&x))
}

/// All are met; one missed is enough to miss.
pub fn all(each: impl IntoIterator<Item = CriterionVerdict>) -> CriterionVerdict {
    each.into_iter().min().unwrap_or(Holds)
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
    all(means.iter().map(|m| within(m, limit, f64::INFINITY)))
}

/// Whether means lie below a limit, all of them.
pub fn below(means: &[Interval], limit: f64) -> CriterionVerdict {
    all(means.iter().map(|m| within(m, f64::NEG_INFINITY, limit)))
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
        assert_eq!(all([Holds, Undecided]), Undecided);
        assert_eq!(all([Fails, Undecided]), Fails);
    }
}
