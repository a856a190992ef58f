//! Tables and pictures of a sweep whose runs are all made.
//!
//! | file | content |
//! |---|---|
//! | `sweep.csv` and, with the feature `parquet`, `sweep.parquet` | one row a run, in the order of their numbers |
//! | `points.csv` | with several starts: mean, deviation and interval of every measure at every point |
//! | `envelopes.csv` | the least, mean and largest course of all runs |
//! | `sweep.svg` and, with the feature `png`, `sweep.png` | the pictures |
//! | `sweep.md` | pictures, extremes, faults and warnings as a page |
//! | `times.csv` | processor time and time on the clock of every run |
//! | `sweep.json` | the study in numbers: runs by status, units, indices, the crossing of a bisection |
//!
//! All but `times.csv` depend on the rows alone: their bytes are the same whatever the threads, shards and interruptions.
//! `sweep.json` comes last: without it there is no result.

use super::columns::{Column, ColumnType, SweepCell};
use super::csv_table::CsvTable;
use super::page::page;
#[cfg(feature = "parquet")]
use super::parquet_table::ParquetTable;
use super::pictures::figure;
use super::store::{kind, timings};
use super::{
    Crossing, EnsembleMean, RunStatus, SobolIndices, Store, Sweep, SweepError, SweepRow,
    sobol_indices,
};
use crate::pictures;
use crate::study_file::StudyError;
use folder::{add, json};
use indexmap::IndexMap;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// Names of the files.
pub const FILES: [&str; 9] = [
    "sweep.json",
    "sweep.csv",
    "sweep.parquet",
    "points.csv",
    "envelopes.csv",
    "sweep.svg",
    "sweep.png",
    "sweep.md",
    "times.csv",
];

/// Runs whose absence a message names.
const NAMED: usize = 5;

/// The result of a sweep without its rows.
#[derive(Debug, Serialize)]
pub struct Merged {
    /// What is asked.
    pub title: String,
    /// The scene's file.
    pub scene: String,
    /// See [`Sweep::digest`].
    pub sweep: String,
    /// Version of the program.
    pub version: String,
    /// Number of runs.
    pub runs: usize,
    /// How many ended in each way.
    pub status: BTreeMap<&'static str, usize>,
    /// Runs with warnings.
    pub warned: usize,
    /// Number of rows by program, where more than one has made them: see [`SweepRow::program`].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub programs: BTreeMap<String, usize>,
    /// Unit of every column that has one.
    pub units: IndexMap<String, String>,
    /// Least and largest value of every measure, and the runs that have them.
    pub extremes: IndexMap<String, MeasureExtremes>,
    /// Sobol indices of every measure by parameter.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    pub indices: IndexMap<String, IndicesOfMeasure>,
    /// Where a bisection has led.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crossing: Option<Crossing>,
    /// Why a bisection has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_answer: Option<String>,
    /// The text of `sweep.md`.
    #[serde(skip)]
    pub page: String,
}

/// Least and largest value of a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasureExtremes {
    /// Least value and its run.
    pub least: (f64, usize),
    /// Largest value and its run.
    pub largest: (f64, usize),
}

/// The influence of the parameters on a measure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IndicesOfMeasure {
    /// Samples whose runs all have the measure.
    pub samples: usize,
    /// By parameter.
    pub parameters: IndexMap<String, SobolIndices>,
}

/// What pictures and tables of points need of every run.
#[derive(Debug)]
pub(super) struct Points {
    /// Values of the parameters at every point.
    pub values: Vec<Vec<super::FieldValue>>,
    /// By measure and point: the mean over the starts that have the measure.
    pub means: Vec<Vec<Option<EnsembleMean>>>,
    /// By envelope.
    pub envelopes: Vec<MeanEnvelope>,
    /// Numbers of runs without results, with their errors.
    pub faults: Vec<(usize, String)>,
    /// Warnings of all runs, each kind once: the number of runs and the first of them.
    pub warnings: IndexMap<String, (usize, String)>,
    /// True where a run had contacts.
    pub contacts: bool,
    /// The longest time that a run has reached \[s\], and whether all complete runs have.
    pub duration: (f64, bool),
}

/// The envelopes of all runs together, part by part.
#[derive(Debug, Clone, Default)]
pub(super) struct MeanEnvelope {
    /// Least value, sums of the least and largest values, largest value, runs that have the part.
    pub parts: Vec<EnvelopePart>,
}

/// A part of an envelope.
#[derive(Debug, Clone, Copy)]
pub(super) struct EnvelopePart {
    pub least: f64,
    sum_low: f64,
    sum_high: f64,
    pub largest: f64,
    pub runs: usize,
}

impl EnvelopePart {
    const NONE: EnvelopePart = EnvelopePart {
        least: f64::INFINITY,
        sum_low: 0.0,
        sum_high: 0.0,
        largest: f64::NEG_INFINITY,
        runs: 0,
    };

    /// Means of the least and of the largest value of a run.
    pub fn means(&self) -> (f64, f64) {
        let n = self.runs as f64;
        (self.sum_low / n, self.sum_high / n)
    }
}

/// Writes all files.
///
/// # Errors
/// Runs that have not been made; rows that cannot be read, or that somebody else has changed; files that cannot be written; and, after
/// all files are written, a bisection without an answer.
pub fn merge(sweep: &Sweep, store: &Store, folder: &Path) -> Result<Merged, SweepError> {
    let runs = all_runs(sweep, store)?;
    let columns = sweep.columns();
    let failed = |e: &dyn std::fmt::Display| io::Error::other(e.to_string());
    let mut csv = CsvTable::new(&columns).map_err(|e| failed(&e))?;
    #[cfg(feature = "parquet")]
    let mut parquet = {
        let notes = [
            ("title", sweep.study.title.as_str()),
            ("sweep", sweep.digest()),
        ];
        ParquetTable::new(&columns, &notes).map_err(|e| failed(&e))?
    };
    let mut gathered = Gathered::new(sweep);
    for run in 0..runs {
        let row = store.row(run)?;
        let cells = sweep.cells(&columns, &row);
        csv.row(&cells).map_err(|e| failed(&e))?;
        #[cfg(feature = "parquet")]
        parquet.row(cells).map_err(|e| failed(&e))?;
        gathered.add(row);
    }
    let (mut merged, points) = gathered.finish(sweep, store, &columns)?;
    let mut files = vec![("sweep.csv", csv.finish()?)];
    #[cfg(feature = "parquet")]
    files.push(("sweep.parquet", parquet.finish().map_err(|e| failed(&e))?));
    if sweep.study.starts_of_a_point() > 1 {
        let table = point_table(sweep, &columns, &points);
        files.push(("points.csv", table.map_err(|e| failed(&e))?));
    }
    if !points.envelopes.is_empty() {
        let table = envelope_table(sweep, &points);
        files.push(("envelopes.csv", table.map_err(|e| failed(&e))?));
    }
    let (svg, png) = pictures(&figure(sweep, &merged, &points))?;
    files.push(("sweep.svg", svg));
    files.extend(png.map(|png| ("sweep.png", png)));
    merged.page = page(sweep, &merged, &points);
    files.push(("sweep.md", merged.page.clone().into_bytes()));
    files.push(("times.csv", time_table(folder)?));
    files.push((FILES[0], json(&merged)?));
    store.refuse_changed()?;
    add(folder, &kind(), &files)?;
    match merged.no_answer {
        Some(why) => Err(SweepError::NoAnswer(why)),
        None => Ok(merged),
    }
}

/// The number of runs, which must all be there.
fn all_runs(sweep: &Sweep, store: &Store) -> Result<usize, SweepError> {
    let pending = sweep.pending(store, super::Shard::WHOLE)?;
    let runs = sweep.runs().unwrap_or(store.len());
    if pending.is_empty() {
        return Ok(runs);
    }
    let named = pending.iter().take(NAMED).map(usize::to_string);
    let named = named.collect::<Vec<_>>().join(", ");
    let more = if pending.len() > NAMED { ", ..." } else { "" };
    let (count, them) = match pending.len() {
        1 => ("1 run has".to_owned(), "it"),
        n => (format!("{n} runs have"), "them"),
    };
    let message = format!(
        "{count} not been made: {named}{more}; `looselink sweep` without --merge makes {them}"
    );
    Err(StudyError::Plain(message).into())
}

/// What is gathered while the rows go by.
struct Gathered {
    status: BTreeMap<&'static str, usize>,
    warned: usize,
    programs: BTreeMap<String, usize>,
    extremes: Vec<Option<MeasureExtremes>>,
    /// By measure and point: values of the starts.
    values: Vec<Vec<Vec<f64>>>,
    starts: usize,
    points: Points,
}

impl Gathered {
    fn new(sweep: &Sweep) -> Gathered {
        let measures = sweep.study.measures.len();
        let envelopes = sweep.study.envelopes.values().map(|plan| MeanEnvelope {
            parts: vec![EnvelopePart::NONE; plan.parts],
        });
        Gathered {
            status: [RunStatus::Complete, RunStatus::Failed, RunStatus::Refused]
                .map(|status| (status.name(), 0))
                .into(),
            warned: 0,
            programs: BTreeMap::new(),
            extremes: vec![None; measures],
            values: vec![Vec::new(); measures],
            starts: sweep.study.starts_of_a_point(),
            points: Points {
                values: Vec::new(),
                means: Vec::new(),
                envelopes: envelopes.collect(),
                faults: Vec::new(),
                warnings: IndexMap::new(),
                contacts: false,
                duration: (0.0, true),
            },
        }
    }

    fn add(&mut self, row: SweepRow) {
        *self.status.entry(row.status.name()).or_default() += 1;
        self.warned += usize::from(!row.warnings.is_empty());
        *self.programs.entry(row.program).or_default() += 1;
        let points = &mut self.points;
        for warning in row.warnings {
            let first = || (0, format!("run {}: {warning}", row.run));
            points
                .warnings
                .entry(kind_of(&warning))
                .or_insert_with(first)
                .0 += 1;
        }
        if let Some(error) = row.error {
            points.faults.push((row.run, error));
        }
        points.contacts |= row.onsets > 0;
        if row.status == RunStatus::Complete {
            let (longest, same) = &mut points.duration;
            *same &= *longest == 0.0 || *longest == row.t;
            *longest = longest.max(row.t);
        }
        let begins = row.start == 0;
        if begins {
            points.values.push(row.values);
        }
        let places = self.extremes.iter_mut().zip(&mut self.values);
        for ((extremes, values), value) in places.zip(&row.measures) {
            if begins {
                values.push(Vec::new());
            }
            let Some(value) = *value else { continue };
            values.last_mut().expect("start 0 comes first").push(value);
            let here = (value, row.run);
            let extremes = extremes.get_or_insert(MeasureExtremes {
                least: here,
                largest: here,
            });
            if value < extremes.least.0 {
                extremes.least = here;
            }
            if value > extremes.largest.0 {
                extremes.largest = here;
            }
        }
        for (sum, envelope) in points.envelopes.iter_mut().zip(&row.envelopes) {
            let ends = envelope.low.iter().zip(&envelope.high);
            for (part, (low, high)) in sum.parts.iter_mut().zip(ends) {
                if let (Some(low), Some(high)) = (low, high) {
                    part.least = part.least.min(*low);
                    part.largest = part.largest.max(*high);
                    part.sum_low += low;
                    part.sum_high += high;
                    part.runs += 1;
                }
            }
        }
    }

    fn finish(
        self,
        sweep: &Sweep,
        store: &Store,
        columns: &[Column],
    ) -> Result<(Merged, Points), SweepError> {
        let study = &sweep.study;
        let mut points = self.points;
        let names = study.measures.keys();
        let means = self.values.iter().map(|points| {
            let means = points.iter().map(|values| EnsembleMean::of(values));
            means.collect()
        });
        points.means = means.collect();
        let mut indices = IndexMap::new();
        if study.design == super::design::DesignKind::Sensitivity {
            for (name, means) in names.clone().zip(&points.means) {
                // a point counts only if all of its starts have the measure
                let whole = |mean: &EnsembleMean| mean.count == self.starts;
                let values = means.iter().map(|m| m.filter(whole).map(|m| m.mean));
                let values: Vec<Option<f64>> = values.collect();
                let d = study.parameters.len();
                if let Some((found, samples)) = sobol_indices(&values, d, study.seed) {
                    let parameters = study.parameters.keys().cloned().zip(found).collect();
                    let of = IndicesOfMeasure {
                        samples,
                        parameters,
                    };
                    indices.insert(name.clone(), of);
                }
            }
        }
        let units = columns.iter().filter(|column| !column.unit.is_empty());
        let extremes = names.zip(self.extremes);
        let extremes = extremes.filter_map(|(name, e)| Some((name.clone(), e?)));
        let (crossing, no_answer) = match sweep.crossing(store)? {
            Some(Ok(crossing)) => (Some(crossing), None),
            Some(Err(why)) => (None, Some(why)),
            None => (None, None),
        };
        let merged = Merged {
            title: study.title.clone(),
            scene: study
                .scene
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            sweep: sweep.digest().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            runs: self.status.values().sum(),
            status: self.status,
            warned: self.warned,
            programs: Some(self.programs)
                .filter(|all| all.len() > 1)
                .unwrap_or_default(),
            units: units.map(|c| (c.name.clone(), c.unit.clone())).collect(),
            extremes: extremes.collect(),
            indices,
            crossing,
            no_answer,
            page: String::new(),
        };
        Ok((merged, points))
    }
}

/// A warning without its numbers: warnings of different runs that say the same are alike.
fn kind_of(warning: &str) -> String {
    let digit = |c: char| c.is_ascii_digit() || c == '.' || c == '-' || c == 'e';
    // what stands in brackets are examples
    let text = warning.split(" (").next().unwrap_or(warning);
    let words = text.split(' ').filter(|word| {
        let mut digits = word.trim_end_matches([',', ':', ';', '%']).chars();
        !digits.clone().any(|c| c.is_ascii_digit()) || !digits.all(digit)
    });
    words.collect::<Vec<_>>().join(" ")
}

/// One row a point: parameters, then number of runs, mean, deviation and interval of every measure.
fn point_table(sweep: &Sweep, all: &[Column], points: &Points) -> csv::Result<Vec<u8>> {
    let parameters = 3..3 + sweep.study.parameters.len();
    let mut columns = vec![all[1].clone()];
    columns.extend_from_slice(&all[parameters]);
    let number = |name: String, unit: &str, takes| Column {
        name,
        unit: unit.to_owned(),
        takes,
    };
    for (name, unit) in sweep.study.measures.keys().zip(sweep.units()) {
        columns.push(number(format!("{name} runs"), "", ColumnType::Whole));
        for part in ["mean", "deviation", "low", "high"] {
            columns.push(number(format!("{name} {part}"), unit, ColumnType::Number));
        }
    }
    let mut table = CsvTable::new(&columns)?;
    for (point, values) in points.values.iter().enumerate() {
        let mut cells = vec![SweepCell::Whole(point as i64)];
        cells.extend(values.iter().map(|value| match value {
            super::FieldValue::Whole(n) => SweepCell::Whole(*n),
            super::FieldValue::Number(x) => SweepCell::Number(Some(*x)),
            other => SweepCell::Text(other.to_string()),
        }));
        for means in &points.means {
            let mean = means[point];
            let count = mean.map_or(0, |mean| mean.count);
            cells.push(SweepCell::Whole(count as i64));
            cells.push(SweepCell::Number(mean.map(|mean| mean.mean)));
            cells.push(SweepCell::Number(mean.and_then(|mean| mean.deviation)));
            let ends = mean.filter(|mean| mean.half_width.is_some());
            let ends = ends.map(|mean| mean.interval());
            cells.push(SweepCell::Number(ends.map(|ends| ends.0)));
            cells.push(SweepCell::Number(ends.map(|ends| ends.1)));
        }
        table.row(&cells)?;
    }
    Ok(table.finish()?)
}

/// One row a part of time.
fn envelope_table(sweep: &Sweep, points: &Points) -> csv::Result<Vec<u8>> {
    let text = |name: &str, unit: &str, takes| Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        takes,
    };
    let columns = [
        text("envelope", "", ColumnType::Text),
        text("unit", "", ColumnType::Text),
        text("part", "", ColumnType::Whole),
        text("from", "1", ColumnType::Number),
        text("to", "1", ColumnType::Number),
        text("runs", "", ColumnType::Whole),
        text("least", "", ColumnType::Number),
        text("mean_low", "", ColumnType::Number),
        text("mean_high", "", ColumnType::Number),
        text("largest", "", ColumnType::Number),
    ];
    let mut table = CsvTable::new(&columns)?;
    let names = sweep.study.envelopes.keys().zip(sweep.envelope_units());
    for ((name, unit), envelope) in names.zip(&points.envelopes) {
        let count = envelope.parts.len() as f64;
        for (k, part) in envelope.parts.iter().enumerate() {
            let (low, high) = part.means();
            let number = |x: f64| SweepCell::Number(Some(x).filter(|_| part.runs > 0));
            table.row(&[
                SweepCell::Text(name.clone()),
                SweepCell::Text(unit.clone()),
                SweepCell::Whole(k as i64),
                SweepCell::Number(Some(k as f64 / count)),
                SweepCell::Number(Some((k + 1) as f64 / count)),
                SweepCell::Whole(part.runs as i64),
                number(part.least),
                number(low),
                number(high),
                number(part.largest),
            ])?;
        }
    }
    Ok(table.finish()?)
}

/// One row a run.
fn time_table(folder: &Path) -> Result<Vec<u8>, SweepError> {
    let mut text = "run,processor time [s],time on the clock [s]\n".to_owned();
    for timing in timings(folder)? {
        text += &format!("{},{:?},{:?}\n", timing.run, timing.cpu, timing.wall);
    }
    Ok(text.into_bytes())
}

#[cfg(test)]
mod tests {
    use super::kind_of;

    #[test]
    fn warnings_are_alike_without_their_numbers() {
        let of = "2 of 12 contacts lasted fewer than four steps: reduce integrator.step";
        let as_many = "3 of 4 contacts lasted fewer than four steps: reduce integrator.step";
        assert_eq!(kind_of(of), kind_of(as_many));
        let halved = |more| kind_of(&format!("steps that failed and were halved: 2{more}"));
        assert_eq!(halved(""), halved(" (1 of them for link1.node0.slope.x)"));
        let joint = "the estimated error of B1 is 1.2e-5 m, 3 %";
        assert_eq!(kind_of(joint), "the estimated error of B1 is m, %");
    }
}
