//! Parameter scans, one at a time around the printed and assumed values, and the numbers that are read off their runs.

use crate::ensembles::{Ensemble, EnsembleRecord};
use crate::kinematics::MechanismGeometry;
use crate::measures::Measures;
use crate::pictures::CLAIMED;
use crate::runs::{DURATION, FROM, RunPace, RunPlan};
use miette::{IntoDiagnostic, Result};
use minijinja::{Value, context};
use numbers::{digits, si};
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Time between recorded rows, a whole multiple of every step scanned \[s\].
const INTERVAL: f64 = 2e-5;
/// What is read off a run.
const READ: &str = "error_peak error_rms acceleration_peak deviation_rms force_peak force_mean contact_b1 energy_lost";
/// The list of scans.
const SCANS: &str = include_str!("../scans.toml");

/// One scanned quantity.
#[derive(Debug, Serialize, Deserialize)]
pub struct Scan {
    /// Part of the names of runs in the journal.
    pub slug: String,
    /// Heading.
    pub title: String,
    /// The runs.
    pub entries: Vec<ScanEntry>,
}

/// One run of a scan.
#[derive(Debug, Serialize, Deserialize)]
pub struct ScanEntry {
    /// The value as written in tables.
    pub label: String,
    /// Whether it is the printed or assumed value.
    pub baseline: bool,
    /// Case of Table 2.
    pub case: u32,
    /// The measures of `READ`; none of a run that failed.
    pub values: Option<Measures>,
    /// Its warnings, or why it failed.
    pub warnings: Vec<String>,
}

/// The campaign `scans`. Runs that fail are kept with their message.
///
/// # Errors
/// When the baseline scene cannot be read.
pub fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let mut scans = Vec::new();
    for (mut scan, plans) in all()? {
        let keys: Vec<usize> = (0..plans.len()).collect();
        let name = |k: &usize| format!("{} {k}", scan.slug);
        let run = |k: &usize| {
            let measured = plans[*k].run().and_then(|run| {
                let mut measures = Measures::of(&MechanismGeometry::of(&run.scene)?, &run);
                measures
                    .0
                    .retain(|name, _| READ.split(' ').any(|read| read == name));
                Ok((Some(measures), run.warnings))
            });
            Ok(measured.unwrap_or_else(|error| (None, vec![format!("{error:#}")])))
        };
        let done: Vec<(Option<Measures>, Vec<String>)> =
            journal.items(&keys, threads(), name, run)?;
        for (entry, (values, warnings)) in scan.entries.iter_mut().zip(done) {
            (entry.values, entry.warnings) = (values, warnings);
        }
        scans.push(scan);
    }
    serde_json::to_value(scans).into_diagnostic()
}

/// A scan of scans.toml.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ListedScan {
    slug: String,
    title: String,
    cases: Vec<u32>,
    values: Vec<f64>,
    unit: Option<String>,
    base: Option<f64>,
    none: Option<f64>,
    scale: Option<f64>,
    change: Option<String>,
    #[serde(default)]
    readings: Vec<(String, Vec<String>)>,
    #[serde(default)]
    bathe: bool,
}

/// All scans, their runs not yet made.
fn all() -> Result<Vec<(Scan, Vec<RunPlan>)>> {
    let mut listed: HashMap<String, Vec<ListedScan>> = toml::from_str(SCANS).into_diagnostic()?;
    let listed = listed.remove("scan").unwrap_or_default();
    Ok(listed.into_iter().map(scan).collect())
}

fn scan(list: ListedScan) -> (Scan, Vec<RunPlan>) {
    let values = || list.values.iter().copied().enumerate();
    let points = list.cases.iter();
    let points = points.flat_map(|case| values().map(|(i, at)| (*case, list.readings.get(i), at)));
    let made = points.map(|(case, reading, at)| {
        let label = match (reading, &list.unit) {
            (Some((label, _)), _) => label.clone(),
            (None, Some(unit)) => si(at, unit),
            (None, None) => digits(at),
        };
        let mut plan = RunPlan::controlled(case, INTERVAL);
        if list.bathe {
            plan.pace = RunPace::bathe(at);
        }
        // the printed or assumed value is an override, too, so that its label is right whatever the scene says
        let scaled = format!("{:?}", list.scale.unwrap_or(1.0) * at);
        let change = list.change.as_ref().filter(|_| list.none != Some(at));
        let change = change.map(|change| change.replace("{}", &scaled));
        let read = reading.map(|(_, changes)| changes.as_slice());
        plan.overrides = change.into_iter().collect();
        plan.overrides.extend_from_slice(read.unwrap_or_default());
        let entry = ScanEntry {
            label,
            baseline: list.base == Some(at),
            case,
            values: None,
            warnings: Vec::new(),
        };
        (entry, plan)
    });
    let (entries, plans) = made.unzip();
    let scan = Scan {
        slug: list.slug,
        title: list.title,
        entries,
    };
    (scan, plans)
}

/// The values of the template.
pub fn values(scans: &[Scan], record: &EnsembleRecord) -> Value {
    let scatter = [3, 4].map(|case| scatter(record, case));
    context! { scans, scatter, claimed => CLAIMED, duration => DURATION, from => FROM }
}

/// By how much two single runs of a case differ at the most with a probability of 95 %, over the mean, from all starts together:
/// t s sqrt(2), of which the half width of the mean is t s/sqrt(n).
fn scatter(record: &EnsembleRecord, case: u32) -> Value {
    let ensemble = Ensemble::together(&record.sizes(case));
    let runs = ensemble.values("error_peak").len();
    let limit = |name: &str| {
        let mean = ensemble.mean(name);
        mean.half * (2.0 * runs as f64).sqrt() / mean.mean.abs()
    };
    let error = ["error_peak", "error_rms"].map(limit);
    let other = ["deviation_rms", "force_peak", "contact_b1"].map(limit);
    context! { case, runs, limits => [&error[..], &other].concat() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_all_scans_are_read() -> Result<()> {
        for (scan, plans) in all()? {
            plans.iter().try_for_each(|plan| plan.scene().map(drop))?;
            // the printed or assumed value is among them, once a case
            let of_case = |case| {
                let of_case = scan.entries.iter().filter(move |e| e.case == case);
                of_case.filter(|e| e.baseline).count()
            };
            let once = scan.entries.iter().all(|e| of_case(e.case) == 1);
            assert!(scan.slug == "step" || once, "{}", scan.slug);
        }
        Ok(())
    }
}
