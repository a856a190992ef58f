//! The columns of the table of a sweep.

use super::{FieldValue, Sweep, SweepRow};
use looselink::record::Ledger;

/// Columns that every table has.
pub const OWN: [&str; 15] = [
    "run",
    "point",
    "start",
    "status",
    "t",
    "steps",
    "onsets",
    "energy.work",
    "energy.contact_dissipated",
    "energy.friction_dissipated",
    "energy.damping_dissipated",
    "energy.clamp",
    "energy.numerical",
    "warnings",
    "fault",
];

/// How an energy is read from a ledger.
type EnergyOf = fn(&Ledger) -> f64;

/// Energies at the end of a run \[J\], as in [`Ledger`].
pub const ENERGIES: [(&str, EnergyOf); 6] = [
    ("energy.work", |l| l.work),
    ("energy.contact_dissipated", |l| l.contact_dissipated),
    ("energy.friction_dissipated", |l| l.friction_dissipated),
    ("energy.damping_dissipated", |l| l.damping_dissipated),
    ("energy.clamp", |l| l.clamp),
    ("energy.numerical", |l| l.numerical),
];

/// What stands in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnType {
    /// A whole number.
    Whole,
    /// A number.
    Number,
    /// A text.
    Text,
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its unit; `1` for pure numbers, empty for texts and numbers that count.
    pub unit: String,
    /// What stands in it.
    pub takes: ColumnType,
}

impl Column {
    fn new(name: &str, unit: &str, takes: ColumnType) -> Column {
        Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            takes,
        }
    }

    /// Name and unit, as above a column of a CSV file.
    pub fn head(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}

/// A cell of the table.
#[derive(Debug, Clone, PartialEq)]
pub enum SweepCell {
    /// A whole number.
    Whole(i64),
    /// A number; none where a run has none.
    Number(Option<f64>),
    /// A text, empty for none.
    Text(String),
}

impl Sweep {
    /// All columns, in their order: run, parameters, how it ended, measures, energies, work, warnings.
    pub fn columns(&self) -> Vec<Column> {
        let whole = |name| Column::new(name, "", ColumnType::Whole);
        let mut columns = vec![whole("run"), whole("point"), whole("start")];
        for (name, parameter) in &self.study.parameters {
            let examples = [parameter.at(0.0), parameter.at(1.0)];
            let numbers = parameter.values.iter().chain(&examples);
            let takes = match numbers.clone().all(|value| value.number().is_some()) {
                false => ColumnType::Text,
                true if numbers.clone().all(|v| matches!(v, FieldValue::Whole(_))) => {
                    ColumnType::Whole
                }
                true => ColumnType::Number,
            };
            columns.push(Column::new(name, &parameter.unit, takes));
        }
        columns.push(Column::new("status", "", ColumnType::Text));
        columns.push(Column::new("t", "s", ColumnType::Number));
        for (name, unit) in self.study.measures.keys().zip(self.units()) {
            columns.push(Column::new(name, unit, ColumnType::Number));
        }
        let energies = ENERGIES.iter();
        columns.extend(energies.map(|(name, _)| Column::new(name, "J", ColumnType::Number)));
        columns.extend([whole("steps"), whole("onsets")]);
        columns.extend(["warnings", "fault"].map(|name| Column::new(name, "", ColumnType::Text)));
        columns
    }

    /// The cells of a row in the order of `columns`, which are those of [`Sweep::columns`].
    pub fn cells(&self, columns: &[Column], row: &SweepRow) -> Vec<SweepCell> {
        let whole = |n: usize| SweepCell::Whole(n as i64);
        let point = row.run / self.study.starts_of_a_point();
        let mut cells = vec![whole(row.run), whole(point), whole(row.start)];
        for (value, column) in row.values.iter().zip(&columns[3..]) {
            cells.push(match (value, column.takes) {
                (FieldValue::Whole(n), ColumnType::Whole) => SweepCell::Whole(*n),
                (value, ColumnType::Text) => SweepCell::Text(value.to_string()),
                (value, _) => SweepCell::Number(value.number()),
            });
        }
        cells.push(SweepCell::Text(row.status.name().to_owned()));
        cells.push(SweepCell::Number(Some(row.t)));
        cells.extend(row.measures.iter().map(|value| SweepCell::Number(*value)));
        let energy = |k: usize| SweepCell::Number(row.energies.and_then(|energies| energies[k]));
        cells.extend((0..ENERGIES.len()).map(energy));
        cells.extend([row.steps, row.onsets].map(|n| SweepCell::Whole(n as i64)));
        cells.push(SweepCell::Text(row.warnings.join("; ")));
        cells.push(SweepCell::Text(row.error.clone().unwrap_or_default()));
        cells
    }
}
