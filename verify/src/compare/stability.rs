//! Equilibria: what becomes of a small push, and where a growing load ends their stability.

use crate::check::{Agreement, LargestDifference};
use crate::embedding;
use crate::trajectory::{ComparedRest, Trajectory};
use looselink::interaction::PointForceModel;
use looselink::model::Model;
use looselink::scene::Scene;

/// Relative difference of the smallest eigenvalue: rounding of the largest one, which is up to 5e7 times as large.
const EIGENVALUE: f64 = 1e-8;
/// Difference of a critical load as part of the full one.
const LOAD: f64 = 1e-9;
const LOCATED: &str = "difference; Looselink locates a point to 1e-10 of a step";
const SAME: &str = "number of those that differ";

/// How many of the pairs are the same; all have to be.
fn same(quantity: &str, scene: &str, pairs: impl Iterator<Item = bool>) -> Agreement {
    let pairs: Vec<bool> = pairs.collect();
    let matching = pairs.iter().filter(|same| **same).count();
    let mut worst = LargestDifference::default();
    worst.see(matching as f64, pairs.len() as f64, 1.0);
    worst.row(quantity, scene, 0.0, SAME)
}

/// True where both sides name the same motion, or neither can move.
fn moves_alike(model: &Model, [rust, cpp]: [Option<&String>; 2]) -> bool {
    match (rust, cpp) {
        (Some(unknown), Some(coordinate)) => embedding::depends(model, coordinate, unknown),
        (rust, cpp) => rust == cpp,
    }
}

/// True of loads that turn with their body: the stiffness is not symmetric, and Looselink's method for symmetric ones finds its smallest
/// eigenvalue only roughly.
fn has_followers(scene: &Scene) -> bool {
    let models = scene.forces.iter();
    let mut models = models.filter_map(|force| force.kind.get::<PointForceModel>());
    models.any(|model| model.follower)
}

/// The rows of an equilibrium.
pub fn rest(
    name: &str,
    scene: &Scene,
    model: &Model,
    [rust, cpp]: [&ComparedRest; 2],
) -> Vec<Agreement> {
    let [mut word, mut eigenvalue] = [LargestDifference::default(); 2];
    word.see(f64::from(rust.stability), f64::from(cpp.stability), 1.0);
    let words = "stability, 1 stable, 0 neutral, -1 unstable";
    let moves = [rust, cpp].map(|rest| rest.moves.as_ref());
    let mut rows = vec![
        word.row(words, name, 0.0, "difference"),
        same(
            "coordinate that moves most where a push is resisted least",
            name,
            [moves_alike(model, moves)].into_iter(),
        ),
    ];
    if !has_followers(scene) {
        let (r, c) = (rust.eigenvalue, cpp.eigenvalue);
        eigenvalue.see(r, c, c.abs().max(f64::MIN_POSITIVE));
        let (quantity, reason) = (
            "smallest eigenvalue [1/s²]",
            "relative; rounding of the largest one",
        );
        rows.push(eigenvalue.row(quantity, name, EIGENVALUE, reason));
    }
    rows
}

/// The rows of the critical points of a static analysis, if one side has any.
pub fn critical_points(scene: &str, model: &Model, runs: [&Trajectory; 2]) -> Vec<Agreement> {
    let [rust, cpp] = runs.map(|run| &run.critical_points);
    if rust.is_empty() && cpp.is_empty() {
        return Vec::new();
    }
    let pairs = || rust.iter().zip(cpp);
    let [mut number, mut load] = [LargestDifference::default(); 2];
    number.see(rust.len() as f64, cpp.len() as f64, 1.0);
    for (r, c) in pairs() {
        load.see(r.part, c.part, 1.0);
    }
    let mut rows = vec![number.row("number of critical points", scene, 0.0, "difference")];
    if load.is_seen {
        rows.push(load.row(
            "load of the critical points, as part of the full one",
            scene,
            LOAD,
            LOCATED,
        ));
        rows.push(same(
            "kinds of the critical points, limit or bifurcation",
            scene,
            pairs().map(|(r, c)| r.is_limit == c.is_limit),
        ));
        rows.push(same(
            "coordinates that move most at the critical points",
            scene,
            pairs().map(|(r, c)| moves_alike(model, [Some(&r.moves), Some(&c.moves)])),
        ));
    }
    rows
}
