//! Functions of time: a number, or an inline table with a `type`.

use super::Function;
use super::error::SceneError;
use super::field::Field;

/// What the function is for: motions must have an acceleration, loads need not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    Motion,
    Load,
}

pub(super) fn function(field: &Field, purpose: Use, duration: f64) -> Result<Function, SceneError> {
    #[derive(Clone, Copy)]
    enum Type {
        Polynomial,
        Harmonic,
        Ramp,
        SmoothStep,
        SpinUp,
        Table,
    }
    if !field.is_table() {
        return Ok(Function::Constant(field.number()?));
    }
    let mut table = field.fields()?;
    let types = [
        ("polynomial", Type::Polynomial),
        ("harmonic", Type::Harmonic),
        ("ramp", Type::Ramp),
        ("smooth_step", Type::SmoothStep),
        ("spin_up", Type::SpinUp),
        ("table", Type::Table),
    ];
    let kind = "\"polynomial\", \"harmonic\", \"ramp\", \"smooth_step\", \"spin_up\" or \"table\"";
    let type_field = table.required("type", kind)?;
    Ok(match type_field.choice(&types)? {
        Type::Polynomial => {
            table.only(&["type", "coefficients"])?;
            let list = table.required(
                "coefficients",
                "c0, c1, c2, ... of c0 + c1 t + c2 t^2 + ...",
            )?;
            let items = list.items()?;
            let coefficients: Result<Vec<f64>, _> = items.iter().map(Field::number).collect();
            if items.is_empty() {
                return Err(list.fault(format!("`{}` is empty", list.path), "no coefficient"));
            }
            Function::Polynomial(coefficients?)
        }
        Type::Harmonic => {
            table.only(&["type", "mean", "amplitude", "frequency", "phase"])?;
            let number = |key, purpose| table.required(key, purpose)?.number();
            Function::Harmonic {
                mean: number("mean", "the mean value")?,
                amplitude: number("amplitude", "the largest deviation from the mean")?,
                frequency: number("frequency", "periods a second [Hz]")?,
                phase: number("phase", "the phase of the sine at t = 0 [rad]")?,
            }
        }
        Type::Ramp | Type::SmoothStep => {
            table.only(&["type", "from", "to", "start", "duration"])?;
            let number = |key, purpose| table.required(key, purpose)?.number();
            let from = number("from", "the value before")?;
            let to = number("to", "the value after")?;
            let start = number("start", "when it begins [s]")?;
            let duration = table
                .required("duration", "how long it takes [s]")?
                .positive()?;
            if type_field.text()? == "smooth_step" {
                Function::SmoothStep {
                    from,
                    to,
                    start,
                    duration,
                }
            } else if purpose == Use::Motion {
                let message = format!(
                    "`{}` cannot follow a ramp: its speed would jump where the ramp begins",
                    field.path
                );
                let error = type_field.fault(message, "no acceleration");
                return Err(error.with_help("use \"smooth_step\""));
            } else {
                Function::Ramp {
                    from,
                    to,
                    start,
                    duration,
                }
            }
        }
        Type::SpinUp => {
            table.only(&["type", "start", "speed", "duration"])?;
            let number = |key, purpose| table.required(key, purpose)?.number();
            Function::SpinUp {
                start: number("start", "the value at t = 0")?,
                speed: number("speed", "the final rate")?,
                duration: table
                    .required("duration", "how long it takes [s]")?
                    .positive()?,
            }
        }
        Type::Table => {
            table.only(&["type", "rows"])?;
            let rows = table.required("rows", "the rows [t, value]")?;
            Function::table(&self::rows(&rows, duration, "[t, value]")?)
        }
    })
}

/// Rows of a table over time: times increase and cover the duration.
pub(super) fn rows<const N: usize>(
    field: &Field,
    duration: f64,
    shape: &str,
) -> Result<Vec<[f64; N]>, SceneError> {
    let items = field.items()?;
    let mut rows: Vec<[f64; N]> = Vec::with_capacity(items.len());
    for item in &items {
        let row = item.numbers::<N>(shape)?;
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
        return Err(field.fault(
            format!("`{}` needs two rows or more", field.path),
            "too short",
        ));
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
