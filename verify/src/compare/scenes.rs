//! Every scene of the project: both sides read it, start alike and have the same channels.

use super::classes::{self, KINDS};
use crate::check::{Agreement, LargestDifference, largest};
use crate::embedding::Embedding;
use crate::reference::{ReferenceScene, ReferenceState};
use crate::trajectory::{ComparisonPlan, tolerances};
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
/// Random changes of that size that are tried.
const MOVES: usize = 5;

/// All scenes, as they are written, up to a time that costs little; one whose start has velocities of least energy; and one with
/// every load of a static analysis.
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
    plans.push(ComparisonPlan::new("../verify/scenes/hanging", 0.1, 5e-3));
    plans.push(ComparisonPlan::new("../verify/scenes/loads", 2.0, 0.2));
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
    let row = |what: &str, rust: &[f64], cpp: &[f64], reason: &str| {
        let mut worst = LargestDifference::default();
        worst.see_scaled(rust, cpp, largest(cpp).max(1.0));
        worst.row(what, &name, START, reason)
    };
    let coordinates = "relative to the largest, at least 1 m or 1 rad; each side closes the mechanism to rounding";
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
    }
    Ok(rows)
}

/// What a change of the start by some tens of units in the last place does to the channels of each kind.
pub fn rounding(reference: &mut ReferenceScene) -> Result<[f64; KINDS]> {
    let z = vec![0.0; reference.joints.len()];
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
    let moved: Result<Vec<_>> = (0..MOVES).map(|_| values(ROUNDING)).collect();
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

/// A static scene from its first load to the last.
pub fn equilibrium(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let rounding = rounding(&mut plan.reference()?)?;
    let runs = [&plan.run(None, usize::MAX)?, &plan.cpp(&tolerances(1e-10))?];
    let name = plan.name();
    Ok(classes::agreements(rounding, &name, runs, CHANNELS, REASON))
}
