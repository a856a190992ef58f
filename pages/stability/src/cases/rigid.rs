//! Poses and constraints that lose rank.

use super::{Check, apart, column, largest, run, try_run};
use looselink::simulate::Simulation;

pub(super) fn singular_poses() -> Vec<Check> {
    let (windows, report) = run("n-four-bar.toml", &[]);
    let through = run("hard/type-2-singularity.toml", &[]);
    let errors = ["error.x", "error.y"].map(|name| largest(column(&through.0, name).to_vec()));
    let flat = "initial.sketch={ B0 = [1.0, 0.0], B1 = [2.0, 0.0], B2 = [3.0, 0.0] }";
    let refused = match try_run("n-four-bar.toml", &[flat, "initial.velocities={}"]) {
        Err(stopped) => stopped.to_string().contains("singular pose"),
        Ok(_) => false,
    };
    vec![
        Check::below(
            "Two four-bar windows pass their collinear poses for 10 s: difference between the heights of their cranks [m]",
            apart_within(&windows),
            1e-12,
        ),
        Check::new(
            "The same: stages in a singular pose, reported in a warning",
            report.singular_poses as f64,
            1.0..=f64::MAX,
        ),
        Check::yes(
            "The same, started in a collinear pose, is refused as singular",
            refused,
        ),
        Check::below(
            "Rigid ideal 3-RRR through two type-2 singularities: distance from its path [m]",
            largest(errors),
            1e-9,
        ),
        Check::new(
            "The same: stages in a singular pose, reported in a warning",
            through.1.singular_poses as f64,
            1.0..=f64::MAX,
        ),
    ]
}

fn apart_within(windows: &looselink::simulate::Recording) -> f64 {
    let [a, b] = ["points.crank0.end.y", "points.crank2.end.y"].map(|name| column(windows, name));
    largest(a.iter().zip(b).map(|(a, b)| a - b))
}

pub(super) fn redundant() -> Vec<Check> {
    let scene = "hard/third-bar.toml";
    let (with, report) = run(scene, &[]);
    let simulation = Simulation::new(&super::load(scene, &[])).expect("a scene of the project");
    let named = simulation
        .inspect()
        .assumptions
        .iter()
        .any(|a| a.contains("is redundant"));
    // a pendulum: psi'' = -w^2 sin psi, the masses and inertias of three cranks and a coupler
    let (exact, _) = run(scene, &["integrator.step=1e-4"]);
    vec![
        Check::new(
            "Redundant constraints are left out",
            report.redundant.len() as f64,
            1.0..=1.0,
        ),
        Check::yes("`inspect` and the summary name them", named),
        Check::below(
            "Distance from the same motion at a tenth of the step [m]",
            apart(&with, &exact, "coupler.x"),
            1e-5,
        ),
        Check::below(
            "Rotation of the coupler [rad]",
            largest(column(&with, "coupler.theta").to_vec()),
            1e-12,
        ),
    ]
}
