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
    /// All rungs from the lowest up.
    pub const ALL: [Rung; 11] = [
        Rung::Identities,
        Rung::Derivatives,
        Rung::Routes,
        Rung::OrderInTime,
        Rung::OrderInElements,
        Rung::Balance,
        Rung::Codes,
        Rung::ClosedForms,
        Rung::Computed,
        Rung::Published,
        Rung::HardCases,
    ];

    /// Title and what the rung asks.
    pub fn title(self) -> (&'static str, &'static str) {
        match self {
            Rung::Identities => (
                "Identities",
                "Properties that hold for all inputs, tested on random ones.",
            ),
            Rung::Derivatives => (
                "Derivatives",
                "Do derivatives agree with central differences, whose error is of order 2 in the span? A lower order means a \
                 wrong derivative; a higher order, a test that does not see it.",
            ),
            Rung::Routes => (
                "Routes",
                "Do two independent ways to compute a quantity agree?",
            ),
            Rung::OrderInTime => (
                "Order in time",
                "Does the error fall with the order of the scheme? Orders are bounded from below and above.",
            ),
            Rung::OrderInElements => (
                "Order in elements",
                "Does the error fall with the order of the element?",
            ),
            Rung::Balance => ("Balance", "Do energy and momentum balance?"),
            Rung::Codes => (
                "Code to code",
                "Does the independent C++ implementation agree? [verify/REPORT.md](verify/REPORT.md) has every row; listed here \
                 is the row of each comparison that is closest to its tolerance.",
            ),
            Rung::ClosedForms => (
                "Closed forms",
                "Do results agree with formulas that follow on paper?",
            ),
            Rung::Computed => (
                "Computed digits",
                "Do results agree with digits that were computed once by another way: quadrature, collocation, extrapolation, \
                 arithmetic with more digits? Nobody else published them.",
            ),
            Rung::Published => (
                "Published digits",
                "Do results agree with digits in a source that anyone can open?",
            ),
            Rung::HardCases => (
                "Hard cases",
                "Are results right in cases known to be difficult?",
            ),
        }
    }

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
        let number = error.error().abs();
        self.answer(
            number,
            &error.place(),
            Allowed::AtMost(tolerance),
            reason,
            None,
        );
    }

    /// Answers with a number between two others.
    ///
    /// # Panics
    /// When it is not.
    pub fn between(self, value: f64, bounds: Range<f64>, reason: &str) {
        self.answer(
            value,
            "",
            Allowed::Between(bounds.start, bounds.end),
            reason,
            None,
        );
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
        self.answer(
            order,
            "",
            Allowed::Between(orders.start, orders.end),
            reason,
            Some(curve),
        );
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
            answer
                .write(folder.as_ref())
                .unwrap_or_else(|e| panic!("{e}"));
        }
        assert!(
            answer.holds(),
            "{}\n  {} {place} is not {}: {}{}",
            answer.question,
            answer.number,
            answer.allowed,
            answer.reason,
            answer
                .curve
                .map_or(String::new(), |c| format!("\n  errors {:?}", c.errors))
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
        Rung::OrderInTime
            .asks("2?")
            .falls("h", &errors(2.0), 1.9..2.1, "");
        Rung::OrderInTime
            .asks("2 on average?")
            .falls_on_average("h", &errors(2.0), 1.9..2.1, "");
        for order in [1.8, 2.2, f64::NAN] {
            let pairs = move || {
                Rung::OrderInTime
                    .asks("no?")
                    .falls("h", &errors(order), 1.9..2.1, "");
            };
            let line = move || {
                Rung::OrderInTime
                    .asks("no?")
                    .falls_on_average("h", &errors(order), 1.9..2.1, "");
            };
            assert!(
                catch_unwind(pairs).is_err() && catch_unwind(line).is_err(),
                "{order}"
            );
        }
        // one pair of three with another order
        let bent = [(0.4, 0.16), (0.2, 0.04), (0.1, 0.03)];
        let ask = move || {
            Rung::OrderInTime
                .asks("bent?")
                .falls("h", &bent, 1.9..2.1, "")
        };
        assert!(catch_unwind(ask).is_err());
    }
}
