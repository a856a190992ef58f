//! Kinks of formulas: instants at which `abs`, `min` or `max` switches and the value of the formula or one of its first two derivatives
//! jumps.
//!
//! A function switches where its margin, by which one branch leads, changes its sign; a margin within its rounding has no sign. The signs
//! are compared at many times, at the extremes of the margins and at the instants at which others switch. Each instant is found to the
//! last digit. Functions whose margins are zero at the same instant switch together: there the formula is evaluated on the branches
//! of before and on those of after, with what is within its rounding taken as zero, so that the two values are the limits from either
//! side. So every switching is found but those of a function that switches there and back between neighbouring times and whose margin
//! has more than one extreme between them.

use super::Knot;
use super::expression::{Expression, Jet, Switches};
use super::rounded::Rounded;

/// Number of equal intervals at whose ends the signs are compared. It is irrational, so that no periodic margin has its roots there.
const INTERVALS: f64 = 10_000.618_033_988_749;

/// Halvings of the first and of the last interval, at whose ends margins often are zero: down to the last digit.
const HALVINGS: u32 = f64::MANTISSA_DIGITS;

/// A jump below this part of the largest value of its level is rounding, of a formula in which not more than half of the digits
/// cancel.
const ROUNDING: f64 = 1e-8;

/// A jump of a formula or of a derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kink {
    /// The function that switches.
    pub name: &'static str,
    /// When \[s\].
    pub t: f64,
    /// The last time before it and the first one after it at which the function has its branches \[s\].
    pub within: [f64; 2],
    /// What jumps: 0 the value, 1 its rate, 2 its acceleration.
    pub level: usize,
    /// By how much; infinite where one of the sides is.
    pub jump: f64,
}

/// The margin of a function that switches, at some time.
#[derive(Debug, Clone, Copy)]
struct Margin {
    name: &'static str,
    value: f64,
    rate: f64,
}

impl Margin {
    /// True where the first branch leads, false where the other one does, none within rounding.
    fn sign(&self) -> Option<bool> {
        match self.value {
            x if x > 0.0 => Some(true),
            x if x < 0.0 => Some(false),
            _ => None,
        }
    }
}

/// Notes the rates of the margins, on the branches that the values call for.
#[derive(Default)]
struct Rates(Vec<f64>);

impl Switches for Rates {
    fn first(&mut self, _: &'static str, [value, rate, _]: Jet) -> bool {
        self.0.push(rate);
        value >= 0.0
    }
}

/// A function that switches.
#[derive(Debug, Clone, Copy)]
struct Switching {
    /// Which, in the order of the formula.
    function: usize,
    /// When \[s\]: between the last time before and the first time after at which its margin has a sign.
    within: [f64; 2],
    /// True where it switches to its first branch.
    to_first: bool,
}

/// What a function does during the motion.
#[derive(Debug, Clone, Copy, Default)]
struct Course {
    /// The first sign of its margin.
    first: Option<bool>,
    /// The last sign, and when it was seen.
    last: Option<(f64, bool)>,
    /// True where it switches, or has no value to tell.
    is_open: bool,
}

impl Expression {
    /// The formula of a motion from t = 0 to `duration`, with every function that keeps its branch replaced by this branch: at the ends
    /// of the motion, too, it then has the derivatives that it has within.
    ///
    /// # Errors
    /// The first kink; of the levels that jump there the lowest.
    pub(super) fn without_kinks(self, duration: f64) -> Result<Expression, Kink> {
        let (courses, kinks) = self.follow(duration);
        if let Some(kink) = kinks.first() {
            return Err(*kink);
        }
        let keeps = |course: &Course| course.first.filter(|_| !course.is_open);
        let formula = self.formula.settled(&mut courses.iter().map(keeps));
        Ok(Expression { formula })
    }

    /// The kinks from t = 0 to `duration` as knots.
    pub(super) fn knots(&self, duration: f64) -> Vec<Knot> {
        let (_, kinks) = self.follow(duration);
        let knot = |kink: &Kink| Knot {
            sides: kink.within,
            level: kink.level,
        };
        kinks.iter().map(knot).collect()
    }

    /// The course of each function that switches, and all kinks.
    fn follow(&self, duration: f64) -> (Vec<Course>, Vec<Kink>) {
        let motion = Motion {
            expression: self,
            duration,
        };
        let names: Vec<_> = motion.margins(0.0).iter().map(|m| m.name).collect();
        if names.is_empty() {
            return (Vec::new(), Vec::new());
        }
        let (courses, switchings) = motion.follow(names.len());
        let kinks = motion.kinks(&names, &courses, switchings);
        (courses, kinks)
    }
}

/// A formula from t = 0 to the end of a motion.
struct Motion<'e> {
    expression: &'e Expression,
    duration: f64,
}

impl Motion<'_> {
    /// A time, which is known to the last digit of the duration.
    fn time(&self, t: f64) -> Rounded {
        Rounded::new([t, 1.0, 0.0], f64::EPSILON * self.duration)
    }

    /// The margins of all functions that switch, on the branches that the values call for.
    fn margins(&self, t: f64) -> Vec<Margin> {
        let mut margins = Vec::new();
        self.expression
            .formula
            .rounded(self.time(t), &mut |name, margin| {
                let [value, rate, _] = margin.jet;
                margins.push(Margin { name, value, rate });
                value >= 0.0
            });
        margins
    }

    /// Value and derivatives on given branches.
    fn on(&self, branches: &[bool], t: f64) -> Jet {
        let mut branches = branches.iter();
        let mut first = |_, _| *branches.next().expect("every function has a branch");
        self.expression
            .formula
            .rounded(self.time(t), &mut first)
            .jet
    }

    /// Times that share no period with a formula, closer to one another at both ends.
    fn times(&self) -> Vec<f64> {
        let interval = self.duration / INTERVALS;
        let equal = (1..=INTERVALS as u32).map(|k| interval * f64::from(k));
        let halves = || (1..=HALVINGS).map(|k| interval * 0.5_f64.powi(k as i32));
        let mut times: Vec<f64> = equal.chain(halves()).collect();
        times.extend(halves().map(|before| self.duration - before));
        times.extend([0.0, self.duration]);
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The course of each function, and all switchings.
    fn follow(&self, count: usize) -> (Vec<Course>, Vec<Switching>) {
        let mut courses = vec![Course::default(); count];
        let mut switchings = Vec::new();
        let mut before: Option<(f64, Vec<Margin>)> = None;
        for t in self.times() {
            let margins = self.margins(t);
            let mut stops = match &before {
                Some((from, first)) => self.stops([*from, t], [first, &margins]),
                None => Vec::new(),
            };
            stops.sort_by(f64::total_cmp);
            for stop in stops {
                self.visit(stop, &self.margins(stop), &mut courses, &mut switchings);
            }
            self.visit(t, &margins, &mut courses, &mut switchings);
            before = Some((t, margins));
        }
        (courses, switchings)
    }

    /// Takes down the signs of the margins at a time.
    fn visit(
        &self,
        t: f64,
        margins: &[Margin],
        courses: &mut [Course],
        switchings: &mut Vec<Switching>,
    ) {
        for (k, (margin, course)) in margins.iter().zip(courses).enumerate() {
            course.is_open |= margin.value.is_nan();
            let Some(sign) = margin.sign() else { continue };
            match course.last {
                Some((from, last)) if last != sign => {
                    course.is_open = true;
                    switchings.push(self.switching(k, [from, t], sign));
                }
                _ => {}
            }
            course.first.get_or_insert(sign);
            course.last = Some((t, sign));
        }
    }

    /// The switching of a function between two times at which its margin has different signs.
    fn switching(&self, function: usize, [from, to]: [f64; 2], to_first: bool) -> Switching {
        let sign = |t: f64| self.margins(t)[function].sign();
        let root = self.root(function, [from, to]);
        // outwards to where the margin has a sign
        let steps = || (0..).map(|k| f64::EPSILON * self.duration * 2.0_f64.powi(k));
        let mut before = steps().map(|step| from.max(root - step));
        let mut after = steps().map(|step| to.min(root + step));
        let before = before.find(|t| *t == from || sign(*t) == Some(!to_first));
        let after = after.find(|t| *t == to || sign(*t) == Some(to_first));
        Switching {
            function,
            within: [before.unwrap_or(from), after.unwrap_or(to)],
            to_first,
        }
    }

    /// An instant between two times at which the margin of a function has no sign, or changes it: by turns from the secant and by halving.
    fn root(&self, function: usize, [mut from, mut to]: [f64; 2]) -> f64 {
        let margin = |t: f64| self.margins(t)[function];
        let (mut first, mut last) = (margin(from), margin(to));
        for is_secant in [true, false].into_iter().cycle() {
            let t = match is_secant {
                true => from + (to - from) * (first.value / (first.value - last.value)),
                false => from.midpoint(to),
            };
            let is_within = from < t && t < to;
            if !is_within && !is_secant {
                break;
            }
            if !is_within {
                continue;
            }
            let here = margin(t);
            match here.sign() {
                None => return t,
                sign if sign == first.sign() => (from, first) = (t, here),
                _ => (to, last) = (t, here),
            }
        }
        to
    }

    /// Instants between two times at which a function may have another branch than at both: at the extreme of its margin, or where another
    /// one switches.
    fn stops(&self, times: [f64; 2], [before, after]: [&[Margin]; 2]) -> Vec<f64> {
        let mut stops = Vec::new();
        for (k, (a, b)) in before.iter().zip(after).enumerate() {
            let (Some(first), Some(last)) = (a.sign(), b.sign()) else {
                continue;
            };
            if first != last {
                stops.push(self.root(k, times));
                continue;
            }
            let nears = |rate: f64| if first { rate < 0.0 } else { rate > 0.0 };
            if nears(a.rate) && nears(-b.rate) {
                stops.push(self.extreme(k, times, nears));
            }
        }
        stops
    }

    /// The extreme of a margin between two times, up to which it nears zero. Half of the digits of its instant give all of its value.
    fn extreme(&self, function: usize, times: [f64; 2], nears: impl Fn(f64) -> bool) -> f64 {
        let [mut from, mut to] = times;
        for _ in 0..HALVINGS / 2 {
            let middle = from.midpoint(to);
            let mut rates = Rates::default();
            self.expression.formula.at(middle, &mut rates);
            match nears(rates.0[function]) {
                true => from = middle,
                false => to = middle,
            }
        }
        to
    }

    /// The kinks among the switchings, in the order of time.
    fn kinks(
        &self,
        names: &[&'static str],
        courses: &[Course],
        mut switchings: Vec<Switching>,
    ) -> Vec<Kink> {
        let mut kinks = Vec::new();
        let sizes = self.sizes();
        let first = courses.iter().map(|course| course.first.unwrap_or(true));
        let mut before: Vec<bool> = first.collect();
        switchings.sort_by(|a, b| a.within[0].total_cmp(&b.within[0]));
        let mut switchings = switchings.into_iter().peekable();
        while let Some(first) = switchings.next() {
            let [mut begin, mut end] = first.within;
            let mut now = vec![first];
            while let Some(next) = switchings.next_if(|next| next.within[0] < end) {
                (begin, end) = (next.within[0], end.min(next.within[1]));
                now.push(next);
            }
            let mut after = before.clone();
            for switching in &now {
                after[switching.function] = switching.to_first;
            }
            if let Some((level, jump)) = self.jump([&before, &after], [begin, end], sizes) {
                let first = now
                    .iter()
                    .map(|s| s.function)
                    .fold(first.function, usize::min);
                kinks.push(Kink {
                    name: names[first],
                    t: begin.midpoint(end),
                    within: [begin, end],
                    level,
                    jump,
                });
            }
            before = after;
        }
        kinks
    }

    /// The largest value and derivatives.
    fn sizes(&self) -> Jet {
        let mut sizes = [0.0_f64; 3];
        for t in self.times() {
            let jet = self.expression.at(t);
            for (size, x) in sizes.iter_mut().zip(jet).filter(|(_, x)| x.is_finite()) {
                *size = size.max(x.abs());
            }
        }
        // a jump also is rounding where it changes the level below by rounding within the duration
        for level in 1..3 {
            sizes[level] = sizes[level].max(sizes[level - 1] / self.duration);
        }
        sizes
    }

    /// The lowest level in which the formula on some branches differs from that on others at an instant between two times, and by how
    /// much.
    fn jump(&self, sides: [&[bool]; 2], within: [f64; 2], sizes: Jet) -> Option<(usize, f64)> {
        let at = |t: f64| sides.map(|branches| self.on(branches, t));
        let [before, after] = at(within[0].midpoint(within[1]));
        for (level, size) in sizes.into_iter().enumerate() {
            let (a, b) = (before[level], after[level]);
            if a.is_infinite() || b.is_infinite() {
                return Some((level, f64::INFINITY));
            }
            let jump = (b - a).abs();
            if jump <= ROUNDING * size {
                continue;
            }
            // what changes its sign between the two times is zero at some instant between them; what is not a number is no rounding
            let [first, last] = within.map(|t| {
                let [before, after] = at(t);
                after[level] - before[level]
            });
            if first * last < 0.0 {
                continue;
            }
            return Some((level, jump));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::expression::tests::read;
    use super::*;
    use std::f64::consts::PI;

    fn kink(text: &str) -> Option<Kink> {
        read(text).without_kinks(2.0).err()
    }

    #[track_caller]
    fn jumps(text: &str, expected: (&str, f64, usize, f64)) {
        let kink = kink(text).unwrap_or_else(|| panic!("{text} has no kink"));
        assert_eq!((kink.name, kink.level), (expected.0, expected.2), "{text}");
        // instants are roots to rounding, and jumps rounding of numbers below 100
        assert!((kink.t - expected.1).abs() < 1e-14, "{text}: {kink:?}");
        assert!(
            (kink.jump - expected.3).abs() < 1e-11 * expected.3,
            "{text}: {kink:?}"
        );
    }

    #[test]
    fn a_kink_is_named_with_its_instant_level_and_jump() {
        jumps("max(0, t - 0.25)", ("max", 0.25, 1, 1.0));
        jumps("min(1.2 * t, 0.3)", ("min", 0.25, 1, 1.2));
        jumps("3 * abs(t - 0.7)", ("abs", 0.7, 1, 6.0));
        jumps("max(0, t - 0.25)^2", ("max", 0.25, 2, 2.0));
        jumps("(1 + t) / (2 + abs(t - 1) * (t - 1))", ("abs", 1.0, 2, 2.0));
        // of several the first; one inside the other
        jumps(
            "max(0, 1 - abs(t - 1.5)) + abs(t - 1.9)",
            ("max", 0.5, 1, 1.0),
        );
        jumps("max(abs(t - 1), 0.5)", ("max", 0.5, 1, 1.0));
    }

    /// At the first instant within the motion; those at its start and end, and beyond, are none.
    #[test]
    fn kinks_are_those_within_the_motion() {
        jumps("max(0, sin(3 * t))", ("max", PI / 3.0, 1, 3.0));
        jumps("min(0, sin(3 * t))", ("min", PI / 3.0, 1, 3.0));
        jumps("abs(t * (t - 1))", ("abs", 1.0, 1, 2.0));
        jumps("min(1, max(0, t))", ("min", 1.0, 1, 1.0));
        jumps("max(0, t * (1e-4 - t))", ("max", 1e-4, 1, 1e-4));
        jumps("max(0, (2 - t) * (1.9999 - t))", ("max", 1.9999, 1, 1e-4));
        // a tent between two of the times, and one whose roots are at equal times
        jumps(
            "max(0, 1e-9 - abs(t - 1.00003))",
            ("max", 1.00003 - 1e-9, 1, 1.0),
        );
        jumps("max(0, sin(5000 * pi * t))", ("max", 2e-4, 1, 5000.0 * PI));
    }

    /// Of the limits from either side.
    #[test]
    fn functions_that_switch_together_are_compared_together() {
        jumps("abs(t - 1) + abs(1 - t)", ("abs", 1.0, 1, 4.0));
        jumps("max(t, 1) + 2 * min(t, 1)", ("max", 1.0, 1, 1.0));
        jumps(
            "max(0, t - 1) + max(0, 1 - t) - 3 * abs(t - 1)",
            ("max", 1.0, 1, 4.0),
        );
        // 1.5 u^0.5 at the instant, and nothing at one before
        for text in [
            "max(0, t - 1)^1.5",
            "abs(t - 1)^1.5",
            "3 + max(0, sin(3 * t))^1.5",
        ] {
            let kink = kink(text).expect(text);
            assert_eq!((kink.level, kink.jump), (2, f64::INFINITY), "{text}");
        }
        for text in ["sqrt(abs(t - 1))", "sqrt(max(0, t - 1))"] {
            let kink = kink(text).expect(text);
            assert_eq!((kink.level, kink.jump), (1, f64::INFINITY), "{text}");
        }
    }

    /// On the branch that a function keeps, a motion has the derivatives of its other times at its ends, too.
    #[test]
    fn functions_that_keep_their_branch_are_this_branch() {
        for (text, same) in [
            ("max(0, t)", "t"),
            ("min(0, t)", "0 * t"),
            ("max(0, t)^2", "t^2"),
            ("max(0, -t)", "0 * t"),
            ("abs(-t)", "t"),
            ("abs(t - 2)", "2 - t"),
            ("max(0, t - 2) + min(0, 2 - t)", "0 * t"),
            ("min(t, 2)", "t"),
            ("max(0, 1 - cos(t))", "1 - cos(t)"),
            ("min(0, 1 - cos(t))", "0 * t"),
            ("max(t, 5) + abs(t + 1)", "6 + t"),
            ("max(0, t - 5)^1.5", "0 * t"),
        ] {
            let motion = read(text).without_kinks(2.0);
            let motion = motion.unwrap_or_else(|kink| panic!("{text}: {kink:?}"));
            for t in [0.0, 0.7, 2.0] {
                assert_eq!(motion.at(t), read(same).at(t), "{text} at {t}");
            }
        }
    }

    /// A branch has no value at the instant.
    #[test]
    fn what_is_not_a_number_is_a_kink() {
        let kink = kink("abs(t - 0.5) / (t - 0.5)");
        let kink = kink.expect("its sign jumps");
        assert_eq!((kink.name, kink.t, kink.level), ("abs", 0.5, 0));
        assert!(kink.jump.is_nan());
    }

    #[test]
    fn smooth_formulas_have_no_kink() {
        for text in [
            "sin(t)",
            "max(0, t - 0.25)^3",
            "abs((t - 1)^3)",
            "abs(t + 1) + max(t, 7)",
            "10 * max(0, min(1, t - 0.3))^3 - 15 * max(0, min(1, t - 0.3))^4 + 6 * max(0, min(1, t - 0.3))^5",
            "min(smooth_step(t), smooth_step(2 * t))",
            "smooth_step(max(0, min(1, 3 * t)))",
            // equal arguments switch at random
            "max(sin(t)^2 + cos(t)^2, 1) + min(t, t)",
            "0.03 * max(sin(9 * t)^2 + cos(9 * t)^2, 1)",
            "abs(t)",
            // u^2.5 has the second derivative 3.75 u^0.5
            "max(0, t - 1)^2.5",
            "min(0, 1 - t)^2 * max(0, t - 1)",
            "100 + max(0, t - 1)^2.5",
            "max(0, t - 1)^2.2",
            "abs(t - 1)^2.5",
            "max(0, sin(3 * t))^2.2",
            // together
            "max(t, 1) + min(t, 1)",
            "max(t, 2 - t) + min(t, 2 - t)",
            "abs(t - 1) - max(t - 1, 1 - t)",
            "max(0, t - 1) - max(0, 1 - t)",
            "abs(t - 1) * abs(1 - t)",
            "max(0, t - 1) * max(0, 1 - t)",
            // touched, not crossed
            "max(0, 1 - cos(t - 1))",
            "max(0, (t - 1)^2) + abs(t^2 - 2 * t + 1)",
            "min(1, sin(t)) + max(-1, cos(3 * t))",
            // of a margin that is zero for a while, and of one that is rounding for a while
            "max(0, max(0, t - 1)^3) + max(min(t - 1, max(0, t - 1.5)^3), 0)",
            "max(0, t^3 - 3 * t^2 + 3 * t - 1)",
        ] {
            assert_eq!(kink(text), None, "{text}");
        }
    }

    /// A margin that crosses zero for a part of an interval only is found by its extreme.
    #[test]
    fn brief_switchings_are_found() {
        let interval = 2.0 / INTERVALS;
        for part in [0.9, 0.3, 1e-3] {
            let half = 0.5 * part * interval;
            let middle = 0.61 + 0.5 * interval;
            let text = format!("max(0, {half}^2 - (t - {middle})^2)");
            let kink = kink(&text).expect(&text);
            assert_eq!((kink.name, kink.level), ("max", 1));
            // the root of a difference of squares: rounding 1e-16 over its slope
            assert!(
                (kink.t - (middle - half)).abs() < 1e-16 / half,
                "{text}: {kink:?}"
            );
        }
    }
}
