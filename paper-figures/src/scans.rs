//! Makes the parameter scans and reads off the numbers that are compared.

use crate::campaign::{DURATION, FROM, controlled};
use crate::kinematics::MechanismGeometry;
use crate::measures::{deviation, energy_lost};
use crate::runs::{CaseRecording, RunPlan, causes, each};
use crate::scans_list::{INTERVAL, all};
use crate::signal::{fraction, mean, peak, rms};
use miette::Result;
use plot::Axis;
use std::cmp::Reverse;
use std::collections::HashMap;

/// One scanned quantity.
pub struct Scan {
    /// Part of the file names.
    pub slug: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Horizontal axis of the plots.
    pub axis: Axis,
    /// The runs.
    pub entries: Vec<ScanEntry>,
}

/// One run of a scan.
pub struct ScanEntry {
    /// The value as written in tables.
    pub label: String,
    /// Its place on the axis.
    pub at: f64,
    /// Whether it is the printed or assumed value.
    pub baseline: bool,
    /// The run.
    pub plan: RunPlan,
    /// What came out, or why it failed.
    pub outcome: Result<Values, String>,
}

/// What is read off a run, over the last two cycles.
#[derive(Debug, Clone)]
pub struct Values {
    /// Largest |e_x| \[m\].
    pub error_peak: f64,
    /// Rms of e_x \[m\].
    pub error_rms: f64,
    /// Largest |acceleration along x| \[m/s2\].
    pub acceleration_peak: f64,
    /// Rms deviation of that acceleration from the ideal one \[m/s2\].
    pub deviation_rms: f64,
    /// Largest force in B1 \[N\].
    pub force_peak: f64,
    /// Mean force in B1 \[N\].
    pub force_mean: f64,
    /// Fraction of the time B1 is in contact; none for ideal joints.
    pub contact: Option<f64>,
    /// Energy that the integrator lost or gained, over that dissipated in contacts or, without them, over the largest
    /// elastic energy.
    pub energy_lost: f64,
    /// What the run warns of.
    pub warnings: Vec<String>,
}

impl Values {
    fn of(recording: &CaseRecording) -> Result<Values> {
        let geometry = MechanismGeometry::of(&recording.scene)?;
        let between = |name: &str| recording.between(name, FROM, DURATION);
        let (error, force) = (between("error.x").1, between("B1.force").1);
        Ok(Values {
            error_peak: peak(error),
            error_rms: rms(error),
            acceleration_peak: peak(between("platform.ax").1),
            deviation_rms: rms(&deviation(&geometry, recording, FROM, DURATION)),
            force_peak: peak(force),
            force_mean: mean(force),
            contact: (recording.plan.case >= 3)
                .then(|| fraction(between("B1.penetration").1, |d| d > 0.0)),
            energy_lost: energy_lost(recording),
            warnings: recording.warnings.clone(),
        })
    }
}

/// Makes all scans.
///
/// # Errors
/// When the baseline scene cannot be read; runs that fail are kept with their message.
pub fn run() -> Result<Vec<Scan>> {
    let geometry = MechanismGeometry::of(&controlled(3, INTERVAL).scene()?)?;
    let mut scans = all(&geometry);
    let mut unique: HashMap<String, RunPlan> = HashMap::new();
    for entry in scans.iter().flat_map(|s| &s.entries) {
        unique
            .entry(key(&entry.plan))
            .or_insert_with(|| entry.plan.clone());
    }
    let mut plans: Vec<(String, RunPlan)> = unique.into_iter().collect();
    // the longest first, so that no core is left with one of them at the end
    plans.sort_by_key(|(key, plan)| (Reverse(plan.effort()), key.clone()));
    let run = |(key, plan): &(String, RunPlan)| (key.clone(), measure(plan));
    let outcomes: HashMap<_, _> = each(&plans, run).into_iter().collect();
    for entry in scans.iter_mut().flat_map(|s| &mut s.entries) {
        entry.outcome = outcomes[&key(&entry.plan)].clone();
    }
    Ok(scans)
}

fn measure(plan: &RunPlan) -> Result<Values, String> {
    plan.run()
        .and_then(|recording| Values::of(&recording))
        .map_err(|error| causes(&error))
}

fn key(plan: &RunPlan) -> String {
    format!("{plan:?}")
}
