//! Formulas in the time t, such as `asin(0.1 * sin(10 * t))`, with exact derivatives: every operation maps values and first two
//! derivatives of its operands to those of its result.

use std::cmp::Ordering::{Equal, Greater, Less};

/// A value with its first and second derivative.
type Jet = [f64; 3];

/// A formula in t.
#[derive(Debug, Clone)]
pub struct Expression(pub(super) Formula);

/// A node of the tree that a formula is.
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
    /// Value, first and second derivative by the argument.
    at: fn(f64) -> Jet,
    has_kink: bool,
}

/// An operator, or a function of two arguments.
#[derive(Debug)]
pub(super) struct Bivariate {
    pub name: &'static str,
    at: fn(Jet, Jet) -> Jet,
    has_kink: bool,
}

const fn smooth(name: &'static str, at: fn(f64) -> Jet) -> Univariate {
    Univariate {
        name,
        at,
        has_kink: false,
    }
}

pub(super) static UNIVARIATE: [Univariate; 13] = [
    smooth("sin", |u| [u.sin(), u.cos(), -u.sin()]),
    smooth("cos", |u| [u.cos(), -u.sin(), -u.cos()]),
    smooth("tan", |u| {
        let (tan, slope) = (u.tan(), 1.0 + u.tan() * u.tan());
        [tan, slope, 2.0 * tan * slope]
    }),
    smooth("asin", |u| {
        let slope = 1.0 / ((1.0 - u) * (1.0 + u)).sqrt();
        [u.asin(), slope, u * slope * slope * slope]
    }),
    smooth("acos", |u| {
        let slope = -1.0 / ((1.0 - u) * (1.0 + u)).sqrt();
        [u.acos(), slope, u * slope * slope * slope]
    }),
    smooth("atan", |u| {
        let slope = 1.0 / (1.0 + u * u);
        [u.atan(), slope, -2.0 * u * slope * slope]
    }),
    smooth("sinh", |u| [u.sinh(), u.cosh(), u.sinh()]),
    smooth("cosh", |u| [u.cosh(), u.sinh(), u.cosh()]),
    smooth("tanh", |u| {
        let slope = 1.0 / (u.cosh() * u.cosh());
        [u.tanh(), slope, -2.0 * u.tanh() * slope]
    }),
    smooth("exp", exponential),
    smooth("log", logarithm),
    smooth("sqrt", |u| power(u, 0.5)),
    Univariate {
        name: "abs",
        at: |u| [u.abs(), u.signum(), 0.0],
        has_kink: true,
    },
];

const fn operator(name: &'static str, at: fn(Jet, Jet) -> Jet) -> Bivariate {
    Bivariate {
        name,
        at,
        has_kink: false,
    }
}

pub(super) static BIVARIATE: [Bivariate; 3] = [
    operator("atan2", |y, x| {
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
        at: |a, b| match a[0].partial_cmp(&b[0]) {
            Some(Less | Equal) => a,
            Some(Greater) => b,
            None => [f64::NAN; 3],
        },
        has_kink: true,
    },
    Bivariate {
        name: "max",
        at: |a, b| match a[0].partial_cmp(&b[0]) {
            Some(Greater | Equal) => a,
            Some(Less) => b,
            None => [f64::NAN; 3],
        },
        has_kink: true,
    },
];

pub(super) static SUM: Bivariate = operator("+", |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
pub(super) static DIFFERENCE: Bivariate =
    operator("-", |a, b| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
pub(super) static PRODUCT: Bivariate = operator("*", product);
pub(super) static QUOTIENT: Bivariate = operator("/", |a, b| {
    let value = a[0] / b[0];
    let rate = (a[1] - value * b[1]) / b[0];
    [
        value,
        rate,
        (a[2] - 2.0 * rate * b[1] - value * b[2]) / b[0],
    ]
});
/// u^v = exp(v log u), for exponents that change.
pub(super) static POWER: Bivariate = operator("^", |u, v| {
    chain(exponential, product(v, chain(logarithm, u)))
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
fn power(u: f64, n: f64) -> Jet {
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

/// f(u(t)). A constant u has no rate, even where f has an infinite one.
fn chain(f: impl Fn(f64) -> Jet, u: Jet) -> Jet {
    let [value, slope, curvature] = f(u[0]);
    match u {
        [_, 0.0, 0.0] => [value, 0.0, 0.0],
        _ => [value, slope * u[1], curvature * u[1] * u[1] + slope * u[2]],
    }
}

impl Expression {
    /// Value, first and second derivative at time t \[s\].
    pub fn at(&self, t: f64) -> [f64; 3] {
        self.0.at(t)
    }

    /// The name of a function in it whose rate can jump.
    pub fn kink(&self) -> Option<&'static str> {
        self.0.kink()
    }
}

impl Formula {
    pub fn at(&self, t: f64) -> Jet {
        match self {
            Formula::Number(value) => [*value, 0.0, 0.0],
            Formula::Time => [t, 1.0, 0.0],
            Formula::Applied(f, u) => chain(f.at, u.at(t)),
            Formula::Power(u, n) => chain(|u| power(u, *n), u.at(t)),
            Formula::Joined(f, pair) => (f.at)(pair[0].at(t), pair[1].at(t)),
        }
    }

    fn kink(&self) -> Option<&'static str> {
        match self {
            Formula::Number(_) | Formula::Time => None,
            Formula::Applied(f, u) => u.kink().or(f.has_kink.then_some(f.name)),
            Formula::Power(u, _) => u.kink(),
            Formula::Joined(f, pair) => {
                let mut kinks = pair.iter().filter_map(Formula::kink);
                kinks.next().or(f.has_kink.then_some(f.name))
            }
        }
    }

    pub fn is_constant(&self) -> bool {
        match self {
            Formula::Number(_) => true,
            Formula::Time => false,
            Formula::Applied(_, u) | Formula::Power(u, _) => u.is_constant(),
            Formula::Joined(_, pair) => pair.iter().all(Formula::is_constant),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Expression {
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
            "min(t, 10) * max(t^3, -4)",
            "-(exp(-t) / sqrt(1 + t))^-2.5",
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
    fn powers_of_zero_are_finite() {
        for (text, expected) in [
            ("t", [0.0, 1.0, 0.0]),
            ("t^1", [0.0, 1.0, 0.0]),
            ("t^2", [0.0, 0.0, 2.0]),
            ("t^0", [1.0, 0.0, 0.0]),
            ("sqrt(0) + t", [0.0, 1.0, 0.0]),
        ] {
            assert_eq!(read(text).at(0.0), expected, "{text}");
        }
        // what has no finite derivative says so
        assert!(!read("sqrt(t)").at(0.0)[1].is_finite());
        assert!(read("min(log(-1), t)").at(0.0)[0].is_nan());
    }
}
