//! A parameter: the fields of the scene that it sets, and the values that it takes.

use super::FieldValue;
use serde::Deserialize;

/// `[parameters.NAME]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepParameter {
    /// What it sets.
    pub fields: Vec<ParameterField>,
    /// Its values; or
    #[serde(default)]
    pub values: Vec<FieldValue>,
    /// the least and
    pub from: Option<FieldValue>,
    /// the greatest of them,
    pub to: Option<FieldValue>,
    /// how many a grid has
    pub count: Option<usize>,
    /// and how they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
    /// True where all values of the range are whole numbers.
    #[serde(default)]
    pub whole: bool,
    /// Its unit in tables and pictures.
    #[serde(default)]
    pub unit: String,
}

/// How the values of a range are spaced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

/// A field that a parameter sets.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum ParameterField {
    /// To the value of the parameter.
    Same(String),
    /// To factor x^power of its value x.
    Scaled(ScaledField),
}

/// A field that follows a parameter, such as the duration of a motion that follows its frequency.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaledField {
    /// Path of the field.
    pub path: String,
    /// The value is multiplied by this ...
    #[serde(default = "one")]
    pub factor: f64,
    /// ... after it was raised to this power.
    #[serde(default = "one")]
    pub power: f64,
}

impl ParameterField {
    /// Its path.
    pub fn path(&self) -> &str {
        match self {
            ParameterField::Same(path) => path,
            ParameterField::Scaled(scaled) => &scaled.path,
        }
    }
}

fn one() -> f64 {
    1.0
}

impl SweepParameter {
    /// Checks what can be seen without the scene; `needs_count` is true where the values of a range are counted.
    ///
    /// # Errors
    /// What is wrong, without the name of the parameter.
    pub(super) fn check(&self, needs_count: bool) -> Result<(), String> {
        if self.fields.is_empty() {
            return Err("needs at least one path in `fields`".to_owned());
        }
        let finite = |value: &FieldValue| value.number().is_none_or(f64::is_finite);
        let scales = self.fields.iter().filter_map(|field| match field {
            ParameterField::Same(_) => None,
            ParameterField::Scaled(scaled) => Some([scaled.factor, scaled.power]),
        });
        if !self.values.iter().all(finite) || !scales.flatten().all(f64::is_finite) {
            return Err("has a number that is not finite".to_owned());
        }
        if self.spacing == Spacing::Log && self.values.iter().any(|v| v.number() <= Some(0.0)) {
            return Err("has log spacing, so its values must be numbers above 0".to_owned());
        }
        let ends = [&self.from, &self.to];
        let has_range = ends.iter().any(|end| end.is_some());
        if self.values.is_empty() != has_range {
            return Err("needs either `values` or `from` and `to`".to_owned());
        }
        let scaled = |field: &ParameterField| matches!(field, ParameterField::Scaled(_));
        let words = self.values.iter().any(|value| value.number().is_none());
        if words && self.fields.iter().any(scaled) {
            return Err("has words as values, which cannot be scaled".to_owned());
        }
        if !has_range && self.whole {
            return Err("has `values`, so it needs no `whole`".to_owned());
        }
        if !has_range {
            return match self.count {
                Some(_) => Err("has `values`, so it needs no `count`".to_owned()),
                None => Ok(()),
            };
        }
        let (low, high) = self.range().ok_or("needs numbers in `from` and `to`")?;
        if !(low < high && low.is_finite() && high.is_finite()) {
            return Err(format!("needs `from` below `to`, not {low} and {high}"));
        }
        if self.spacing == Spacing::Log && low <= 0.0 {
            return Err(format!(
                "has log spacing, so `from` must be above 0, not {low}"
            ));
        }
        if self.whole && (low.fract() != 0.0 || high.fract() != 0.0) {
            return Err(format!(
                "is whole, so `from` and `to` must be, not {low} and {high}"
            ));
        }
        if self.whole && self.count.is_some_and(|n| n as f64 > high - low + 1.0) {
            return Err("has a `count` above the number of whole numbers in its range".to_owned());
        }
        match self.count {
            None if needs_count => Err("needs a `count` of 2 at least in a grid".to_owned()),
            Some(_) if !needs_count => Err("needs no `count`, which only a grid has".to_owned()),
            Some(0 | 1) => Err("needs a `count` of 2 at least".to_owned()),
            _ => Ok(()),
        }
    }

    /// The ends of its range.
    pub fn range(&self) -> Option<(f64, f64)> {
        Some((self.from.as_ref()?.number()?, self.to.as_ref()?.number()?))
    }

    /// How many values a grid takes.
    pub fn levels(&self) -> usize {
        match self.values.len() {
            0 => self.count.unwrap_or(0),
            n => n,
        }
    }

    /// The k-th value of a grid.
    pub fn level(&self, k: usize) -> FieldValue {
        match self.values.get(k) {
            Some(value) => value.clone(),
            None => {
                let (low, high) = self
                    .range()
                    .expect("a parameter without values has a range");
                let u = k as f64 / (self.levels() - 1) as f64;
                let value = self.between(u, low, high);
                match self.whole {
                    true => FieldValue::Whole(value.round() as i64),
                    false => FieldValue::Number(value),
                }
            }
        }
    }

    /// The number at u between two others; both ends are exact.
    fn between(&self, u: f64, low: f64, high: f64) -> f64 {
        match self.spacing {
            _ if u <= 0.0 => low,
            _ if u >= 1.0 => high,
            Spacing::Linear => low + u * (high - low),
            Spacing::Log => low * (high / low).powf(u),
        }
    }

    /// The value at u of its range, 0 <= u <= 1. Both ends are exact; a list of values is divided into equal parts, and so is a
    /// range of whole numbers.
    pub fn at(&self, u: f64) -> FieldValue {
        let Some((low, high)) = self.range() else {
            let count = self.values.len();
            let place = (u * count as f64) as usize;
            return self.values[place.min(count - 1)].clone();
        };
        match self.whole {
            true => {
                let value = self.between(u, low, high + 1.0).min(high);
                FieldValue::Whole(value.floor() as i64)
            }
            false => FieldValue::Number(self.between(u, low, high)),
        }
    }

    /// Changes `path=value` of the scene for a value.
    pub fn overrides(&self, value: &FieldValue) -> impl Iterator<Item = String> {
        self.fields.iter().map(move |field| match (field, value) {
            (ParameterField::Same(path), FieldValue::Word(word)) => {
                format!("{path}={}", toml::Value::from(word.as_str()))
            }
            (ParameterField::Same(path), FieldValue::Number(x)) => format!("{path}={x:?}"),
            (ParameterField::Same(path), other) => format!("{path}={other}"),
            (ParameterField::Scaled(scaled), value) => {
                // words were refused when the study was read
                let x = value.number().unwrap_or(f64::NAN);
                let ScaledField {
                    path,
                    factor,
                    power,
                } = scaled;
                format!("{path}={:?}", factor * x.powf(*power))
            }
        })
    }
}
