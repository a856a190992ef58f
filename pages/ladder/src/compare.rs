//! The rows of a page against the answers of a run.
//!
//! | row | its number may differ from that of the page by |
//! |---|---|
//! | at most a bound | a twentieth of the larger one |
//! | the same, and it scatters | a factor of ten, of random mechanisms a thousand; from zero, by a hundredth of the bound |
//! | between two bounds | a twentieth of the distance between the bounds |
//! | the same, and it scatters | a quarter of that distance |
//!
//! and by the rounding of print. A test that computes the same in the same order repeats its number to all digits on one
//! machine; a twentieth leaves room for another compiler and processor, and sees every change of an error or an order that
//! a reader would see. A number scatters when the reason of its bound names rounding, random draws, chaos or scatter, or
//! when it is below 1e-9: rounding, which differs between machines, is part of any number that small. The largest of a
//! few hundred random roundings varies from draw to draw, by up to 2.4 in four runs of the tests, and a machine that fuses
//! products and sums brings a factor of its own; ten is beyond both. The error of a random mechanism goes with a power of what
//! was drawn: the largest of a few of them differed by 22 in two runs. A reason that names random mechanisms allows a thousand.

use crate::answer::short;
use crate::{Allowed, Answer, Rung};

/// Words of reasons of numbers that scatter.
const SCATTER: [&str; 5] = ["round", "random", "drawn", "chao", "scatter"];
/// Below this rounding is part of a number.
const SMALL: f64 = 1e-9;
/// Part of a number, or of the distance between its bounds, by which it may differ.
const PART: f64 = 0.05;
/// The same of a distance, for a number that scatters.
const SCATTERED_PART: f64 = 0.25;
/// Factor by which a number that scatters may differ.
const FACTOR: f64 = 10.0;
/// Word of the reason of a number that depends on a power of what is drawn, and its factor.
const MECHANISMS: (&str, f64) = ("random mechanisms", 1e3);
/// Part of its bound that a number which scatters may be where the other is zero.
const OF_ZERO: f64 = 0.01;

/// A row as it is printed.
struct Printed<'p> {
    holds: bool,
    question: &'p str,
    number: &'p str,
    allowed: &'p str,
    reason: &'p str,
    test: &'p str,
}

impl<'p> Printed<'p> {
    /// The row in this line of the page.
    fn read(line: &'p str) -> Option<Printed<'p>> {
        let cells: Vec<&str> = line
            .strip_prefix("| ")?
            .strip_suffix(" |")?
            .split(" | ")
            .collect();
        let [
            verdict @ ("✓" | "✗"),
            question,
            number,
            allowed,
            reason,
            test,
        ] = cells[..]
        else {
            return None;
        };
        Some(Printed {
            holds: verdict == "✓",
            question,
            number,
            allowed,
            reason,
            test,
        })
    }

    /// How the row differs from an answer.
    fn differs(&self, answer: &Answer) -> Option<String> {
        let difference = |what: &str, now: &str, page: &str| {
            (now != page).then(|| format!("{what} {now}, on the page {page}"))
        };
        if !self.holds {
            return Some("on the page it does not hold".to_owned());
        }
        // of several agreements another may come nearest to its bound: then their shares of it are compared
        if answer.rung == Rung::Codes && self.reason != cell(&answer.reason) {
            let bound = self.allowed.trim_start_matches("≤ ").parse().ok();
            let share = number(self.number)
                .zip(bound)
                .map(|(n, b): (f64, f64)| n / b);
            let agree = share.is_some_and(|share| within(FACTOR, share, answer.used(), 1.0));
            return (!agree).then(|| {
                let now = short(answer.used());
                let page = share.map_or("nothing".to_owned(), short);
                format!("the agreement nearest to its bound uses {now} of it, on the page {page}")
            });
        }
        difference("is allowed", &answer.allowed.to_string(), self.allowed)
            .or_else(|| difference("the reason is", &cell(&answer.reason), self.reason))
            .or_else(|| difference("the test is", &link(answer), self.test))
            .or_else(|| {
                let same = number(self.number).is_some_and(|printed| agree(answer, printed));
                (!same).then(|| format!("is {}, on the page {}", short(answer.number), self.number))
            })
    }
}

/// How the page differs from the answers: rows it lacks, rows that no test asks, rows with another bound, reason or number.
pub fn stale(page: &str, answers: &[Answer]) -> Vec<String> {
    let rows: Vec<Printed> = page.lines().filter_map(Printed::read).collect();
    let mut found = Vec::new();
    for answer in answers {
        let question = cell(&answer.question);
        match rows.iter().find(|row| row.question == question) {
            None => found.push(format!("not on the page: {question}")),
            Some(row) => {
                let difference = row.differs(answer);
                found.extend(difference.map(|d| format!("{question}: {d}")));
            }
        }
    }
    let asked: Vec<String> = answers.iter().map(|a| cell(&a.question)).collect();
    for row in &rows {
        if !asked.iter().any(|question| question == row.question) {
            found.push(format!(
                "on the page, but asked by no test: {}",
                row.question
            ));
        }
    }
    found
}

/// Text in a cell of a table.
pub fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// Link to the test of an answer.
pub fn link(answer: &Answer) -> String {
    let name = answer.file.rsplit('/').next().unwrap_or(&answer.file);
    format!("[{name}]({})", answer.file)
}

fn number(text: &str) -> Option<f64> {
    text.parse().ok()
}

/// True when the number of this run is that of the page, as the table above says.
fn agree(answer: &Answer, printed: f64) -> bool {
    let number = answer.number;
    let reason = answer.reason.to_lowercase();
    let scatters =
        SCATTER.iter().any(|word| reason.contains(word)) || number.abs().max(printed.abs()) < SMALL;
    let allowed = match answer.allowed {
        Allowed::AtMost(bound) if scatters => {
            let of_mechanisms = reason.contains(MECHANISMS.0).then_some(MECHANISMS.1);
            return within(of_mechanisms.unwrap_or(FACTOR), printed, number, bound);
        }
        Allowed::AtMost(_) => PART * number.abs().max(printed.abs()),
        Allowed::Between(low, high) if scatters => SCATTERED_PART * (high - low),
        Allowed::Between(low, high) => PART * (high - low),
    };
    (number - printed).abs() <= allowed + rounding(printed)
}

fn within(factor: f64, a: f64, b: f64, bound: f64) -> bool {
    let (least, most) = (a.min(b), a.max(b));
    match least == 0.0 {
        true => most <= OF_ZERO * bound,
        // a little more for the rounding of print
        false => most <= (1.0 + PART) * factor * least,
    }
}

/// The most by which [`short`] rounds a number: half a unit of its last digit.
fn rounding(number: f64) -> f64 {
    if number == 0.0 {
        return 0.0;
    }
    let digits = if (1e-2..1e4).contains(&number.abs()) {
        3
    } else {
        2
    };
    let first = number.abs().log10().floor() as i32;
    0.5 * 10f64.powi(first + 1 - digits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(number: f64, allowed: Allowed, reason: &str) -> Answer {
        Answer {
            rung: Rung::Routes,
            question: "|a| = b?".into(),
            number,
            allowed,
            reason: reason.into(),
            file: "tests/link.rs".into(),
            line: 1,
            curve: None,
        }
    }

    fn line(a: &Answer) -> String {
        let verdict = if a.holds() { "✓" } else { "✗" };
        format!(
            "| {verdict} | {} | {} | {} | {} | {} |",
            cell(&a.question),
            short(a.number),
            a.allowed,
            cell(&a.reason),
            link(a)
        )
    }

    /// True when a page printed from the first is one of the second.
    fn stands(page: &Answer, now: &Answer) -> bool {
        stale(&line(page), std::slice::from_ref(now)).is_empty()
    }

    #[test]
    fn numbers_that_repeat_are_those_of_the_page_within_a_twentieth() {
        let error = |x| answer(x, Allowed::AtMost(1e-3), "the scheme's error");
        for (now, same) in [
            (2e-4, true),
            (2.04e-4, true),
            (1.9e-4, true),
            (2.4e-4, false),
            (1.6e-4, false),
        ] {
            assert_eq!(stands(&error(2e-4), &error(now)), same, "{now}");
        }
        // print rounds 1.04e-4 to 1.0e-4
        assert!(stands(&error(1.04e-4), &error(1.04e-4)));
        let order = |x| answer(x, Allowed::Between(1.8, 2.2), "order 2");
        for (now, same) in [
            (2.004, true),
            (2.02, true),
            (1.98, true),
            (2.04, false),
            (1.96, false),
        ] {
            assert_eq!(stands(&order(2.0), &order(now)), same, "{now}");
        }
    }

    #[test]
    fn numbers_that_scatter_are_those_of_the_page_within_a_factor() {
        let error = |x| answer(x, Allowed::AtMost(1e-12), "Rounding of sums");
        for (now, same) in [
            (3e-15, true),
            (2e-14, true),
            (2e-16, true),
            (1e-13, false),
            (1e-17, false),
            (0.0, true),
        ] {
            assert_eq!(stands(&error(2e-15), &error(now)), same, "{now}");
        }
        assert!(!stands(&error(2e-14), &error(0.0)));
        let unit = |x| answer(x, Allowed::AtMost(1.0), "in units of 1e-13: rounding");
        assert!(stands(&unit(0.02), &unit(0.1)) && !stands(&unit(0.02), &unit(0.9)));
        let exact = |x| answer(x, Allowed::AtMost(0.0), "the same arithmetic");
        assert!(stands(&exact(0.0), &exact(0.0)));
        let small = |x| answer(x, Allowed::AtMost(1e-10), "the digits listed");
        assert!(stands(&small(2e-13), &small(9e-13)));
        let drawn = |x| answer(x, Allowed::AtMost(1.0), "of random mechanisms");
        assert!(stands(&drawn(2e-5), &drawn(7e-4)) && !stands(&drawn(2e-5), &drawn(0.5)));
        let order = |x| answer(x, Allowed::Between(1.6, 2.4), "chaotic: it scatters");
        assert!(stands(&order(2.0), &order(2.15)) && !stands(&order(2.0), &order(2.3)));
    }

    #[test]
    fn bounds_reasons_and_tests_are_those_of_the_page() {
        let page = answer(0.5, Allowed::AtMost(1.0), "why | not");
        assert!(stands(&page, &page));
        assert!(!stands(
            &page,
            &answer(0.5, Allowed::AtMost(1.1), "why | not")
        ));
        assert!(!stands(&page, &answer(0.5, Allowed::AtMost(1.0), "why")));
        let mut moved = page.clone();
        moved.file = "tests/chain.rs".into();
        assert!(!stands(&page, &moved));
        let failing = answer(2.0, Allowed::AtMost(1.0), "why | not");
        assert!(!stands(&failing, &page));
    }

    #[test]
    fn another_agreement_may_come_nearest() {
        let codes = |number, bound, reason: &str| Answer {
            rung: Rung::Codes,
            ..answer(number, Allowed::AtMost(bound), reason)
        };
        let page = codes(6.8e-13, 1e-11, "force of case4; rounding");
        assert!(stands(
            &page,
            &codes(6e-10, 1e-8, "force of case3; differenced")
        ));
        assert!(!stands(
            &page,
            &codes(8e-9, 1e-8, "force of case3; differenced")
        ));
        assert!(!stands(
            &page,
            &codes(6.8e-13, 1e-10, "force of case4; rounding")
        ));
    }

    #[test]
    fn rows_are_those_that_tests_ask() {
        let one = answer(0.1, Allowed::AtMost(1.0), "");
        let other = Answer {
            question: "other?".into(),
            ..one.clone()
        };
        let page = format!("{}\n{}\n", line(&one), line(&other));
        assert_eq!(stale(&page, &[one.clone(), other.clone()]), [""; 0]);
        assert_eq!(stale(&page, std::slice::from_ref(&one)).len(), 1);
        assert_eq!(stale(&line(&one), &[one, other]).len(), 1);
    }
}
