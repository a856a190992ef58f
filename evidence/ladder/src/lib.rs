//! The verification ladder: tests ask questions, answer each with a number, and say what is allowed and why.
//!
//! ```no_run
//! use ladder::Rung;
//! Rung::Identities.asks("is the sum of two halves one?").within(0.5 + 0.5 - 1.0, 0.0, "halves are exact");
//! ```
//!
//! An answer that is not allowed panics, as any assertion does. When the environment variable [`FOLDER`] names a folder
//! every answer is also written there.

pub mod answer;
mod worst;

pub use answer::{Allowed, Answer, ErrorCurve};
pub use worst::{MeasuredError, Worst};

use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::panic::Location;

/// Environment variable with the folder that answers are written to.
pub const FOLDER: &str = "LOOSELINK_LADDER";

/// A rung of the ladder: each trusts those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Rung {
    /// What holds whatever the numbers are: symmetry, invariance, sums.
    Identities,
    /// Hand-written derivatives against differences.
    Derivatives,
    /// The same quantity by another way.
    Routes,
    /// Error against the time step.
    OrderInTime,
    /// Error against the number of elements.
    OrderInElements,
    /// Energy and momentum.
    Balance,
    /// Against the second implementation.
    Codes,
    /// Against closed forms.
    ClosedForms,
    /// Against digits that were computed once by another way.
    Computed,
    /// Against digits in a source that anyone can open, which the row names.
    Published,
    /// What is known to be difficult.
    HardCases,
}

impl Rung {
    /// Begins a row. A question is asked once.
    #[track_caller]
    pub fn asks(self, question: impl Into<String>) -> Question {
        Question {
            rung: self,
            text: question.into(),
            source: None,
            place: Location::caller(),
        }
    }
}

/// A question on its way to an answer.
#[derive(Debug)]
pub struct Question {
    rung: Rung,
    text: String,
    source: Option<String>,
    place: &'static Location<'static>,
}

impl Question {
    /// Names the source of published digits, with its address.
    pub fn from(mut self, source: &str) -> Question {
        self.source = Some(source.to_owned());
        self
    }

    /// Answers with an error: its magnitude is at most `tolerance`.
    ///
    /// # Panics
    /// When it is not.
    pub fn within(self, error: impl MeasuredError, tolerance: f64, reason: &str) {
        let (error, place) = error.error();
        let allowed = Allowed::AtMost(tolerance);
        self.answer(error.abs(), &place, allowed, reason, None);
    }

    /// Answers with a number between two others.
    ///
    /// # Panics
    /// When it is not.
    pub fn between(self, value: f64, bounds: Range<f64>, reason: &str) {
        let allowed = Allowed::Between(bounds.start, bounds.end);
        self.answer(value, "", allowed, reason, None);
    }

    /// Answers with errors that fall, from each abscissa to the next, with an order within the bounds. The number of the
    /// row is the order that is farthest from the middle of the bounds.
    ///
    /// Abscissae are those of an error that vanishes with them: steps, lengths of elements.
    ///
    /// # Panics
    /// When one of the orders is outside the bounds.
    pub fn falls(self, abscissa: &str, errors: &[(f64, f64)], orders: Range<f64>, reason: &str) {
        assert!(errors.len() > 1, "{}: one error has no order", self.text);
        let middle = 0.5 * (orders.start + orders.end);
        let far = |order: &f64| (order - middle).abs();
        let pairwise = errors.windows(2).map(|pair| {
            let [(h, e), (next_h, next_e)] = [pair[0], pair[1]];
            (e / next_e).ln() / (h / next_h).ln()
        });
        // an order that is not a number is worse than any
        let worst = pairwise.max_by(|a, b| far(a).total_cmp(&far(b)));
        self.order(worst.unwrap_or(f64::NAN), abscissa, errors, orders, reason);
    }

    /// The same for errors that scatter, because events cut the steps at other places: the order is the slope of the
    /// least-squares line through (log abscissa, log error).
    ///
    /// # Panics
    /// When the order is outside the bounds.
    pub fn falls_on_average(
        self,
        abscissa: &str,
        errors: &[(f64, f64)],
        orders: Range<f64>,
        reason: &str,
    ) {
        let logs: Vec<(f64, f64)> = errors.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
        let n = logs.len() as f64;
        let (x, y) = logs
            .iter()
            .fold((0.0, 0.0), |(x, y), l| (x + l.0 / n, y + l.1 / n));
        let (up, down) = logs.iter().fold((0.0, 0.0), |(u, d), l| {
            (u + (l.0 - x) * (l.1 - y), d + (l.0 - x).powi(2))
        });
        self.order(up / down, abscissa, errors, orders, reason);
    }

    fn order(
        self,
        order: f64,
        abscissa: &str,
        errors: &[(f64, f64)],
        orders: Range<f64>,
        reason: &str,
    ) {
        let curve = ErrorCurve {
            abscissa: abscissa.into(),
            errors: errors.to_vec(),
        };
        let allowed = Allowed::Between(orders.start, orders.end);
        self.answer(order, "", allowed, reason, Some(curve));
    }

    fn answer(
        self,
        number: f64,
        place: &str,
        allowed: Allowed,
        reason: &str,
        curve: Option<ErrorCurve>,
    ) {
        let is_open = |source: &String| source.contains("https://");
        assert_eq!(
            self.rung == Rung::Published,
            self.source.as_ref().is_some_and(is_open),
            "{}: published digits, and they alone, have a source with an address",
            self.text
        );
        let answer = Answer {
            rung: self.rung,
            source: self.source,
            question: self.text,
            number,
            allowed,
            reason: reason.into(),
            file: self.place.file().replace('\\', "/"),
            line: self.place.line(),
            curve,
        };
        // what this crate asks to test itself is no evidence
        if let Some(folder) = std::env::var_os(FOLDER).filter(|_| !cfg!(test)) {
            let written = answer.write(folder.as_ref());
            written.unwrap_or_else(|e| panic!("{e:?}"));
        }
        let errors = answer.curve.as_ref().map(|curve| &curve.errors);
        assert!(
            answer.holds(),
            "{}\n  {number} {place} is not {allowed}: {reason}\n  errors {errors:?}",
            answer.question,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::Rung;
    use std::panic::catch_unwind;

    #[test]
    fn errors_at_most_the_tolerance_pass() {
        Rung::Identities.asks("passes?").within(-1.0, 1.0, "equal");
        for error in [1.5, f64::NAN] {
            let ask = move || Rung::Identities.asks("fails?").within(error, 1.0, "more");
            assert!(catch_unwind(ask).is_err(), "{error}");
        }
    }

    #[test]
    fn published_digits_name_a_source_that_opens() {
        let ask = |rung: Rung, source: Option<&'static str>| {
            catch_unwind(move || {
                let question = rung.asks("open?");
                let question = match source {
                    Some(source) => question.from(source),
                    None => question,
                };
                question.within(0.0, 0.0, "equal");
            })
        };
        let open = Some("a test set, https://example.org/digits");
        assert!(ask(Rung::Published, open).is_ok());
        assert!(ask(Rung::Published, None).is_err());
        assert!(ask(Rung::Published, Some("a talk")).is_err());
        assert!(ask(Rung::Computed, open).is_err());
    }

    #[test]
    fn orders_are_bounded_on_both_sides() {
        let errors = |order: f64| [0.4_f64, 0.2, 0.1].map(|h| (h, 3.0 * h.powf(order)));
        let ask = || Rung::OrderInTime.asks("2?");
        ask().falls("h", &errors(2.0), 1.9..2.1, "");
        ask().falls_on_average("h", &errors(2.0), 1.9..2.1, "");
        for order in [1.8, 2.2, f64::NAN] {
            let pairs = || ask().falls("h", &errors(order), 1.9..2.1, "");
            let line = || ask().falls_on_average("h", &errors(order), 1.9..2.1, "");
            assert!(catch_unwind(pairs).is_err() && catch_unwind(line).is_err());
        }
        // one pair of three with another order
        let bent = [(0.4, 0.16), (0.2, 0.04), (0.1, 0.03)];
        let ask = || ask().falls("h", &bent, 1.9..2.1, "");
        assert!(catch_unwind(ask).is_err());
    }
}
