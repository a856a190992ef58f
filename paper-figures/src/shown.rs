//! How templates write numbers and means with their intervals.

use minijinja::value::Value;
use minijinja::{AutoEscape, Environment, Error, ErrorKind, UndefinedBehavior};
use numbers::{digits, number, percent, si};
use statistics::Interval;

/// Templates of Markdown. A name that a template gets wrong is an error, no empty text.
///
/// There are the filters `si(unit)`, `digits` and `percent` of a number, or of a mean with its interval as "a ± b", and `exact`, which
/// writes all digits, as in a file. Units may be % and none. `number(digits)` is one as in a file, and `cell` a text in a table.
pub fn environment() -> Environment<'static> {
    let mut templates = Environment::new();
    templates.set_undefined_behavior(UndefinedBehavior::Strict);
    // an error names its line; with all names and values it has thousands
    templates.set_debug(false);
    templates.set_trim_blocks(true);
    templates.set_keep_trailing_newline(true);
    templates.set_auto_escape_callback(|_| AutoEscape::None);
    templates.add_filter("si", |x: Value, unit: &str| match unit {
        "" => written(&x, digits),
        "%" => written(&x, percent),
        unit => written(&x, |x| si(x, unit)),
    });
    templates.add_filter("exact", numbers::exact);
    templates.add_filter("digits", |x: Value| written(&x, digits));
    templates.add_filter("percent", |x: Value| written(&x, percent));
    templates.add_filter("number", |x: f64, digits: usize| number(x, digits));
    templates.add_filter("cell", |text: String| text.replace('|', "\\|"));
    templates
}

/// Mean and interval of several runs; the value of a single one.
pub fn mean(values: &[f64]) -> Value {
    match values {
        [one] => Value::from(*one),
        all => Value::from_serialize(Interval::of(all)),
    }
}

fn written(value: &Value, show: impl Fn(f64) -> String) -> Result<String, Error> {
    let number = |value: &Value| f64::try_from(value.clone());
    if let Ok(x) = number(value) {
        return Ok(show(x));
    }
    let (mean, half) = (value.get_attr("mean")?, value.get_attr("half")?);
    match (number(&mean), number(&half)) {
        (Ok(mean), Ok(half)) => Ok(format!("{} ± {}", show(mean), show(half))),
        _ => Err(Error::new(
            ErrorKind::InvalidOperation,
            format!("{value} is no number"),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use minijinja::context;

    #[test]
    fn numbers_and_means_are_written_and_nothing_else() {
        let templates = environment();
        let values =
            context! { one => 2e-5, mean => Interval { mean: 0.25, half: 0.01 }, none => () };
        let written = |text: &str| templates.render_str(text, &values);
        assert_eq!(written("{{ one|si('m') }}").unwrap(), "20\u{a0}µm");
        assert_eq!(
            written("{{ mean|percent }}").unwrap(),
            "25\u{a0}% ± 1\u{a0}%"
        );
        assert!(written("{{ none|digits }}").is_err() && written("{{ other }}").is_err());
    }
}
