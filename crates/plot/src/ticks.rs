//! Where the ticks of an axis stand and what is written at them.

use crate::layout::SMALL;
use crate::{Axis, Scale, text};
use numbers::{digits, rounded, si};

/// A laid-out axis: the range in drawing values (after factor, power of ten and logarithm) and its ticks.
pub struct Ticks {
    /// Axis label with the unit and the power of ten taken out of the ticks.
    pub label: String,
    /// Range in drawing values.
    pub range: (f64, f64),
    /// Drawing value and text.
    pub major: Vec<(f64, String)>,
    /// Drawing values of unlabelled ticks.
    pub minor: Vec<f64>,
    factor: f64,
    scale: Scale,
}

impl Ticks {
    /// Ticks for an axis whose data span `data` (SI); about `wanted` labels.
    pub fn new(axis: &Axis, data: (f64, f64), wanted: usize) -> Ticks {
        match axis.scale {
            _ if !axis.names.is_empty() => categories(axis),
            Scale::Linear => linear(axis, data, wanted),
            Scale::Log => logarithmic(axis, data, wanted),
        }
    }

    /// Widths of the texts in pixels.
    pub fn widths(&self) -> impl Iterator<Item = i32> {
        let texts = self.major.iter().map(|(_, text)| text);
        texts.map(|text| text::width(text, SMALL))
    }

    /// Drawing value of a datum in SI; NaN where it cannot be drawn.
    pub fn place(&self, si: f64) -> f64 {
        match self.scale {
            Scale::Linear => si * self.factor,
            Scale::Log if si > 0.0 => (si * self.factor).log10(),
            Scale::Log => f64::NAN,
        }
    }
}

/// One tick a name; the range falls, so that the first stands at the top.
fn categories(axis: &Axis) -> Ticks {
    let places = axis.names.iter().enumerate();
    Ticks {
        label: axis.label.clone(),
        range: (axis.names.len() as f64 - 0.5, -0.5),
        major: places.map(|(k, name)| (k as f64, name.clone())).collect(),
        minor: Vec::new(),
        factor: 1.0,
        scale: Scale::Linear,
    }
}

fn linear(axis: &Axis, data: (f64, f64), wanted: usize) -> Ticks {
    let (mut low, mut high) = axis.range.unwrap_or(data);
    low *= axis.factor;
    high *= axis.factor;
    if !(low.is_finite() && high.is_finite()) {
        (low, high) = (0.0, 1.0);
    }
    let size = low.abs().max(high.abs());
    if high - low <= 1e-9 * size || size == 0.0 {
        let half = if size == 0.0 { 1.0 } else { 0.05 * size };
        (low, high) = (low - half, high + half);
    } else if axis.range.is_none() {
        let pad = 0.05 * (high - low);
        (low, high) = (low - pad, high + pad);
    }
    let power = power_of_ten(low.abs().max(high.abs()));
    let shift = 10f64.powi(-power);
    (low, high) = (low * shift, high * shift);
    let step = round_step((high - low) / wanted as f64);
    let decimals = (-(step * 1.0000001).log10().floor()).max(0.0) as usize
        + usize::from(is_quarter(step) && step < 100.0);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    let values = (first..=last).map(|k| k as f64 * step);
    let major = values.map(|v| (v, signed(&format!("{v:.decimals$}"))));
    Ticks {
        label: label(axis, power),
        range: (low, high),
        major: major.collect(),
        minor: Vec::new(),
        factor: axis.factor * shift,
        scale: Scale::Linear,
    }
}

fn logarithmic(axis: &Axis, data: (f64, f64), wanted: usize) -> Ticks {
    let (low, high) = match axis.range.unwrap_or(data) {
        (low, high) if low > 0.0 && high >= low => (low, high),
        _ => (0.1, 1.0),
    };
    let (low, high) = ((low * axis.factor).log10(), (high * axis.factor).log10());
    let pad = match axis.range {
        Some(_) => 0.0,
        None => (0.06 * (high - low)).max(0.08),
    };
    let (low, high) = (low - pad, high + pad);
    let inside = |v: f64| v >= low - 1e-9 && v <= high + 1e-9;
    let stride = ((high - low) / wanted as f64).ceil().max(1.0) as i32;
    // one or two powers of ten in sight: label 1, 2 and 5 of every decade, if there is room
    let powers = high.floor() - low.ceil() + 1.0;
    let room = 3.0 * (high - low) <= wanted as f64;
    let labelled = |m: u32| m == 1 || (powers <= 2.0 && room && [2, 5].contains(&m));
    let (mut major, mut minor) = (Vec::new(), Vec::new());
    for decade in low.floor() as i32..=high.ceil() as i32 {
        for m in 1..10u32 {
            let at = f64::from(decade) + f64::from(m).log10();
            if !inside(at) {
                continue;
            }
            if labelled(m) && decade.rem_euclid(stride) == 0 {
                major.push((at, power_label(m, decade)));
            } else {
                minor.push(at);
            }
        }
    }
    if !axis.labels.is_empty() {
        let labels = axis.labels.iter().map(|v| v * axis.factor);
        major = labels.map(|v| (v.log10(), digits(v))).collect();
        minor.clear();
    }
    if stride > 2 {
        minor.retain(|v| (v - v.round()).abs() < 1e-9);
    }
    // a tick has its unit, where it has a prefix for it
    let prefixed = axis.factor == 1.0 && !axis.unit.is_empty() && axis.labels.is_empty();
    let values = major.iter().map(|(at, _)| 10f64.powf(*at));
    let prefixed = prefixed && values.clone().all(|v| (0.9e-12..1e12).contains(&v));
    let label = match prefixed {
        true => {
            let texts: Vec<String> = values.map(|v| si(rounded(v, 1), &axis.unit)).collect();
            let ticks = major.iter_mut().zip(texts);
            ticks.for_each(|((_, text), prefixed)| *text = prefixed);
            axis.label.clone()
        }
        false => label(axis, 0),
    };
    Ticks {
        label,
        range: (low, high),
        major,
        minor,
        factor: axis.factor,
        scale: Scale::Log,
    }
}

/// The power of ten (a multiple of three) that leaves tick labels of few digits.
fn power_of_ten(size: f64) -> i32 {
    match (1e-2..1e4).contains(&size) || size == 0.0 {
        true => 0,
        false => 3 * (size.log10() / 3.0).floor() as i32,
    }
}

/// 1, 2, 2.5 or 5 times a power of ten, not below `raw`.
fn round_step(raw: f64) -> f64 {
    let base = 10f64.powf(raw.log10().floor());
    let factor = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .find(|f| f * base >= raw * (1.0 - 1e-9));
    base * factor.unwrap_or(10.0)
}

fn is_quarter(step: f64) -> bool {
    let lead = step / 10f64.powf((step * 1.0000001).log10().floor());
    (lead - 2.5).abs() < 1e-6 && step < 9.9
}

fn label(axis: &Axis, power: i32) -> String {
    const PREFIXES: [&str; 7] = ["p", "n", "µ", "m", "", "k", "M"];
    let prefix = usize::try_from(power / 3 + 4).ok();
    let scale = match prefix.and_then(|place| PREFIXES.get(place)) {
        Some(prefix) if axis.factor == 1.0 && !axis.unit.is_empty() => {
            return format!("{} ({prefix}{})", axis.label, axis.unit);
        }
        _ if power == 0 => String::new(),
        _ => format!("10{}", numbers::superscript(power)),
    };
    match format!("{scale} {}", axis.unit).trim() {
        "" => axis.label.clone(),
        unit => format!("{} ({unit})", axis.label),
    }
}

fn power_label(multiple: u32, decade: i32) -> String {
    let value = f64::from(multiple) * 10f64.powi(decade);
    if (-2..=3).contains(&decade) {
        return format!("{value:.*}", (-decade).max(0) as usize);
    }
    match multiple {
        1 => format!("10{}", numbers::superscript(decade)),
        m => format!("{m}·10{}", numbers::superscript(decade)),
    }
}

/// A number with a true minus sign and no negative zero.
fn signed(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.into(),
        Some(rest) => format!("−{rest}"),
        None => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis, data: (f64, f64)) -> Vec<String> {
        let major = Ticks::new(axis, data, 5).major;
        major.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_carry_only_the_digits_of_their_step() {
        let axis = Axis::new("t", "s", 1.0).over(0.0, 0.5);
        assert_eq!(
            texts(&axis, (0.0, 0.5)),
            ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]
        );
        let axis = Axis::new("t", "s", 1.0).over(1.0, 2.25);
        assert_eq!(
            texts(&axis, (0.0, 0.0)),
            ["1.00", "1.25", "1.50", "1.75", "2.00", "2.25"]
        );
        let axis = Axis::new("e", "µm", 1e6).over(-2.5e-6, 2.5e-6);
        assert_eq!(texts(&axis, (0.0, 0.0)), ["−2", "−1", "0", "1", "2"]);
    }

    #[test]
    fn small_values_move_their_power_into_the_label() {
        for (unit, factor, label) in [
            ("m/s²", 1.0, "a (µm/s²)"),
            ("m/s²", 2.0, "a (10⁻⁶ m/s²)"),
            ("", 1.0, "a (10⁻⁶)"),
        ] {
            let range = (-2e-6 / factor, 2e-6 / factor);
            let ticks = Ticks::new(&Axis::new("a", unit, factor), range, 5);
            assert_eq!(ticks.label, label);
            assert!(ticks.major.iter().all(|(_, t)| t.chars().count() <= 4));
        }
    }

    #[test]
    fn log_axes_label_decades() {
        assert_eq!(
            texts(&Axis::new("E", "Pa", 1.0).log(), (1e8, 5e11)),
            ["100 MPa", "1 GPa", "10 GPa", "100 GPa"].map(|t| t.replace(' ', "\u{a0}"))
        );
        assert_eq!(
            texts(&Axis::new("E", "", 1.0).log(), (1e8, 1e12)),
            ["10⁸", "10⁹", "10¹⁰", "10¹¹", "10¹²"]
        );
        assert_eq!(
            texts(
                &Axis::new("c", "µm", 1e6).log().over(1e-6, 1e-5),
                (1.0, 1.0)
            ),
            ["1", "2", "5", "10"]
        );
        let elements = Axis::new("n", "", 1.0).log_at(vec![1.0, 2.0, 4.0, 16.0]);
        assert_eq!(texts(&elements, (1.0, 16.0)), ["1", "2", "4", "16"]);
    }

    #[test]
    fn categories_stand_from_the_top_down() {
        let axis = Axis::categories(vec!["one".into(), "two".into()]);
        let ticks = Ticks::new(&axis, (0.0, 9.0), 6);
        assert_eq!(ticks.range, (1.5, -0.5));
        assert_eq!(ticks.major, [(0.0, "one".into()), (1.0, "two".into())]);
        assert_eq!(ticks.place(1.0), 1.0);
    }

    #[test]
    fn degenerate_ranges_still_have_ticks() {
        assert!(texts(&Axis::new("a", "m", 1.0), (3.0, 3.0)).len() > 2);
        assert!(
            texts(
                &Axis::new("a", "m", 1.0),
                (f64::INFINITY, f64::NEG_INFINITY)
            )
            .len()
                > 2
        );
    }
}
