//! Formulas in the time t, such as `asin(0.1 * sin(10 * t))`, with exact derivatives: every operation maps values and first two
//! derivatives of its operands to those of its result.

use super::line::quintic;

/// A value with its first and second derivative.
pub(super) type Jet = [f64; 3];

/// A formula in t.
#[derive(Debug, Clone)]
pub struct Expression {
    pub(super) formula: Formula,
}

/// A node of the tree that a formula is. What does not depend on t is a number.
#[derive(Debug, Clone)]
pub(super) enum Formula {
    Number(f64),
    /// t.
    Time,
    /// A function of one argument.
    Applied(&'static Univariate, Box<Formula>),
    /// A power with a constant exponent.
    Power(Box<Formula>, f64),
    /// An operator, or a function of two arguments.
    Joined(&'static Bivariate, Box<[Formula; 2]>),
}

/// A function of one argument.
#[derive(Debug)]
pub(super) struct Univariate {
    pub name: &'static str,
    /// Value, first and second derivative by the argument; none of a function that switches between its argument and its negative.
    pub at: Option<fn(f64) -> Jet>,
}

/// An operator, or a function of two arguments.
#[derive(Debug)]
pub(super) struct Bivariate {
    pub name: &'static str,
    pub rule: Rule,
}

/// How a function of two arguments comes from them.
#[derive(Debug)]
pub(super) enum Rule {
    Smooth(fn(Jet, Jet) -> Jet),
    /// It switches to the larger of its arguments
    Larger,
    /// or to the smaller one.
    Smaller,
}

const fn of_one(name: &'static str, at: fn(f64) -> Jet) -> Univariate {
    let at = Some(at);
    Univariate { name, at }
}

const fn of_two(name: &'static str, at: fn(Jet, Jet) -> Jet) -> Bivariate {
    let rule = Rule::Smooth(at);
    Bivariate { name, rule }
}

pub(super) static UNIVARIATE: [Univariate; 14] = [
    of_one("sin", |u| [u.sin(), u.cos(), -u.sin()]),
    of_one("cos", |u| [u.cos(), -u.sin(), -u.cos()]),
    of_one("tan", |u| {
        let (tan, slope) = (u.tan(), 1.0 + u.tan() * u.tan());
        [tan, slope, 2.0 * tan * slope]
    }),
    of_one("asin", |u| {
        let slope = 1.0 / ((1.0 - u) * (1.0 + u)).sqrt();
        [u.asin(), slope, u * slope * slope * slope]
    }),
    of_one("acos", |u| {
        let slope = -1.0 / ((1.0 - u) * (1.0 + u)).sqrt();
        [u.acos(), slope, u * slope * slope * slope]
    }),
    of_one("atan", |u| {
        let slope = 1.0 / (1.0 + u * u);
        [u.atan(), slope, -2.0 * u * slope * slope]
    }),
    of_one("sinh", |u| [u.sinh(), u.cosh(), u.sinh()]),
    of_one("cosh", |u| [u.cosh(), u.sinh(), u.cosh()]),
    of_one("tanh", |u| {
        let slope = 1.0 / (u.cosh() * u.cosh());
        [u.tanh(), slope, -2.0 * u.tanh() * slope]
    }),
    of_one("exp", exponential),
    of_one("log", logarithm),
    of_one("sqrt", |u| power(u, 0.5)),
    of_one("smooth_step", |u| match u.is_nan() {
        true => [f64::NAN; 3],
        false => quintic(u),
    }),
    Univariate {
        name: "abs",
        at: None,
    },
];

pub(super) static BIVARIATE: [Bivariate; 3] = [
    of_two("atan2", |y, x| {
        let square = x[0] * x[0] + y[0] * y[0];
        let rate = (x[0] * y[1] - y[0] * x[1]) / square;
        let turning = x[0] * y[2] - y[0] * x[2];
        let stretching = x[0] * x[1] + y[0] * y[1];
        [
            y[0].atan2(x[0]),
            rate,
            (turning - 2.0 * stretching * rate) / square,
        ]
    }),
    Bivariate {
        name: "min",
        rule: Rule::Smaller,
    },
    Bivariate {
        name: "max",
        rule: Rule::Larger,
    },
];

pub(super) static SUM: Bivariate = of_two("+", |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
pub(super) static DIFFERENCE: Bivariate =
    of_two("-", |a, b| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
pub(super) static PRODUCT: Bivariate = of_two("*", product);
pub(super) static QUOTIENT: Bivariate = of_two("/", |a, b| {
    let value = a[0] / b[0];
    let rate = (a[1] - value * b[1]) / b[0];
    [
        value,
        rate,
        (a[2] - 2.0 * rate * b[1] - value * b[2]) / b[0],
    ]
});
/// u^v = exp(v log u), for exponents that change.
pub(super) static POWER: Bivariate = of_two("^", |u, v| match u[0] > 0.0 {
    true => chain(exponential, product(v, chain(logarithm, u))),
    false => [f64::NAN; 3],
});

fn product(a: Jet, b: Jet) -> Jet {
    [
        a[0] * b[0],
        a[1] * b[0] + a[0] * b[1],
        a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2],
    ]
}

fn exponential(u: f64) -> Jet {
    [u.exp(); 3]
}

fn logarithm(u: f64) -> Jet {
    [u.ln(), 1.0 / u, -1.0 / (u * u)]
}

/// u^n. A coefficient of zero wins over an infinite power: t^1 has the second derivative 0 at t = 0.
pub(super) fn power(u: f64, n: f64) -> Jet {
    let scaled = |coefficient: f64, exponent: f64| match coefficient {
        0.0 => 0.0,
        _ => coefficient * u.powf(exponent),
    };
    [
        u.powf(n),
        scaled(n, n - 1.0),
        scaled(n * (n - 1.0), n - 2.0),
    ]
}

impl Univariate {
    fn of(&self, u: Jet, switches: &mut impl Switches) -> Jet {
        match self.at {
            Some(at) => chain(at, u),
            None if switches.first(self.name, u) => u,
            None => u.map(|x| -x),
        }
    }
}

impl Bivariate {
    fn of(&self, a: Jet, b: Jet, switches: &mut impl Switches) -> Jet {
        let margin = match self.rule {
            Rule::Smooth(at) => return at(a, b),
            Rule::Larger => margin(a, b),
            Rule::Smaller => margin(b, a),
        };
        match switches.first(self.name, margin) {
            // a comparison must not hide what is not a number
            _ if a[0].is_nan() || b[0].is_nan() => [f64::NAN; 3],
            true => a,
            false => b,
        }
    }
}

/// By how much a is above b.
fn margin(a: Jet, b: Jet) -> Jet {
    std::array::from_fn(|level| a[level] - b[level])
}

/// f(u(t)).
pub(super) fn chain(f: impl Fn(f64) -> Jet, u: Jet) -> Jet {
    let [value, slope, curvature] = f(u[0]);
    [value, slope * u[1], curvature * u[1] * u[1] + slope * u[2]]
}

/// Which branch a function takes that switches, of its name and the margin by which the first branch leads. A formula asks for
/// its switches in the same order at every time.
pub(super) trait Switches {
    /// True for the first branch.
    fn first(&mut self, name: &'static str, margin: Jet) -> bool;
}

/// The branches that the values call for; where both have the same value, those that the values call for right after.
struct ByValue;

impl Switches for ByValue {
    fn first(&mut self, _: &'static str, [value, rate, acceleration]: Jet) -> bool {
        value > 0.0 || value == 0.0 && (rate > 0.0 || rate == 0.0 && acceleration >= 0.0)
    }
}

impl Expression {
    /// Value, first and second derivative at time t \[s\].
    pub fn at(&self, t: f64) -> [f64; 3] {
        self.formula.at(t, &mut ByValue)
    }
}

impl Formula {
    /// Value and derivatives on the branches that `switches` says.
    pub fn at(&self, t: f64, switches: &mut impl Switches) -> Jet {
        match self {
            Formula::Number(value) => [*value, 0.0, 0.0],
            Formula::Time => [t, 1.0, 0.0],
            Formula::Applied(f, u) => f.of(u.at(t, switches), switches),
            Formula::Power(u, n) => chain(|u| power(u, *n), u.at(t, switches)),
            Formula::Joined(f, pair) => {
                let a = pair[0].at(t, switches);
                f.of(a, pair[1].at(t, switches), switches)
            }
        }
    }

    /// The same formula with its switches fixed: `branches` says of each, in the order of [`Switches`], whether it is always on its
    /// first branch or always on the other one, and of the rest nothing.
    pub fn settled(self, branches: &mut impl Iterator<Item = Option<bool>>) -> Formula {
        match self {
            Formula::Number(_) | Formula::Time => self,
            Formula::Power(u, n) => Formula::raised(u.settled(branches), Formula::Number(n)),
            Formula::Applied(f, u) => {
                let u = u.settled(branches);
                match f.at.is_none().then(|| branches.next().flatten()).flatten() {
                    Some(true) => u,
                    Some(false) => Formula::joined(&PRODUCT, Formula::Number(-1.0), u),
                    None => Formula::applied(f, u),
                }
            }
            Formula::Joined(f, pair) => {
                let [a, b] = *pair;
                let (a, b) = (a.settled(branches), b.settled(branches));
                let switches = !matches!(f.rule, Rule::Smooth(_));
                match switches.then(|| branches.next().flatten()).flatten() {
                    Some(true) => a,
                    Some(false) => b,
                    None => Formula::joined(f, a, b),
                }
            }
        }
    }

    /// f(u).
    pub fn applied(f: &'static Univariate, u: Formula) -> Formula {
        match u {
            Formula::Number(u) => Formula::Number(f.of([u, 0.0, 0.0], &mut ByValue)[0]),
            u => Formula::Applied(f, Box::new(u)),
        }
    }

    /// f(a, b).
    pub fn joined(f: &'static Bivariate, a: Formula, b: Formula) -> Formula {
        match (a, b) {
            (Formula::Number(a), Formula::Number(b)) => {
                Formula::Number(f.of([a, 0.0, 0.0], [b, 0.0, 0.0], &mut ByValue)[0])
            }
            (a, b) => Formula::Joined(f, Box::new([a, b])),
        }
    }

    /// base^exponent.
    pub fn raised(base: Formula, exponent: Formula) -> Formula {
        match (base, exponent) {
            (Formula::Number(u), Formula::Number(n)) => Formula::Number(u.powf(n)),
            (u, Formula::Number(n)) => Formula::Power(Box::new(u), n),
            (u, v) => Formula::joined(&POWER, u, v),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn read(text: &str) -> Expression {
        Expression::parse(text).unwrap_or_else(|fault| panic!("{text}: {fault}"))
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let formulas = UNIVARIATE
            .iter()
            .map(|f| format!("{}(0.3 + 0.4 * sin(t))", f.name));
        let others = [
            "t^3 - 2 * t / (1 + t) + 4 ^ t",
            "(1 + t^2) ** (sin(t) - 0.3)",
            "atan2(t^2, cos(3 * t))",
            "min(t, 10) * max(t^3, -4) + min(9, t) * max(-1, t^2)",
            "-(exp(-t) / sqrt(1 + t))^-2.5",
            "smooth_step((t - 0.1) / 2) - 2 * smooth_step(t - 0.75)",
        ];
        for text in formulas.chain(others.map(str::to_owned)) {
            let f = read(&text);
            for t in [0.2, 0.9, 1.7] {
                let (low, mid, high) = (f.at(t - 1e-6), f.at(t), f.at(t + 1e-6));
                for (level, bound) in [(0, 1e-7), (1, 1e-6)] {
                    let difference = (high[level] - low[level]) / 2e-6;
                    // central differences: rounding 1e-16/1e-6 and a remainder of 1e-12, both times values up to 300
                    assert!((difference - mid[level + 1]).abs() < bound, "{text} at {t}");
                }
            }
            assert_ne!(f.at(0.9)[1], 0.0, "nothing was tested");
        }
    }

    #[test]
    fn derivatives_are_finite_where_those_of_all_operations_are() {
        for (text, expected) in [
            ("t", [0.0, 1.0, 0.0]),
            ("t^1", [0.0, 1.0, 0.0]),
            ("t^2", [0.0, 0.0, 2.0]),
            ("t^0", [1.0, 0.0, 0.0]),
            ("t^max(2, 1)", [0.0, 0.0, 2.0]),
            ("sqrt(0) + t", [0.0, 1.0, 0.0]),
            ("atan2(0, 0) + 0^0 * t", [0.0, 1.0, 0.0]),
        ] {
            assert_eq!(read(text).at(0.0), expected, "{text}");
        }
        for text in [
            "sqrt(t)",
            "sqrt(t^3)",
            "sqrt(t^4)",
            "acos(1 - t^4)",
            "t^(1 + t)",
        ] {
            let [value, rate, acceleration] = read(text).at(0.0);
            assert!(!(value + rate + acceleration).is_finite(), "{text}");
        }
        for text in ["min(log(-1), t)", "max(t, 0/0)", "(-t)^t"] {
            assert!(!read(text).at(0.0)[0].is_finite(), "{text}");
        }
    }
}
