//! Functions of time: a number, an expression, or an inline table with a `type`.

use super::kinks::Kink;
use super::{CubicSpline, Expression, Function, Step, parse_expression};
use crate::document::{Field, Fields, Key, Kind, SceneError, Takes};
use numbers::number;
use std::cell::RefCell;

/// What the function is for: motions must have a continuous acceleration, loads need not even be continuous.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// A prescribed motion.
    Motion,
    /// A load.
    Load,
}

/// A kind of function of time. It is read for a use, in a run of a duration \[s\].
pub type FunctionKind = Kind<fn(&Fields, Use, f64) -> Result<Function, SceneError>>;

/// The kinds that a scene can name.
pub static FUNCTIONS: [&FunctionKind; 7] = [
    &POLYNOMIAL,
    &HARMONIC,
    &RAMP,
    &SMOOTH_STEP,
    &SPIN_UP,
    &TABLE,
    &PIECEWISE,
];

static POLYNOMIAL: FunctionKind = FunctionKind {
    name: "polynomial",
    keys: &[Key::new(
        "coefficients",
        Takes::Rows {
            unit: "value/s^k",
            shape: "[c0, c1, c2, ...]",
        },
        "the coefficients of c0 + c1 t + c2 t^2 + ..., one at least",
    )],
    read: |table, _, _| {
        let list = table.field("coefficients")?;
        let items = list.items()?;
        let coefficients: Result<Vec<f64>, _> = items.iter().map(Field::number).collect();
        if items.is_empty() {
            return Err(list.fault(format!("`{}` is empty", list.path), "no coefficient"));
        }
        Ok(Function::Polynomial(coefficients?))
    },
};

static HARMONIC: FunctionKind = FunctionKind {
    name: "harmonic",
    keys: &[
        Key::number("mean", "value", "the mean value"),
        Key::number("amplitude", "value", "the largest deviation from the mean"),
        Key::number("frequency", "Hz", "periods a second"),
        Key::number("phase", "rad", "the phase of the sine at t = 0"),
    ],
    read: |table, _, _| {
        Ok(Function::Harmonic {
            mean: table.number("mean")?,
            amplitude: table.number("amplitude")?,
            frequency: table.number("frequency")?,
            phase: table.number("phase")?,
        })
    },
};

const STEP: [Key; 4] = [
    Key::number("from", "value", "the value before"),
    Key::number("to", "value", "the value after"),
    Key::number("start", "s", "when it begins"),
    Key::positive("duration", "s", "how long it takes"),
];

fn step(table: &Fields) -> Result<Step, SceneError> {
    Ok(Step {
        from: table.number("from")?,
        to: table.number("to")?,
        start: table.number("start")?,
        duration: table.number("duration")?,
    })
}

static RAMP: FunctionKind = FunctionKind {
    name: "ramp",
    keys: &STEP,
    read: |table, purpose, _| {
        if purpose == Use::Motion {
            return Err(kinked(table, "a ramp", "use type \"smooth_step\""));
        }
        Ok(Function::Ramp(step(table)?))
    },
};

/// The fault of a motion whose kind has kinks: it needs an acceleration.
fn kinked(table: &Fields, shape: &str, instead: &str) -> SceneError {
    let kind = table.optional("type").expect("a kind is named");
    let message = format!(
        "`{}` cannot follow {shape}: its velocity would jump",
        table.path()
    );
    kind.fault(message, "no acceleration").with_help(instead)
}

static SMOOTH_STEP: FunctionKind = FunctionKind {
    name: "smooth_step",
    keys: &STEP,
    read: |table, _, _| Ok(Function::SmoothStep(step(table)?)),
};

static SPIN_UP: FunctionKind = FunctionKind {
    name: "spin_up",
    keys: &[
        Key::number("start", "value", "the value at t = 0"),
        Key::number("speed", "value/s", "the final rate"),
        Key::positive("duration", "s", "T, how long it takes"),
    ],
    read: |table, _, _| {
        Ok(Function::SpinUp {
            start: table.number("start")?,
            speed: table.number("speed")?,
            duration: table.number("duration")?,
        })
    },
};

/// The key of the rows of a table over time.
pub(super) const fn rows_key(unit: &'static str, shape: &'static str) -> Key {
    let purpose =
        "two rows or more; their times increase, from 0 or earlier to the end of the run or later";
    Key::new("rows", Takes::Rows { unit, shape }, purpose)
}

/// How a table is interpolated.
pub(super) const SHAPE: Key = Key::word(
    "shape",
    &["natural", "monotone"],
    "the natural cubic spline, or quintic pieces that keep flats flat and do not overshoot",
)
.or("`\"natural\"`");

/// True of a table that asks for the monotone interpolant.
pub(super) fn is_monotone(table: &Fields) -> Result<bool, SceneError> {
    Ok(table.optional_word("shape")? == Some(1))
}

static TABLE: FunctionKind = FunctionKind {
    name: "table",
    keys: &[rows_key("s, value", "[t, value]"), SHAPE],
    read: |table, _, duration| {
        let rows = rows(&table.field("rows")?, duration)?;
        Ok(match is_monotone(table)? {
            true => Function::monotone_table(&rows),
            false => Function::table(&rows),
        })
    },
};

/// What a motion through given values uses.
const MONOTONE: &str = "use type \"table\" with `shape = \"monotone\"`, which keeps flats flat";

static PIECEWISE: FunctionKind = FunctionKind {
    name: "piecewise",
    keys: &[rows_key("s, value", "[t, value]")],
    read: |table, purpose, duration| {
        if purpose == Use::Motion {
            return Err(kinked(table, "straight lines", MONOTONE));
        }
        let rows = rows(&table.field("rows")?, duration)?;
        Ok(Function::Piecewise(rows))
    },
};

/// Reads functions of time.
#[derive(Debug, Clone)]
pub struct FunctionReader {
    /// The kinds that a scene can name.
    pub kinds: Vec<&'static FunctionKind>,
    /// Duration of the run \[s\]: tables over time must cover it.
    pub duration: f64,
    /// What is remarkable about the functions read so far.
    notes: RefCell<Vec<String>>,
}

impl FunctionReader {
    /// Reads functions of some kinds, of a run of this duration \[s\].
    pub(crate) fn new(kinds: Vec<&'static FunctionKind>, duration: f64) -> FunctionReader {
        FunctionReader {
            kinds,
            duration,
            notes: RefCell::default(),
        }
    }

    /// What is remarkable about the functions that were read.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.notes.borrow().clone()
    }

    /// Notes the overshoot of one of the values of a spline; `path` says which.
    pub(super) fn note_overshoot<const N: usize>(
        &self,
        path: &str,
        unit: &str,
        spline: &CubicSpline<N>,
        i: usize,
    ) {
        if let Some(overshoot) = spline.overshoot(i) {
            let [from, to] = overshoot.rows.map(|x| quantity(x, unit));
            let (t, value) = (number(overshoot.t, 4), quantity(overshoot.value, unit));
            self.notes.borrow_mut().push(format!(
                "the table of `{path}` overshoots: between its rows of {from} and {to} it reaches {value} at t = {t} s; \
                 `shape = \"monotone\"` stays between them and keeps flats flat"
            ));
        }
    }

    /// The function that a field describes.
    ///
    /// # Errors
    /// The first fault found.
    pub fn read(&self, field: &Field, purpose: Use) -> Result<Function, SceneError> {
        if field.is_text() {
            return read_expression(field, purpose, self.duration).map(Function::Expression);
        }
        if !field.is_table() {
            return Ok(Function::Constant(field.number()?));
        }
        let (kind, table) = Kind::of(field, "function of time", &self.kinds)?;
        let function = (kind.read)(&table, purpose, self.duration)?;
        if let Function::Table(spline) = &function {
            self.note_overshoot(&field.path, field.unit(), spline, 0);
        }
        Ok(function)
    }
}

/// A value of a table with its unit.
fn quantity(value: f64, unit: &str) -> String {
    format!("{} {unit}", number(value, 4)).trim_end().to_owned()
}

/// Number of equal intervals at whose ends an expression is tried.
const INTERVALS: u32 = 1000;

/// Reads an expression, which must be finite throughout the duration, for a motion with its derivatives.
fn read_expression(field: &Field, purpose: Use, duration: f64) -> Result<Expression, SceneError> {
    let path = &field.path;
    let expression = Expression::parse(field.text()?).map_err(|what| {
        let message = format!("the expression of `{path}` cannot be read: {what}");
        let known = parse_expression::names().collect::<Vec<_>>().join(", ");
        let error = field.fault(message, "not an expression");
        error.with_help(format!("known: {known}"))
    })?;
    let (levels, expression) = match purpose {
        Use::Motion => {
            let smooth = expression.without_kinks(duration);
            let smooth = smooth.map_err(|kink| kinked_expression(field, kink))?;
            (["value", "rate", "acceleration"].as_slice(), smooth)
        }
        Use::Load => (["value"].as_slice(), expression),
    };
    for k in 0..=INTERVALS {
        let t = duration * (f64::from(k) / f64::from(INTERVALS));
        let values = expression.at(t);
        let mut levels = levels.iter().zip(values);
        if let Some((level, value)) = levels.find(|(_, value)| !value.is_finite()) {
            let message = format!(
                "the {level} of `{path}` is {value} at t = {} s",
                number(t, 6)
            );
            return Err(field.fault(message, "not finite"));
        }
    }
    Ok(expression)
}

/// The fault of a motion whose value, velocity or acceleration jumps where `abs`, `min` or `max` switches.
fn kinked_expression(field: &Field, kink: Kink) -> SceneError {
    let Kink {
        name,
        t,
        level,
        jump,
        ..
    } = kink;
    let (quantity, per) = [("value", ""), ("velocity", "/s"), ("acceleration", "/s2")][level];
    let jump = match jump {
        _ if jump.is_nan() => "is not a number".to_owned(),
        f64::INFINITY => "becomes infinite".to_owned(),
        _ => format!("jumps by {} {}{per}", number(jump, 4), field.unit()),
    };
    let message = format!(
        "`{}` has a kink where `{name}(...)` switches: at t = {} s its {quantity} {jump}",
        field.path,
        number(t, 6),
    );
    let error = field.fault(message, "no continuous acceleration");
    error.with_help(format!(
        "a motion needs a continuous acceleration: `smooth_step(u)` rises from 0 to 1 while u does; or {MONOTONE}"
    ))
}

/// Rows of a table over time: times increase and cover the duration.
pub(super) fn rows<const N: usize>(
    field: &Field,
    duration: f64,
) -> Result<Vec<[f64; N]>, SceneError> {
    let items = field.items()?;
    let mut rows: Vec<[f64; N]> = Vec::with_capacity(items.len());
    for item in &items {
        let row = item.numbers::<N>(field.shape())?;
        if let Some(last) = rows.last().filter(|last| row[0] <= last[0]) {
            let message = format!(
                "the times of `{}` must increase: {:?} after {:?}",
                field.path, row[0], last[0]
            );
            return Err(item.fault(message, "not later than the row before"));
        }
        rows.push(row);
    }
    let [first, .., last] = &rows[..] else {
        let message = format!("`{}` needs two rows or more", field.path);
        return Err(field.fault(message, "too short"));
    };
    if first[0] > 0.0 {
        let message = format!(
            "the first time of `{}` must not be later than 0",
            field.path
        );
        return Err(items[0].fault(message, "starts too late"));
    }
    if last[0] < duration {
        let message = format!(
            "the last time of `{}` must reach the duration of {duration} s",
            field.path
        );
        return Err(items[items.len() - 1].fault(message, "ends too early"));
    }
    Ok(rows)
}
