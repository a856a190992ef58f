//! Values of formulas with estimates of their rounding to first order, by running error analysis (Higham 2002, Accuracy and Stability of Numerical
//! Algorithms, section 3.3): every operation hands on the errors of its operands and adds its own.

use super::expression::{Formula, Jet, Rule, chain, power};

/// A value with its derivatives, and an estimate of the error of the value. A value within this error is zero.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rounded {
    pub jet: Jet,
    error: f64,
}

impl Rounded {
    pub fn new(jet: Jet, error: f64) -> Rounded {
        let [value, rate, acceleration] = jet;
        let value = if value.abs() <= error { 0.0 } else { value };
        Rounded {
            jet: [value, rate, acceleration],
            error,
        }
    }

    /// What is computed from operands with errors: `ends` are, for each operand, the results at both ends of its interval of error.
    fn computed(jet: Jet, ends: impl IntoIterator<Item = [f64; 2]>) -> Rounded {
        let [value, ..] = jet;
        let own = f64::EPSILON * value.abs();
        // where only one end has a value, its distance counts
        let errors = ends.into_iter().map(|ends| {
            let [low, high] = ends.map(|end| (end - value).abs());
            low.max(high)
        });
        Rounded::new(jet, errors.fold(own, |sum, error| sum + error))
    }

    fn ends(self) -> [f64; 2] {
        [self.jet[0] - self.error, self.jet[0] + self.error]
    }

    fn negative(self) -> Rounded {
        Rounded::new(self.jet.map(|x| -x), self.error)
    }

    fn through(self, f: impl Fn(f64) -> Jet) -> Rounded {
        let ends = self.ends().map(|end| f(end)[0]);
        Rounded::computed(chain(&f, self.jet), [ends])
    }

    fn with(self, other: Rounded, f: impl Fn(Jet, Jet) -> Jet) -> Rounded {
        let (a, b) = (self.jet, other.jet);
        let of_first = self.ends().map(|end| f([end, a[1], a[2]], b)[0]);
        let of_second = other.ends().map(|end| f(a, [end, b[1], b[2]])[0]);
        Rounded::computed(f(a, b), [of_first, of_second])
    }
}

impl Formula {
    /// Its value at a time, on the branches that `first` says of the name and the margin of each switch.
    pub fn rounded(
        &self,
        time: Rounded,
        first: &mut impl FnMut(&'static str, Rounded) -> bool,
    ) -> Rounded {
        match self {
            Formula::Number(x) => Rounded::new([*x, 0.0, 0.0], f64::EPSILON * x.abs()),
            Formula::Time => time,
            Formula::Applied(f, u) => {
                let u = u.rounded(time, first);
                match f.at {
                    Some(at) => u.through(at),
                    None if first(f.name, u) => u,
                    None => u.negative(),
                }
            }
            Formula::Power(u, n) => u.rounded(time, first).through(|u| power(u, *n)),
            Formula::Joined(f, pair) => {
                let a = pair[0].rounded(time, first);
                let b = pair[1].rounded(time, first);
                let minus = |a: Jet, b: Jet| std::array::from_fn(|level| a[level] - b[level]);
                let margin = match f.rule {
                    Rule::Smooth(at) => return a.with(b, at),
                    Rule::Larger => a.with(b, minus),
                    Rule::Smaller => b.with(a, minus),
                };
                match first(f.name, margin) {
                    true => a,
                    false => b,
                }
            }
        }
    }
}
