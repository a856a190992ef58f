//! Runs that no single realisation decides: ensembles of starts, Lyapunov exponents, meshes, other methods.

use crate::exponents::{self, Exponents};
use crate::kinematics::MechanismGeometry;
use crate::measures::Measures;
use crate::methods::{self, Long, MethodWork};
use crate::runs::{CaseRecording, DURATION, FROM, RunPace, RunPlan};
use crate::signal::{rms, smooth};
use crate::timings::{self, KernelTimings};
use crate::warned::merged;
use miette::{IntoDiagnostic, Result};
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use statistics::Interval;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Starts of every ensemble.
pub const STARTS: usize = 16;
/// Time between recorded rows \[s\].
const INTERVAL: f64 = 1e-5;
/// Displacement of the platform between the starts of an ensemble \[m\].
pub const MOVED: f64 = 1e-12;
/// Others, which must make no difference \[m\].
const MOVED_OTHERWISE: [f64; 2] = [1e-10, 1e-14];
/// Meshes: elements a link.
pub const MESHES: [usize; 4] = [1, 2, 4, 8];
/// Means over this time \[s\] are compared where single impacts do not happen at the same instants.
const AVERAGED: f64 = 0.02;
/// Time in which the platform gets up to speed in the run that starts without deformation at rest \[s\].
const SPIN_UP: f64 = 0.8;
/// Knots of that path \[s\].
const KNOTS: f64 = 1e-3;
/// Retardation times of the passive links \[s\].
pub const RETARDATIONS: [f64; 2] = [1e-6, 1e-5];
/// Steps of Bathe's method whose energy is looked at \[s\]: that of the scenes, and one eight times as long.
pub const BATHE: [f64; 2] = [1.25e-6, 1e-5];
/// Starts of these runs, every second of an ensemble.
const BATHE_STARTS: usize = 8;

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
}

/// An ensemble to be made, and its runs.
type Wanted = (Ensemble, Vec<RunPlan>);

/// What is kept of a run: measures, warnings and, where it is composed, its slow error.
type Kept = (Measures, Vec<String>, Vec<f64>);

/// The campaign `ensembles`.
///
/// # Errors
/// The first run that fails.
pub fn measure(journal: &Journal) -> Result<Value> {
    let geometry = MechanismGeometry::of(&RunPlan::controlled(3, INTERVAL).scene()?)?;
    // before other threads run
    let timings = journal.item("timings", timings::run)?;
    let record = EnsembleRecord {
        timings,
        work: methods::work(journal)?,
        long: methods::long(&geometry, journal)?,
        exponents: exponents::run(&geometry, journal)?,
        ensembles: make(wanted(&geometry), journal)?,
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
    fn wanted(name: String, changed: String, moved: f64, plans: Vec<RunPlan>) -> Wanted {
        let ensemble = Ensemble {
            name,
            case: plans[0].case,
            moved,
            changed,
            measures: BTreeMap::new(),
            warnings: Vec::new(),
        };
        (ensemble, plans)
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

    /// Several ensembles as one.
    ///
    /// # Panics
    /// Without any.
    pub fn together(all: &[&Ensemble]) -> Ensemble {
        let mut together = all[0].clone();
        for other in &all[1..] {
            together.name = format!("{}, {}", together.name, other.name);
            together.warnings.extend_from_slice(&other.warnings);
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
}

/// All ensembles and single runs.
fn wanted(g: &MechanismGeometry) -> Vec<Wanted> {
    let starts = |plan: &RunPlan, size: f64, every: usize| {
        let starts = (0..STARTS).step_by(every);
        let plans = starts.map(|k| plan.clone().with(moved(g, size, k)));
        plans.collect::<Vec<RunPlan>>()
    };
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
        let plans = starts(&plan, size, 1);
        all.push(Ensemble::wanted(name, changed, size, plans));
    }
    for (case, step) in [3, 4].map(|case| BATHE.map(|step| (case, step))).concat() {
        let plan = RunPlan::new(case, RunPace::bathe(step), 1e-4, DURATION);
        let (name, changed) = (bathe_name(case, step), plan.pace.label());
        let plans = starts(&plan, MOVED, STARTS / BATHE_STARTS);
        all.push(Ensemble::wanted(name, changed, MOVED, plans));
    }
    let mut single = |name: String, overrides: Vec<String>| {
        let mut plan = RunPlan::controlled(2, INTERVAL);
        plan.overrides = overrides;
        let changed = "case 2".into();
        all.push(Ensemble::wanted(name, changed, 0.0, vec![plan]));
    };
    for elements in MESHES {
        single(mesh_name(elements), mesh(elements));
    }
    single("quasi-static start".into(), spun_up(g));
    for time in RETARDATIONS {
        let damped = [1, 2, 3].map(|i| format!("bodies.link{i}.kelvin_voigt={time:e}"));
        single(damped_name(time), damped.into());
    }
    all
}

fn make(wanted: Vec<Wanted>, journal: &Journal) -> Result<Vec<Ensemble>> {
    let mut keys: Vec<(&str, usize, &RunPlan)> = Vec::new();
    for (ensemble, plans) in &wanted {
        let plans = plans.iter().enumerate();
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
    let mut done = done.as_slice();
    let made = wanted.into_iter().map(|(mut ensemble, plans)| {
        let (runs, rest) = done.split_at(plans.len());
        done = rest;
        ensemble.take(runs);
        ensemble
    });
    Ok(made.collect())
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

fn mesh(elements: usize) -> Vec<String> {
    let of = |i| format!("bodies.link{i}.elements={elements}");
    (1..=3).map(of).collect()
}

/// The name of the run of case 2 with so many elements a link.
pub fn mesh_name(elements: usize) -> String {
    format!("{elements} elements a link")
}

/// The name of the run of case 2 with structural damping.
pub fn damped_name(time: f64) -> String {
    format!("retardation time {}", numbers::si(time, "s"))
}

/// The name of the runs with Bathe's method.
pub fn bathe_name(case: u32, step: f64) -> String {
    format!("Bathe, case {case}, {}", numbers::si(step, "s"))
}

/// The start of case 3 or 4 with the platform moved by `moved` \[m\], in one of [`STARTS`] directions.
///
/// The velocity is that of the ideal mechanism, which the scene has without this override.
pub fn moved(g: &MechanismGeometry, moved: f64, start: usize) -> String {
    let (sin, cos) = (TAU * start as f64 / STARTS as f64).sin_cos();
    let [x, y, theta] = g.pose(0.0);
    let speed = TAU * g.frequency * g.radius;
    format!(
        "initial.bodies={{ platform = {{ x = {:?}, y = {:?}, theta = {theta:?}, vx = 0.0, vy = {speed:?}, omega = 0.0 }} }}",
        x + moved * cos,
        y + moved * sin
    )
}

/// Means of the error over [`AVERAGED`], one a millisecond.
fn slow_error(recording: &CaseRecording) -> Vec<f64> {
    let width = (AVERAGED / recording.plan.interval) as usize;
    let every = (1e-3 / recording.plan.interval) as usize;
    let error = smooth(recording.between("error.x", FROM, DURATION).1, width);
    error.into_iter().step_by(every).collect()
}

/// Case 2 from rest: the platform gets up to speed on the circle so smoothly that the links follow in their quasi-static
/// deformation, and is where the printed motion is from [`SPIN_UP`] on.
///
/// The angle is phi = pi T + 2 pi T R(t/T), its rate a polynomial with three vanishing derivatives at both ends.
fn spun_up(g: &MechanismGeometry) -> Vec<String> {
    let place = |t: f64| {
        let u = (t / SPIN_UP).min(1.0);
        let ramp = u.powi(5) * (7.0 - u * (14.0 - u * (10.0 - 2.5 * u)));
        let turns = 0.5 * SPIN_UP + SPIN_UP * ramp + (t - SPIN_UP).max(0.0);
        let (sin, cos) = (g.frequency * TAU * turns).sin_cos();
        [g.radius * cos, g.radius * sin, 0.0]
    };
    let mut rows = String::new();
    // beyond the end, where the spline has no curvature
    for k in 0..=((DURATION + 0.05) / KNOTS) as usize {
        let t = k as f64 * KNOTS;
        let [x, y, theta] = place(t);
        let _ = write!(rows, "[{t:?}, {x:?}, {y:?}, {theta:?}], ");
    }
    let path = format!("drives.input.path={{ type = \"table\", rows = [{rows}] }}");
    let sketches = (0..3).map(|leg| {
        let [x, y]: [f64; 2] = g.pin(leg, place(0.0)).into();
        format!("initial.sketch.B{}=[{x:?}, {y:?}]", leg + 1)
    });
    [path].into_iter().chain(sketches).collect()
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
        let all = wanted(&geometry()?);
        let names: HashSet<&str> = all.iter().map(|(e, _)| e.name.as_str()).collect();
        assert!(names.len() == all.len() && names.contains(TIGHTER));
        all.iter()
            .try_for_each(|(_, plans)| plans[0].scene().map(drop))
    }

    #[test]
    fn spun_up_path_ends_on_the_printed_one() -> Result<()> {
        let geometry = geometry()?;
        let path = &spun_up(&geometry)[0];
        let row = path.split("[1.0, ").nth(1).unwrap_or_default();
        let x = row.split(',').next().unwrap_or_default();
        let x: f64 = x.parse().unwrap_or(f64::NAN);
        // one turn after one second, to the rounding of an angle of 6
        assert!((x - geometry.radius).abs() < 1e-15);
        Ok(())
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
