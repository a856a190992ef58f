//! One channel over another: a curve, or a point a period.

use super::axis;
use crate::failure::CommandFailure;
use plot::palette::BLUE;
use plot::{Mark, Panel};
use view::{StoredChannel, StoredResult};

/// A time is a multiple of the period if it is that up to this part of the time between two rows.
const ROUNDING: f64 = 1e-6;

/// The panel of two channels, at the multiples of a period if there is one.
pub fn panel(
    result: &StoredResult,
    x: &StoredChannel,
    y: &StoredChannel,
    period: Option<f64>,
) -> Result<Panel, CommandFailure> {
    let mut across = axis(&x.name, x);
    if x.unit == y.unit && comparable(&x.values, &y.values) {
        across = across.equal();
    }
    let mut panel = super::panel(across, axis(&y.name, y));
    let Some(period) = period else {
        panel
            .marks
            .push(Mark::curve("", BLUE, &x.values, &y.values));
        return Ok(panel);
    };
    let rows = section(&result.times, period).map_err(CommandFailure::bad_input)?;
    let [x, y] = [x, y].map(|c| rows.iter().map(|&row| c.values[row]).collect::<Vec<_>>());
    panel.marks.push(Mark::points("", BLUE, &x, &y, 5));
    panel.note = format!("{} points, one every {period} s", rows.len());
    Ok(panel)
}

/// The rows at multiples of a period.
fn section(times: &[f64], period: f64) -> Result<Vec<usize>, String> {
    if !(period > 0.0 && period.is_finite()) {
        return Err(format!(
            "--poincare must be greater than zero, not {period}"
        ));
    }
    let interval = times[1] - times[0];
    if period < interval * (1.0 - ROUNDING) {
        return Err(format!(
            "--poincare {period} is shorter than the time between rows, {interval} s"
        ));
    }
    let [first, last] = [times[0], times[times.len() - 1]].map(|t| t / period);
    let mut rows = Vec::new();
    for k in (first - ROUNDING).ceil() as i64..=(last + ROUNDING).floor() as i64 {
        let t = k as f64 * period;
        let row = times.partition_point(|time| *time < t - ROUNDING * interval);
        match times.get(row) {
            Some(time) if (time - t).abs() <= ROUNDING * interval => rows.push(row),
            _ => {
                return Err(format!(
                    "there is no row at t = {t} s: the period must be a multiple of `output.interval`, {interval} s"
                ));
            }
        }
    }
    match rows.is_empty() {
        true => Err(format!(
            "no multiple of {period} s lies between the first and the last row"
        )),
        false => Ok(rows),
    }
}

/// True where one scale shows both: neither range is more than ten times the other.
fn comparable(x: &[f64], y: &[f64]) -> bool {
    let range = |values: &[f64]| {
        let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        greatest - values.iter().copied().fold(f64::INFINITY, f64::min)
    };
    let ratio = range(x) / range(y);
    (0.1..=10.0).contains(&ratio)
}

#[cfg(test)]
mod tests {
    use super::section;

    #[test]
    fn a_section_has_the_rows_at_multiples_of_the_period() {
        let times: Vec<f64> = (0..=100).map(|k| f64::from(k) * 0.01).collect();
        assert_eq!(section(&times, 0.25).unwrap(), [0, 25, 50, 75, 100]);
        assert_eq!(section(&times[10..], 0.25).unwrap(), [15, 40, 65, 90]);
        assert!(
            section(&times, 0.255)
                .unwrap_err()
                .contains("no row at t = 0.255")
        );
        assert!(section(&times, 0.0).is_err());
        assert!(section(&times, 1e-18).unwrap_err().contains("shorter"));
        assert!(
            section(&times[1..], 3.0)
                .unwrap_err()
                .contains("no multiple")
        );
    }
}
