//! Reads formulas in t. Powers bind more tightly than signs, these more tightly than products and quotients, these more tightly
//! than sums and differences.

use super::expression::{
    BIVARIATE, Bivariate, DIFFERENCE, Expression, Formula, PRODUCT, QUOTIENT, SUM, UNIVARIATE,
};
use crate::document::{decimal_comma, did_you_mean, lookalike, quantity};
use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{
    Infix, Prefix, alt, cut_err, delimited, dispatch, empty, expression, fail, opt, peek, preceded,
    separated, terminated,
};
use winnow::prelude::*;
use winnow::token::{any, one_of, take_while};

/// Longest text that is read \[characters\]; it bounds the depth of nesting, and so the stack.
const LONGEST: usize = 1000;

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
        let formula = parsed.map_err(|error| {
            let (read, rest) = text.split_at(error.offset());
            match error.inner().cause() {
                Some(fault) => fault.to_string(),
                None => misplaced(read, rest),
            }
        })?;
        Ok(Expression { formula })
    }
}

/// Characters of the rest of a formula in a message.
const SHOWN: usize = 20;

/// What is wrong between the part of a formula that can be read and the rest.
fn misplaced(read: &str, rest: &str) -> String {
    let is_open = read.matches('(').count() > read.matches(')').count();
    let typed = rest.trim_start_matches(|c: char| c.is_whitespace() && lookalike(c).is_none());
    let rest = match typed.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{} ...", &typed[..end]),
        None => typed.to_owned(),
    };
    if let Some(said) = typed.chars().next().and_then(lookalike) {
        return format!("{said}, in `{rest}`");
    }
    if let Some(said) = comma(read, &rest) {
        return said;
    }
    match rest.chars().next() {
        None if is_open => "a `(` is not closed".to_owned(),
        None => "an operand is missing at its end".to_owned(),
        Some(')') if !is_open => format!("no `(` is open before `{rest}`"),
        Some(c) if c == '(' || c == '°' || c.is_alphanumeric() => product(read, &rest),
        Some(')' | '+' | '-' | '*' | '/' | '^') => {
            format!("an operand is missing before `{rest}`")
        }
        Some(_) => format!("`{rest}` means nothing there"),
    }
}

/// What is meant where a comma follows a number.
fn comma(read: &str, rest: &str) -> Option<String> {
    decimal_comma(last_operand(read), rest.strip_prefix(',')?)
}

/// What is meant by two operands without an operator between them: a number with a unit, or a product.
fn product(read: &str, rest: &str) -> String {
    let left = last_operand(read);
    let end = rest.find(|c: char| !(c == '°' || c.is_alphanumeric() || c == '_'));
    let right = &rest[..end.unwrap_or(rest.len())];
    let is_number = left.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_name = names().any(|name| name == right);
    let unit = quantity(left, right).filter(|_| is_number && !is_name);
    unit.unwrap_or_else(|| {
        let missing = format!("an operator is missing before `{rest}`; a product needs its `*`");
        match (left, right) {
            ("", _) | (_, "") => missing,
            _ => format!("{missing}: write {left}*{right}"),
        }
    })
}

/// The number or name at the end of a part of a formula; nothing behind a parenthesis.
fn last_operand(read: &str) -> &str {
    let read = read.trim_end();
    let start = read.rfind(|c: char| !(c.is_alphanumeric() || c == '.' || c == '_'));
    &read[start.map_or(0, |start| start + 1)..]
}

/// A formula that is read but makes no sense.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Senseless(String);

fn joined(f: &'static Bivariate, a: Formula, b: Formula) -> ModalResult<Formula> {
    Ok(Formula::joined(f, a, b))
}

fn raised(_: &mut &str, base: Formula, exponent: Formula) -> ModalResult<Formula> {
    Ok(Formula::raised(base, exponent))
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
    let exponent = (one_of(['e', 'E']), sign, digit1);
    let fraction = || ('.', digit1).void();
    let whole = (digit1, opt(('.', digit0))).void();
    let digits = alt((whole, preceded(peek(fraction()), fraction())));
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
        .chain(BIVARIATE.iter().map(|f| f.name))
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
            Ok([u]) => Ok(Formula::applied(f, u)),
            Err(_) => takes("one argument in parentheses"),
        };
    }
    if let Some(f) = BIVARIATE.iter().find(|f| f.name == name) {
        return match <[Formula; 2]>::try_from(arguments) {
            Ok([a, b]) => Ok(Formula::joined(f, a, b)),
            Err(_) => takes("two arguments in parentheses"),
        };
    }
    // one letter is as near to any other
    let hint = match name.len() {
        1 => String::new(),
        _ => did_you_mean(name, names()),
    };
    Err(Senseless(format!("`{name}` is not known{hint}")))
}

#[cfg(test)]
mod tests {
    use super::super::expression::tests::read;
    use super::*;

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
    fn faults_are_named() {
        for (text, fault) in [
            ("", "an operand is missing at its end"),
            ("2 *", "an operand is missing at its end"),
            ("2 * (t", "a `(` is not closed"),
            ("(2 *", "a `(` is not closed"),
            (
                "2 t",
                "an operator is missing before `t`; a product needs its `*`: write 2*t",
            ),
            (
                "2pi*t",
                "an operator is missing before `pi*t`; a product needs its `*`: write 2*pi",
            ),
            ("1 + 0,5*t", "a number has a decimal point: 0.5"),
            (
                "30° + t",
                "numbers have no unit; angles are in radians: 30 degrees are 0.523598775598299",
            ),
            (
                "5mm*sin(t)",
                "numbers have no unit; 5 mm is 0.005 m in SI units",
            ),
            (
                "2exp(t)",
                "an operator is missing before `exp(t)`; a product needs its `*`: write 2*exp",
            ),
            (
                "(2)(t)",
                "an operator is missing before `(t)`; a product needs its `*`",
            ),
            ("2 + * t", "an operand is missing before `* t`"),
            ("sin()", "an operand is missing before `)`"),
            ("atan2(1, 2 +)", "an operand is missing before `)`"),
            ("t) + 1", "no `(` is open before `) + 1`"),
            ("sin(t; 2)", "`; 2)` means nothing there"),
            (
                "2 \u{b7} t",
                "this multiplication sign (U+00B7) is not that of a keyboard: write *, in `\u{b7} t`",
            ),
            (
                "1e3*(t\u{2212}0.1)",
                "this minus sign (U+2212) is not that of a keyboard: write -, in `\u{2212}0.1)`",
            ),
            (
                "2 *\u{a0}t",
                "this no-break space (U+00A0) is not that of a keyboard: write a space, in `\u{a0}t`",
            ),
            ("t ? 2", "`? 2` means nothing there"),
            (". + t", "`. + t` means nothing there"),
            (
                "t 34567890123456789012345",
                "an operator is missing before `34567890123456789012 ...`; a product needs its `*`: write \
                 t*34567890123456789012",
            ),
            ("1e999", "`1e999` is too large"),
            ("sine(t)", "`sine` is not known; did you mean `sin`?"),
            ("f + 1", "`f` is not known"),
            ("sin", "`sin` takes one argument in parentheses"),
            ("sin(t, t)", "`sin` takes one argument in parentheses"),
            ("atan2(t)", "`atan2` takes two arguments in parentheses"),
            ("pi(t)", "`pi` takes no arguments"),
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
        for text in [
            "(".repeat(LONGEST),
            "-(".repeat(LONGEST / 2),
            "2^(".repeat(LONGEST / 3),
        ] {
            assert_eq!(Expression::parse(&text).unwrap_err(), "a `(` is not closed");
        }
        assert!(Expression::parse(&" ".repeat(LONGEST + 1)).is_err());
    }
}
