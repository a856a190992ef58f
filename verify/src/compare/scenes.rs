//! Every scene of the project: both sides read it, start alike and have the same channels.

use super::classes::{self, KINDS};
use super::stability;
use crate::check::{Agreement, LargestDifference, largest};
use crate::embedding::Embedding;
use crate::reference::{ReferenceScene, ReferenceState};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use looselink::model::Model;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Simulation;
use miette::{IntoDiagnostic, Result, WrapErr};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use records::root;

/// Rows of a moving scene that are looked at.
const ROWS: f64 = 20.0;
/// Difference of a start, over its largest coordinate or velocity.
const START: f64 = 1e-12;
/// Difference of a channel at the start, over the largest of its kind.
const CHANNELS: f64 = 1e-9;
/// The measure of that difference.
const REASON: &str = "relative to the largest value of its kind, or to 1e9 times what rounding of the state does to it";
/// Rounding in some tens of operations with numbers of size 1.
const ROUNDING: f64 = 1e-14;
/// Rounding of a force over its largest term.
const FORCES: f64 = f64::EPSILON;
/// Random changes of that size that are tried.
const MOVES: usize = 5;

/// All scenes, as they are written, up to a time that costs little, and those of the list.
pub fn all() -> Result<Vec<ComparisonPlan>> {
    let (mut folders, mut plans) = (vec![root().join("scenes")], Vec::new());
    while let Some(folder) = folders.pop() {
        let entries = folder.read_dir().into_diagnostic();
        for entry in entries.wrap_err_with(|| format!("cannot list {}", folder.display()))? {
            let path = entry.into_diagnostic()?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let name = path.strip_prefix(root().join("scenes")).into_diagnostic()?;
                let name = name.with_extension("").display().to_string();
                plans.push(as_written(name, &Scene::load(&path, &[])?));
            }
        }
    }
    plans.sort_by(|a: &ComparisonPlan, b| a.scene.cmp(&b.scene));
    plans.extend(super::plans().scenes);
    Ok(plans)
}

/// A scene as it is written, up to a time that costs little.
pub fn as_written(name: String, scene: &Scene) -> ComparisonPlan {
    let (duration, interval) = (scene.simulation.duration, scene.output.interval);
    let horizon = match scene.simulation.analysis {
        Analysis::Static => duration,
        Analysis::Dynamic => duration.min(ROWS * interval),
    };
    ComparisonPlan::new(name, horizon, interval)
}

/// Those with an analysis of this kind.
pub fn of(analysis: Analysis) -> Result<Vec<ComparisonPlan>> {
    chosen(|scene| scene.simulation.analysis == analysis)
}

/// Those whose scenes are chosen.
pub fn chosen(choose: impl Fn(&Scene) -> bool) -> Result<Vec<ComparisonPlan>> {
    let mut plans = Vec::new();
    for plan in all()? {
        if choose(&plan.scene(None)?) {
            plans.push(plan);
        }
    }
    Ok(plans)
}

/// The starts of a scene.
pub fn start(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let mut reference = plan.reference()?;
    let scene = plan.scene(None)?;
    let simulation = Simulation::new(&scene)?;
    let [q, v] = reference.start().into_diagnostic()?;
    let own = Embedding::new(&reference, simulation.model()).at(simulation.state());
    let name = plan.name();
    let uncertainty = uncertainty(&mut reference)?;
    let row = |what: &str, rust: &[f64], cpp: &[f64], reason: &str| {
        let mut worst = LargestDifference::default();
        worst.see_scaled(rust, cpp, largest(cpp).max(1.0));
        worst.row(what, &name, START.max(uncertainty), reason)
    };
    let coordinates = match uncertainty > START {
        true => {
            "relative to the largest, at least 1 m or 1 rad; rounding of the forces over the stiffness of the softest motion"
        }
        false => {
            "relative to the largest, at least 1 m or 1 rad; each side closes the mechanism to rounding"
        }
    };
    let velocities = "relative to the largest, at least 1 m/s or 1 rad/s; rounding";
    let mut rows = vec![
        row(
            "coordinates of the start",
            own.q.as_slice(),
            &q,
            coordinates,
        ),
        row("velocities of the start", own.v.as_slice(), &v, velocities),
    ];
    if scene.simulation.analysis == Analysis::Dynamic {
        // the first row alone
        let rust = plan.run(None, 0)?;
        let cpp = plan.cpp_until(&tolerances(1e-6), 0)?;
        let rounding = rounding(&mut reference)?;
        let runs = [&rust, &cpp];
        rows.extend(classes::agreements(rounding, &name, runs, CHANNELS, REASON));
        rows.extend(rest(&name, &scene, simulation.model(), runs));
    }
    Ok(rows)
}

/// The rows of the equilibria of two runs.
fn rest(name: &str, scene: &Scene, model: &Model, runs: [&Trajectory; 2]) -> Vec<Agreement> {
    match runs.map(|run| run.rest.as_ref()) {
        [None, None] => Vec::new(),
        [Some(rust), Some(cpp)] => stability::rest(name, scene, model, [rust, cpp]),
        rests => panic!("one side of {name} is in equilibrium: {rests:?}"),
    }
}

/// How far rounding moves a start, over its largest coordinate: an equilibrium by that of the forces over the stiffness mu M of the
/// softest motion, where it moves most.
fn uncertainty(reference: &mut ReferenceScene) -> Result<f64> {
    // no scene but one that starts in equilibrium has a rest
    let Ok(rest) = reference.rest() else {
        return Ok(ROUNDING);
    };
    let Ok(coordinate) = usize::try_from(rest.coordinate) else {
        return Ok(ROUNDING);
    };
    let [q, v] = reference.start().into_diagnostic()?;
    let z = vec![0.0; reference.joints.len()];
    let (t, q, v, z) = (0.0, &q[..], &v[..], &z[..]);
    let force = reference.force(ReferenceState { t, q, v, z });
    let (_, stiffness, _) = force.into_diagnostic()?;
    let mass = reference.mass().into_diagnostic()?[(coordinate, coordinate)];
    let size = largest(q).max(1.0);
    let forces = FORCES * stiffness.amax() * size;
    Ok((forces / (rest.eigenvalue.abs() * mass) / size).max(ROUNDING))
}

/// What a change of the start by some tens of units in the last place, or by what an equilibrium is uncertain by, does to the channels
/// of each kind.
pub fn rounding(reference: &mut ReferenceScene) -> Result<[f64; KINDS]> {
    let uncertainty = uncertainty(reference)?;
    let z = reference.start_contacts().into_diagnostic()?;
    let start = reference.start().into_diagnostic()?;
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut values = |size: f64| {
        let [q, v] = start.clone().map(|mut x| {
            let size = size * largest(&x).max(1.0);
            for x in &mut x {
                *x += size * random.random_range(-1.0..1.0);
            }
            x
        });
        let (t, q, v, z) = (0.0, &q, &v, &z);
        let values = reference.values(ReferenceState { t, q, v, z });
        values.into_diagnostic()
    };
    let still = values(0.0)?;
    let moved: Result<Vec<_>> = (0..MOVES).map(|_| values(uncertainty)).collect();
    let mut effects = [0.0_f64; KINDS];
    for moved in moved? {
        for ((name, moved), still) in reference.channels.iter().zip(moved).zip(&still) {
            if let Some(kind) = classes::class(name) {
                effects[kind] = effects[kind].max((moved - still).abs());
            }
        }
    }
    Ok(effects)
}

/// A static scene from its first load to the last, or to a critical point that ends it.
pub fn equilibrium(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let rounding = rounding(&mut plan.reference()?)?;
    let (rust, cpp) = (plan.run(None, usize::MAX)?, plan.cpp(&tolerances(1e-10))?);
    let (name, runs) = (plan.name(), [&rust, &cpp]);
    let scene = plan.scene(None)?;
    let simulation = Simulation::new(&scene)?;
    let model = simulation.model();
    let ends = |run: &Trajectory| run.get("t").last() == Some(&plan.duration);
    let both_end = ends(&rust) && ends(&cpp);
    // beyond a critical point, each side has a row of every step that it takes
    let critical = cpp.critical_points.first();
    let critical = critical.map_or(f64::INFINITY, |point| point.t);
    let before = cpp.get("t").iter().take_while(|t| **t < critical).count();
    let [first, second] = &runs.map(|run| run.first(before, both_end));
    let mut rows = classes::agreements(rounding, &name, [first, second], CHANNELS, REASON);
    rows.extend(stability::critical_points(&name, model, runs));
    if both_end {
        rows.extend(rest(&name, &scene, model, runs));
    }
    Ok(rows)
}
