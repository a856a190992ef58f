//! Formulas in the time t, such as `asin(0.1 * sin(10 * t))`, with exact derivatives: every operation maps values and first two
//! derivatives of its operands to those of its result.

use crate::document::did_you_mean;
use std::cmp::Ordering::{Equal, Greater, Less};
use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{
    Infix, Prefix, alt, cut_err, delimited, dispatch, empty, expression, fail, opt, peek, preceded,
    separated, terminated,
};
use winnow::prelude::*;
use winnow::token::{any, one_of, take_while};

/// A value with its first and second derivative.
type Jet = [f64; 3];

/// Longest text that is read \[characters\]; it bounds the depth of nesting, and so the stack.
pub(super) const LONGEST: usize = 1000;

/// A formula in t.
#[derive(Debug, Clone)]
pub struct Expression(Formula);

#[derive(Debug, Clone)]
enum Formula {
    Number(f64),
    Time,
    Applied(&'static Univariate, Box<Formula>),
    /// A power with a constant exponent.
    Power(Box<Formula>, f64),
    Joined(&'static Bivariate, Box<[Formula; 2]>),
}

/// A function of one argument.
#[derive(Debug)]
struct Univariate {
    name: &'static str,
    /// Value, first and second derivative by the argument.
    at: fn(f64) -> Jet,
    has_kink: bool,
}

/// An operator, or a function of two arguments.
#[derive(Debug)]
struct Bivariate {
    name: &'static str,
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

static UNIVARIATE: [Univariate; 13] = [
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

static ATAN2: Bivariate = Bivariate {
    name: "atan2",
    at: |y, x| {
        let square = x[0] * x[0] + y[0] * y[0];
        let rate = (x[0] * y[1] - y[0] * x[1]) / square;
        let turning = x[0] * y[2] - y[0] * x[2];
        let stretching = x[0] * x[1] + y[0] * y[1];
        [
            y[0].atan2(x[0]),
            rate,
            (turning - 2.0 * stretching * rate) / square,
        ]
    },
    has_kink: false,
};
static MIN: Bivariate = Bivariate {
    name: "min",
    at: |a, b| match a[0].partial_cmp(&b[0]) {
        Some(Less | Equal) => a,
        Some(Greater) => b,
        None => [f64::NAN; 3],
    },
    has_kink: true,
};
static MAX: Bivariate = Bivariate {
    name: "max",
    at: |a, b| match a[0].partial_cmp(&b[0]) {
        Some(Greater | Equal) => a,
        Some(Less) => b,
        None => [f64::NAN; 3],
    },
    has_kink: true,
};
static BIVARIATE: [&Bivariate; 3] = [&ATAN2, &MIN, &MAX];

const fn operator(name: &'static str, at: fn(Jet, Jet) -> Jet) -> Bivariate {
    Bivariate {
        name,
        at,
        has_kink: false,
    }
}

static SUM: Bivariate = operator("+", |a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
static DIFFERENCE: Bivariate = operator("-", |a, b| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]);
static PRODUCT: Bivariate = operator("*", product);
static QUOTIENT: Bivariate = operator("/", |a, b| {
    let value = a[0] / b[0];
    let rate = (a[1] - value * b[1]) / b[0];
    [
        value,
        rate,
        (a[2] - 2.0 * rate * b[1] - value * b[2]) / b[0],
    ]
});
/// u^v = exp(v log u), for exponents that change.
static POWER: Bivariate = operator("^", |u, v| {
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
    /// Reads a formula.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Expression, String> {
        if text.chars().count() > LONGEST {
            return Err(format!("it is longer than {LONGEST} characters"));
        }
        let parsed = preceded(multispace0, term).parse(text);
        parsed.map(Expression).map_err(|error| {
            let rest = text[error.offset()..].trim_start().to_owned();
            match error.into_inner().cause() {
                Some(fault) => fault.to_string(),
                None if rest.is_empty() => "it ends too early".to_owned(),
                None => format!("`{rest}` cannot stand where it stands"),
            }
        })
    }

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
    fn at(&self, t: f64) -> Jet {
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

    fn is_constant(&self) -> bool {
        match self {
            Formula::Number(_) => true,
            Formula::Time => false,
            Formula::Applied(_, u) | Formula::Power(u, _) => u.is_constant(),
            Formula::Joined(_, pair) => pair.iter().all(Formula::is_constant),
        }
    }
}

/// A formula that is read but makes no sense.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Senseless(String);

fn joined(f: &'static Bivariate, a: Formula, b: Formula) -> ModalResult<Formula> {
    Ok(Formula::Joined(f, Box::new([a, b])))
}

/// Operands and operators, each with the space that follows it.
fn term(input: &mut &str) -> ModalResult<Formula> {
    let prefix = dispatch! { peek(any);
        '-' => any.value(Prefix(5, |_: &mut _, a| joined(&PRODUCT, Formula::Number(-1.0), a))),
        '+' => any.value(Prefix(5, |_: &mut _, a| Ok(a))),
        _ => fail,
    };
    let infix = dispatch! { any;
        '+' => empty.value(Infix::Left(1, |_: &mut _, a, b| joined(&SUM, a, b))),
        '-' => empty.value(Infix::Left(1, |_: &mut _, a, b| joined(&DIFFERENCE, a, b))),
        '/' => empty.value(Infix::Left(3, |_: &mut _, a, b| joined(&QUOTIENT, a, b))),
        '^' => empty.value(Infix::Right(7, raised)),
        '*' => opt('*').map(|second| match second {
            Some(_) => Infix::Right(7, raised),
            None => Infix::Left(3, |_: &mut _, a, b| joined(&PRODUCT, a, b)),
        }),
        _ => fail,
    };
    expression(terminated(operand, multispace0))
        .prefix(terminated(prefix, multispace0))
        .infix(terminated(infix, multispace0))
        .parse_next(input)
}

fn raised(_: &mut &str, base: Formula, exponent: Formula) -> ModalResult<Formula> {
    match exponent.is_constant() {
        true => Ok(Formula::Power(Box::new(base), exponent.at(0.0)[0])),
        false => joined(&POWER, base, exponent),
    }
}

fn operand(input: &mut &str) -> ModalResult<Formula> {
    let parenthesis = || ('(', multispace0);
    dispatch! { peek(any);
        '0'..='9' | '.' => number,
        '(' => delimited(parenthesis(), cut_err(term), cut_err(')')),
        'a'..='z' | 'A'..='Z' | '_' => named,
        _ => fail,
    }
    .parse_next(input)
}

/// A number without a sign: that of -2^2 does not belong to it.
fn number(input: &mut &str) -> ModalResult<Formula> {
    let sign = opt(one_of(['+', '-']));
    let exponent = (one_of(['e', 'E']), sign, cut_err(digit1));
    let digits = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let value = (digits, opt(exponent)).take().try_map(|text: &str| {
        let value = text.parse().ok().filter(|x: &f64| x.is_finite());
        value.ok_or_else(|| Senseless(format!("`{text}` is too large")))
    });
    cut_err(value.map(Formula::Number)).parse_next(input)
}

/// The time, a constant, or a function with its arguments.
fn named(input: &mut &str) -> ModalResult<Formula> {
    let name = take_while(1.., ('a'..='z', 'A'..='Z', '0'..='9', '_'));
    let comma = (',', multispace0);
    let list = separated(1.., cut_err(term), comma);
    let arguments = delimited(('(', multispace0), list, cut_err(')'));
    let call = (terminated(name, multispace0), opt(arguments));
    cut_err(
        call.try_map(|(name, arguments): (&str, Option<Vec<Formula>>)| understood(name, arguments)),
    )
    .parse_next(input)
}

/// What a formula can name.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    let functions = UNIVARIATE.iter().map(|f| f.name);
    ["t", "pi"]
        .into_iter()
        .chain(functions)
        .chain(BIVARIATE.map(|f| f.name))
}

/// The meaning of a name, with arguments where parentheses follow it.
fn understood(name: &str, arguments: Option<Vec<Formula>>) -> Result<Formula, Senseless> {
    let takes = |what: &str| Err(Senseless(format!("`{name}` takes {what}")));
    if let Some(constant) = match name {
        "t" => Some(Formula::Time),
        "pi" => Some(Formula::Number(std::f64::consts::PI)),
        _ => None,
    } {
        return match arguments {
            None => Ok(constant),
            Some(_) => takes("no arguments"),
        };
    }
    let arguments = arguments.unwrap_or_default();
    if let Some(f) = UNIVARIATE.iter().find(|f| f.name == name) {
        return match <[Formula; 1]>::try_from(arguments) {
            Ok([u]) => Ok(Formula::Applied(f, Box::new(u))),
            Err(_) => takes("one argument in parentheses"),
        };
    }
    if let Some(f) = BIVARIATE.into_iter().find(|f| f.name == name) {
        return match <[Formula; 2]>::try_from(arguments) {
            Ok(pair) => Ok(Formula::Joined(f, Box::new(pair))),
            Err(_) => takes("two arguments in parentheses"),
        };
    }
    let hint = did_you_mean(name, names());
    Err(Senseless(format!("`{name}` is not known{hint}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Expression {
        Expression::parse(text).unwrap_or_else(|fault| panic!("{text}: {fault}"))
    }

    #[test]
    fn operators_bind_as_in_a_book() {
        let t: f64 = 0.7;
        for (text, value) in [
            ("-t^2", -(t * t)),
            ("2 * -t", -2.0 * t),
            ("2^-t", 2.0_f64.powf(-t)),
            ("2**3^2", 512.0),
            (" 8 - 3 - 2 ", 3.0),
            ("8 / 4 / 2 * 3", 3.0),
            ("1+2*3^2-(4-5)*6", 25.0),
            ("--+t", t),
            ("-2^2*3", -12.0),
            (".5 + 1.e1 + 2E-1", 10.7),
            ("( pi )", std::f64::consts::PI),
            ("max(t, 0.5) - min(t, 0.5)", 0.2),
            ("atan2(-t, -1)", f64::atan2(-t, -1.0)),
        ] {
            // three roundings of numbers up to 600
            assert!(
                (read(text).at(t)[0] - value).abs() < 1e-13 * value.abs().max(1.0),
                "{text}"
            );
        }
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

    #[test]
    fn faults_are_named() {
        for (text, fault) in [
            ("", "it ends too early"),
            ("2 *", "it ends too early"),
            ("(t", "it ends too early"),
            ("2 t", "`t` cannot stand where it stands"),
            ("2 + * t", "`* t` cannot stand where it stands"),
            ("t)", "`)` cannot stand where it stands"),
            ("sin(t; 2)", "`; 2)` cannot stand where it stands"),
            ("2 \u{b7} t", "`\u{b7} t` cannot stand where it stands"),
            ("1e999", "`1e999` is too large"),
            ("sine(t)", "`sine` is not known; did you mean `sin`?"),
            ("load + 1", "`load` is not known"),
            ("sin", "`sin` takes one argument in parentheses"),
            ("sin(t, t)", "`sin` takes one argument in parentheses"),
            ("atan2(t)", "`atan2` takes two arguments in parentheses"),
            ("pi(t)", "`pi` takes no arguments"),
            ("sin()", "`)` cannot stand where it stands"),
            ("atan2(1, 2 +)", "`)` cannot stand where it stands"),
            (". + t", "`+ t` cannot stand where it stands"),
        ] {
            assert_eq!(Expression::parse(text).unwrap_err(), fault, "{text}");
        }
    }

    /// Neither reading nor evaluating the deepest texts exhausts the stack of a thread of 2 MiB.
    #[test]
    fn the_longest_texts_are_read() {
        let half = LONGEST / 2 - 1;
        let texts = [
            format!("{}t{}", "(".repeat(half), ")".repeat(half)),
            format!("t{}", "+t".repeat(half)),
            format!("t{}", "^1".repeat(half)),
            format!("{}t", "-".repeat(LONGEST - 1)),
        ];
        for text in texts {
            assert!(read(&text).at(1.0)[0].is_finite());
        }
        assert!(Expression::parse(&" ".repeat(LONGEST + 1)).is_err());
    }
}
