//! Poses and constraints that lose rank.

use super::{amplitude, apart, run, try_run, yes};
use crate::stability::outcome::largest;

pub(super) fn singular_poses() -> Vec<f64> {
    let flat = "initial.sketch={ B0 = [1.0, 0.0], B1 = [2.0, 0.0], B2 = [3.0, 0.0] }; \
                initial.velocities={}";
    let refused = match try_run("n-four-bar.toml", flat) {
        Err(stopped) => stopped.to_string().contains("singular pose"),
        Ok(_) => false,
    };
    let (path, through) = run("hard/type-2-singularity.toml", "");
    vec![
        yes(refused),
        largest(["error.x", "error.y"].map(|name| amplitude(&path, name))),
        through.singular_poses as f64,
    ]
}

pub(super) fn redundant() -> Vec<f64> {
    let (coarse, _) = run("hard/third-bar.toml", "");
    let (fine, _) = run("hard/third-bar.toml", "integrator.step=1e-4");
    vec![
        apart(&coarse, &fine, "coupler.x"),
        amplitude(&coarse, "coupler.theta"),
    ]
}
