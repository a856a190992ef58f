//! Poses and constraints that lose rank.

use super::{amplitude, apart, column, largest, load, run, try_run, yes};
use looselink::simulate::Simulation;

pub(super) fn singular_poses() -> Vec<f64> {
    let (windows, report) = run("n-four-bar.toml", "");
    let [a, b] = ["points.crank0.end.y", "points.crank2.end.y"].map(|name| column(&windows, name));
    let flat = "initial.sketch={ B0 = [1.0, 0.0], B1 = [2.0, 0.0], B2 = [3.0, 0.0] }";
    let refused = match try_run(
        "n-four-bar.toml",
        &format!("{flat}; initial.velocities={{}}"),
    ) {
        Err(stopped) => stopped.to_string().contains("singular pose"),
        Ok(_) => false,
    };
    let (path, through) = run("hard/type-2-singularity.toml", "");
    vec![
        largest(a.iter().zip(b).map(|(a, b)| a - b)),
        report.singular_poses as f64,
        yes(refused),
        largest(["error.x", "error.y"].map(|name| amplitude(&path, name))),
        through.singular_poses as f64,
    ]
}

pub(super) fn redundant() -> Vec<f64> {
    let scene = "hard/third-bar.toml";
    let (with, report) = run(scene, "");
    let simulation = Simulation::new(&load(scene, "")).expect("a scene of the project");
    let assumptions = simulation.inspect().assumptions;
    // a pendulum: psi'' = -w^2 sin psi, the masses and inertias of three cranks and a coupler
    let (exact, _) = run(scene, "integrator.step=1e-4");
    vec![
        report.redundant.len() as f64,
        yes(assumptions.iter().any(|a| a.contains("is redundant"))),
        apart(&with, &exact, "coupler.x"),
        amplitude(&with, "coupler.theta"),
    ]
}
