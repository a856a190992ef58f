//! Parameter scans, one at a time around the printed and assumed values, and the numbers that are read off their runs.

use crate::kinematics::MechanismGeometry;
use crate::measures::Measures;
use crate::runs::{RunPace, RunPlan, causes};
use miette::{IntoDiagnostic, Result};
use numbers::{digits, si};
use plot::Axis;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use serde_json::Value;
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
    /// Part of the names of files.
    pub slug: String,
    /// Heading.
    pub title: String,
    /// Horizontal axis of the plots.
    pub axis: Axis,
    /// The runs.
    pub entries: Vec<ScanEntry>,
}

/// One run of a scan.
#[derive(Debug, Serialize, Deserialize)]
pub struct ScanEntry {
    /// The value as written in tables.
    pub label: String,
    /// Its place on the axis.
    pub at: f64,
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
pub fn measure(journal: &Journal) -> Result<Value> {
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
            Ok(measured.unwrap_or_else(|error| (None, vec![causes(&error)])))
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
    axis: (String, String, f64),
    #[serde(default)]
    linear: bool,
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
pub fn all() -> Result<Vec<(Scan, Vec<RunPlan>)>> {
    let mut listed: HashMap<String, Vec<ListedScan>> = toml::from_str(SCANS).into_diagnostic()?;
    let listed = listed.remove("scan").unwrap_or_default();
    Ok(listed.into_iter().map(scan).collect())
}

fn scan(list: ListedScan) -> (Scan, Vec<RunPlan>) {
    let (mut entries, mut plans) = (Vec::new(), Vec::new());
    for case in &list.cases {
        for (i, at) in list.values.iter().copied().enumerate() {
            let reading = list.readings.get(i);
            let label = match (reading, &list.unit) {
                (Some((label, _)), _) => label.clone(),
                (None, Some(unit)) => si(at, unit),
                (None, None) => digits(at),
            };
            let mut plan = RunPlan::controlled(*case, INTERVAL);
            if list.bathe {
                plan.pace = RunPace::bathe(at);
            }
            // the printed or assumed value is an override, too, so that its label is right whatever the scene says
            let scaled = format!("{:?}", list.scale.unwrap_or(1.0) * at);
            let change = list.change.as_ref().filter(|_| list.none != Some(at));
            plan.overrides
                .extend(change.map(|change| change.replace("{}", &scaled)));
            plan.overrides
                .extend(reading.iter().flat_map(|(_, changes)| changes.clone()));
            plans.push(plan);
            entries.push(ScanEntry {
                label,
                at,
                baseline: list.base == Some(at),
                case: *case,
                values: None,
                warnings: Vec::new(),
            });
        }
    }
    let (label, unit, factor) = &list.axis;
    let axis = Axis::new(label, unit, *factor);
    let scan = Scan {
        slug: list.slug,
        title: list.title,
        axis: if list.linear { axis } else { axis.log() },
        entries,
    };
    (scan, plans)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_all_scans_are_read() -> Result<()> {
        for (scan, plans) in all()? {
            plans.iter().try_for_each(|plan| plan.scene().map(drop))?;
            // the printed or assumed value is among them, once a case
            let at = |x: &f64| scan.entries.iter().filter(|e| e.at == *x).count();
            let baselines = scan.entries.iter().filter(|e| e.baseline).count();
            let cases = at(&scan.entries[0].at);
            assert!(scan.slug == "step" || baselines == cases, "{}", scan.slug);
        }
        Ok(())
    }
}
