//! Runs that no single realisation decides: ensembles of starts, Lyapunov exponents, meshes, other methods.

use crate::exponents::{self, Exponents};
use crate::kinematics::MechanismGeometry;
use crate::measures::Measures;
use crate::methods::{self, Long, MethodWork};
use crate::runs::{CaseRecording, DURATION, FROM, RunPlan};
use crate::shown::mean;
use crate::signal::{rms, smooth};
use crate::timings::{self, KernelTimings};
use crate::variants::{MOVED, STARTS, mesh, mesh_name, moved};
use crate::warned::merged;
use miette::{IntoDiagnostic, Result};
use minijinja::Value;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use statistics::Interval;
use std::collections::BTreeMap;

/// Time between recorded rows \[s\].
const INTERVAL: f64 = 1e-5;
/// Displacements of the platform that must make no other difference than [`MOVED`] \[m\].
const MOVED_OTHERWISE: [f64; 2] = [1e-10, 1e-14];
/// Meshes: elements a link.
pub const MESHES: [usize; 4] = [1, 2, 4, 8];
/// Means over this time \[s\] are compared where single impacts do not happen at the same instants.
const AVERAGED: f64 = 0.02;
/// Retardation times of the passive links \[s\].
pub const RETARDATIONS: [f64; 2] = [1e-6, 1e-5];
/// The ensemble of case 3.
pub const LOOSE: &str = "A";
/// That of case 4.
pub const BOTH: &str = "B";
/// That of case 3 with half the clearance.
pub const TIGHTER: &str = "G";

/// What the campaign leaves.
#[derive(Debug, Serialize, Deserialize)]
pub struct EnsembleRecord {
    /// Runs that differ by a tiny displacement at the start, and single runs of case 2, which is not chaotic.
    pub ensembles: Vec<Ensemble>,
    /// Largest Lyapunov exponents.
    pub exponents: Vec<Exponents>,
    /// Work and error of explicit and implicit methods.
    pub work: Vec<MethodWork>,
    /// Runs over many cycles.
    pub long: Vec<Long>,
    /// Times of kernels and of a step.
    pub timings: KernelTimings,
}

/// Runs that differ by the direction of a tiny displacement of the platform at the start.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ensemble {
    /// A letter, or what is special about a single run.
    pub name: String,
    /// Case of Table 2.
    pub case: u32,
    /// The displacement \[m\].
    pub moved: f64,
    /// What else is changed; empty for nothing.
    pub changed: String,
    /// Every measure of every run.
    pub measures: BTreeMap<String, Vec<f64>>,
    /// What the runs warn of.
    pub warnings: Vec<String>,
    #[serde(skip)]
    plans: Vec<RunPlan>,
}

/// What is kept of a run: measures, warnings and, where it is composed, its slow error.
type Kept = (Measures, Vec<String>, Vec<f64>);

/// The campaign `ensembles`.
///
/// # Errors
/// The first run that fails.
pub fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let geometry = MechanismGeometry::of(&RunPlan::controlled(3, INTERVAL).scene()?)?;
    // before other threads run
    let timings = journal.item("timings", timings::run)?;
    let record = EnsembleRecord {
        timings,
        work: methods::work(journal)?,
        long: methods::long(&geometry, journal)?,
        exponents: exponents::run(&geometry, journal)?,
        ensembles: make(planned(&geometry), journal)?,
    };
    serde_json::to_value(record).into_diagnostic()
}

impl EnsembleRecord {
    /// The ensemble of this name.
    ///
    /// # Panics
    /// When there is none.
    pub fn ensemble(&self, name: &str) -> &Ensemble {
        let found = self.ensembles.iter().find(|e| e.name == name);
        found.unwrap_or_else(|| panic!("no ensemble {name}"))
    }

    /// The ensembles of a case that differ by the size of the displacement alone, by that size.
    pub fn sizes(&self, case: u32) -> Vec<&Ensemble> {
        let wanted = |e: &&Ensemble| e.case == case && e.changed.is_empty();
        let mut sizes: Vec<&Ensemble> = self.ensembles.iter().filter(wanted).collect();
        sizes.sort_by(|a, b| a.moved.total_cmp(&b.moved));
        sizes
    }

    /// The exponents of a case, one entry for each distance.
    pub fn exponents(&self, case: u32) -> impl Iterator<Item = &Exponents> {
        self.exponents.iter().filter(move |e| e.case == case)
    }
}

impl Ensemble {
    /// Runs that are to be made.
    fn planned(name: String, changed: String, moved: f64, plans: Vec<RunPlan>) -> Ensemble {
        Ensemble {
            name,
            case: plans[0].case,
            moved,
            changed,
            measures: BTreeMap::new(),
            warnings: Vec::new(),
            plans,
        }
    }

    /// The measures that all runs have, and the warnings.
    fn take(&mut self, runs: &[Kept]) {
        for (name, value) in runs.iter().flat_map(|(measures, ..)| &measures.0) {
            let column = self.measures.entry(name.clone()).or_default();
            column.push(*value);
        }
        self.measures.retain(|_, values| values.len() == runs.len());
        self.warnings = merged(runs.iter().map(|(_, warnings, _)| warnings));
    }

    /// The measures of several ensembles as one.
    ///
    /// # Panics
    /// Without any.
    pub fn together(all: &[&Ensemble]) -> Ensemble {
        let mut together = all[0].clone();
        for other in &all[1..] {
            for (name, values) in &mut together.measures {
                values.extend(other.measures.get(name).into_iter().flatten());
            }
        }
        together
    }

    /// A measure of every run.
    ///
    /// # Panics
    /// When the runs have no such measure.
    pub fn values(&self, name: &str) -> &[f64] {
        let found = self.measures.get(name);
        found.unwrap_or_else(|| panic!("no measure {name} of ensemble {}", self.name))
    }

    /// Its mean and interval.
    pub fn mean(&self, name: &str) -> Interval {
        Interval::of(self.values(name))
    }

    /// All means with their intervals; of a single run the values.
    pub fn means(&self) -> BTreeMap<&str, Value> {
        let measures = self.measures.iter();
        measures.map(|(name, v)| (name.as_str(), mean(v))).collect()
    }

    /// Mean of a function of a measure of these runs and the same of others, run by run.
    pub fn pairs(&self, others: &Ensemble, name: &str, of: impl Fn(f64, f64) -> f64) -> Interval {
        let of = |(one, other): (&f64, &f64)| of(*one, *other);
        let pairs = self.values(name).iter().zip(others.values(name));
        Interval::of(&pairs.map(of).collect::<Vec<f64>>())
    }
}

/// All ensembles and single runs, which are to be made.
fn planned(g: &MechanismGeometry) -> Vec<Ensemble> {
    let mut all = Vec::new();
    let sizes = [MOVED].into_iter().chain(MOVED_OTHERWISE);
    let sizes = sizes.flat_map(|size| [3, 4].map(|case| (case, size, Vec::new())));
    let half = vec![format!("contacts.pin.clearance={:e}", 0.5 * g.clearance)];
    let finer = MESHES[1..].iter().map(|n| (4, MOVED, mesh(*n)));
    let changed = sizes.chain([(3, MOVED, half)]).chain(finer);
    for ((case, size, overrides), letter) in changed.zip('A'..) {
        let (name, changed) = (letter.to_string(), overrides.join(" "));
        let mut plan = RunPlan::controlled(case, INTERVAL);
        plan.overrides = overrides;
        let plans = (0..STARTS).map(|k| plan.clone().with(moved(g, size, k)));
        all.push(Ensemble::planned(name, changed, size, plans.collect()));
    }
    let damped = RETARDATIONS.map(|time| {
        let of = |i| format!("bodies.link{i}.kelvin_voigt={time:e}");
        (damped_name(time), [1, 2, 3].map(of).into())
    });
    let singles = MESHES.map(|elements| (mesh_name(elements), mesh(elements)));
    for (name, overrides) in singles.into_iter().chain(damped) {
        let mut plan = RunPlan::controlled(2, INTERVAL);
        plan.overrides = overrides;
        let changed = "case 2".into();
        all.push(Ensemble::planned(name, changed, 0.0, vec![plan]));
    }
    all
}

fn make(mut all: Vec<Ensemble>, journal: &Journal) -> Result<Vec<Ensemble>> {
    let mut keys: Vec<(&str, usize, &RunPlan)> = Vec::new();
    for ensemble in &all {
        let plans = ensemble.plans.iter().enumerate();
        keys.extend(plans.map(|(k, plan)| (ensemble.name.as_str(), k, plan)));
    }
    let composed = [LOOSE, BOTH, &mesh_name(1)];
    let run = |(name, _, plan): &(&str, usize, &RunPlan)| {
        let recording = plan.run()?;
        // a changed clearance changes the bound
        let measures = Measures::of(&MechanismGeometry::of(&recording.scene)?, &recording);
        let slow = composed.contains(name).then(|| slow_error(&recording));
        Ok((measures, recording.warnings, slow.unwrap_or_default()))
    };
    let name = |(name, k, _): &(&str, usize, &RunPlan)| format!("{name} {k}");
    let mut done: Vec<Kept> = journal.items(&keys, threads(), name, run)?;
    let first = composed.map(|name| keys.iter().position(|key| key.0 == name).unwrap_or(0));
    compose(&mut done, first);
    let mut done = done.into_iter();
    for ensemble in &mut all {
        let runs: Vec<Kept> = done.by_ref().take(ensemble.plans.len()).collect();
        ensemble.take(&runs);
    }
    Ok(all)
}

/// Adds to the runs of case 4 which part of their slow error is none of cases 2 and 3; the run of case 3 has the same start.
fn compose(done: &mut [Kept], [loose, both, flexible]: [usize; 3]) {
    for k in 0..STARTS {
        let of = |run: usize| done[run].2.iter();
        let parts = of(both + k).zip(of(loose + k)).zip(of(flexible));
        let rest = parts.map(|((both, loose), flexible)| both - loose - flexible);
        let rest = rms(&rest.collect::<Vec<f64>>()) / rms(&done[both + k].2);
        done[both + k].0.put("not_composed", rest);
    }
}

/// The name of the run of case 2 with structural damping.
pub fn damped_name(time: f64) -> String {
    format!("retardation time {}", numbers::si(time, "s"))
}

/// Means of the error over [`AVERAGED`], one a millisecond.
fn slow_error(recording: &CaseRecording) -> Vec<f64> {
    let width = (AVERAGED / recording.plan.interval) as usize;
    let every = (1e-3 / recording.plan.interval) as usize;
    let error = smooth(recording.between("error.x", FROM, DURATION).1, width);
    error.into_iter().step_by(every).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    fn geometry() -> Result<MechanismGeometry> {
        MechanismGeometry::of(&RunPlan::controlled(3, INTERVAL).scene()?)
    }

    #[test]
    fn starts_of_an_ensemble_differ() -> Result<()> {
        let geometry = geometry()?;
        for size in [MOVED].into_iter().chain(MOVED_OTHERWISE) {
            let starts: HashSet<String> = (0..STARTS).map(|k| moved(&geometry, size, k)).collect();
            assert_eq!(starts.len(), STARTS, "{size:e} m is lost in rounding");
        }
        Ok(())
    }

    #[test]
    fn scenes_of_all_ensembles_are_read() -> Result<()> {
        let all = planned(&geometry()?);
        let names: HashSet<&str> = all.iter().map(|e| e.name.as_str()).collect();
        assert!(names.len() == all.len() && names.contains(TIGHTER));
        all.iter().try_for_each(|e| e.plans[0].scene().map(drop))
    }

    #[test]
    fn what_is_left_of_a_composed_error_is_that_of_the_same_start() {
        let runs = |base: f64| (0..STARTS).map(move |k| base + k as f64);
        let slow = runs(1.0).chain(runs(4.0)).chain([1.0]);
        let mut done: Vec<Kept> = slow
            .map(|x| (Measures::default(), vec![], vec![x; 3]))
            .collect();
        compose(&mut done, [0, STARTS, 2 * STARTS]);
        for (k, (measures, ..)) in done[STARTS..2 * STARTS].iter().enumerate() {
            // (4 + k) - (1 + k) - 1 = 2
            let expected = numbers::rounded(2.0 / (4.0 + k as f64), 9);
            assert_eq!(measures.get("not_composed"), expected);
        }
        assert!(
            done[..STARTS]
                .iter()
                .all(|(measures, ..)| measures.0.is_empty())
        );
    }
}
