//! Kinks of formulas: instants at which `abs`, `min` or `max` switches and the value of the formula or one of its first two derivatives
//! jumps.
//!
//! At equally spaced times the branch of every such function is known. Between two of these times a function switches if its
//! branches there differ, or if its margin has an extreme in between on the other side of zero. The instant is then bisected to the
//! last digit, and the formula is evaluated there on the branches of either side. So every switching is found but those of a
//! function that switches there and back between neighbouring times and whose margin has more than one extreme between them.

use super::expression::{Expression, Jet, Switches};

/// Number of equal intervals at whose ends the branches are compared.
const INTERVALS: u32 = 10_000;

/// Switchings without a jump that are followed from one time to the next.
const FOLLOWED: usize = 4;

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
    /// What jumps: 0 the value, 1 its rate, 2 its acceleration.
    pub level: usize,
    /// By how much.
    pub jump: f64,
}

/// A function that switches, at some time.
#[derive(Debug, Clone, Copy)]
struct Margin {
    name: &'static str,
    /// True on its first branch.
    first: bool,
    rate: f64,
}

/// Notes the branches that the values call for.
#[derive(Default)]
struct Seen(Vec<Margin>);

impl Switches for Seen {
    fn first(&mut self, name: &'static str, margin: Jet) -> bool {
        let [value, rate, _] = margin;
        let first = value >= 0.0;
        self.0.push(Margin { name, first, rate });
        first
    }
}

/// Keeps to given branches.
struct Kept<'a>(std::slice::Iter<'a, Margin>);

impl Switches for Kept<'_> {
    fn first(&mut self, _: &'static str, _: Jet) -> bool {
        self.0.next().is_some_and(|margin| margin.first)
    }
}

impl Expression {
    /// The first kink from t = 0 to `duration`; of the levels that jump there the lowest.
    pub(super) fn kink(&self, duration: f64) -> Option<Kink> {
        let times = (0..=INTERVALS).map(|k| duration * (f64::from(k) / f64::from(INTERVALS)));
        let times: Vec<f64> = times.collect();
        let mut before = self.margins(0.0);
        if before.is_empty() {
            return None;
        }
        let mut sizes = [0.0_f64; 3];
        for t in &times {
            let jet = self.at(*t);
            sizes = std::array::from_fn(|level| sizes[level].max(jet[level].abs()));
        }
        // a jump also is rounding where it changes the level below by rounding within the duration
        for level in 1..3 {
            sizes[level] = sizes[level].max(sizes[level - 1] / duration);
        }
        for pair in times.windows(2) {
            let after = self.margins(pair[1]);
            let between = self.extremes([pair[0], pair[1]], [&before, &after]);
            let ends = between.into_iter().chain([pair[1]]);
            let mut from = pair[0];
            for to in ends {
                if let Some(kink) = self.kink_between(from, to, sizes) {
                    return Some(kink);
                }
                from = to;
            }
            before = after;
        }
        None
    }

    fn margins(&self, t: f64) -> Vec<Margin> {
        let mut seen = Seen::default();
        self.formula.at(t, &mut seen);
        seen.0
    }

    /// Instants between two times at which a margin that has the same sign at both has another one, at its extreme.
    fn extremes(&self, times: [f64; 2], [before, after]: [&[Margin]; 2]) -> Vec<f64> {
        let mut found = Vec::new();
        for (k, (a, b)) in before.iter().zip(after).enumerate() {
            let nears = |at: &Margin, rate: f64| if at.first { rate < 0.0 } else { rate > 0.0 };
            if a.first != b.first || !nears(a, a.rate) || !nears(b, -b.rate) {
                continue;
            }
            let falls_still = |t: f64| nears(a, self.margins(t)[k].rate);
            let [_, extreme] = bisected(times, falls_still);
            if self.margins(extreme)[k].first != a.first {
                found.push(extreme);
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// The first kink between two times, of the branches that they and the times between them have.
    fn kink_between(&self, from: f64, to: f64, sizes: [f64; 3]) -> Option<Kink> {
        let last = self.margins(to);
        let same = |a: &[Margin], b: &[Margin]| a.iter().zip(b).all(|(a, b)| a.first == b.first);
        let mut at = from;
        for _ in 0..FOLLOWED {
            let here = self.margins(at);
            if same(&here, &last) {
                break;
            }
            // branches that agree at both ends are the same curve: of equal arguments rounding decides which is larger
            let agrees = |t: f64| self.jump([&here, &last], t, sizes).is_none();
            if agrees(from) && agrees(to) {
                break;
            }
            let [_, switched] = bisected([at, to], |t| same(&here, &self.margins(t)));
            let there = self.margins(switched);
            if let Some((level, jump)) = self.jump([&here, &there], switched, sizes) {
                let mut pairs = here.iter().zip(&there);
                let (switch, _) = pairs.find(|(a, b)| a.first != b.first)?;
                return Some(Kink {
                    name: switch.name,
                    t: switched,
                    level,
                    jump,
                });
            }
            at = switched;
        }
        None
    }

    /// The lowest level in which the formula on some branches differs at time t from that on others, and by how much.
    fn jump(&self, sides: [&[Margin]; 2], t: f64, sizes: [f64; 3]) -> Option<(usize, f64)> {
        let [before, after] = sides.map(|branches| self.formula.at(t, &mut Kept(branches.iter())));
        let jumps = (0..3).map(|level| (level, (after[level] - before[level]).abs()));
        let is_rounding = |&(level, jump): &(usize, f64)| {
            // in the last digit of the instant a level changes by so much
            let next = [before, after].map(|jet| jet.get(level + 1).map_or(0.0, |x| x.abs()));
            jump <= f64::EPSILON * t * (next[0] + next[1]) + ROUNDING * sizes[level]
        };
        // what is not a number is no rounding
        jumps.into_iter().find(|jump| !is_rounding(jump))
    }
}

/// Neighbouring numbers within an interval, at the first of which a condition holds as it does at its begin.
fn bisected([mut from, mut to]: [f64; 2], holds: impl Fn(f64) -> bool) -> [f64; 2] {
    loop {
        let middle = from + 0.5 * (to - from);
        if middle <= from || middle >= to {
            return [from, to];
        }
        match holds(middle) {
            true => from = middle,
            false => to = middle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::expression::tests::read;
    use super::*;

    #[track_caller]
    fn jumps(text: &str, expected: (&str, f64, usize, f64)) {
        let kink = read(text)
            .kink(2.0)
            .unwrap_or_else(|| panic!("{text} has no kink"));
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

    /// A branch has no value at the instant.
    #[test]
    fn what_is_not_a_number_is_a_kink() {
        let kink = read("abs(t - 0.5) / (t - 0.5)").kink(2.0);
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
        ] {
            assert_eq!(read(text).kink(2.0), None, "{text}");
        }
    }

    /// A margin that crosses zero for a part of an interval only is found by its extreme.
    #[test]
    fn brief_switchings_are_found() {
        let interval = 2.0 / f64::from(INTERVALS);
        for part in [0.9, 0.3, 1e-3] {
            let half = 0.5 * part * interval;
            let middle = 0.61 + 0.5 * interval;
            let text = format!("max(0, {half}^2 - (t - {middle})^2)");
            let kink = read(&text).kink(2.0).expect(&text);
            assert_eq!((kink.name, kink.level), ("max", 1));
            // the root of a difference of squares: rounding 1e-16 over its slope
            assert!(
                (kink.t - (middle - half)).abs() < 1e-16 / half,
                "{text}: {kink:?}"
            );
        }
    }
}
