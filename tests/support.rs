//! Runs scenes of the project and keeps what they tell.

use looselink::scene::Scene;
use looselink::simulate::{self, RecordedOnset, Report, Simulation};
use std::path::{Path, PathBuf};

/// All rows and onsets of a run.
#[derive(Debug)]
pub struct Recording {
    kept: simulate::Recording,
    pub onsets: Vec<RecordedOnset>,
}

impl Recording {
    /// A channel over time.
    pub fn get(&self, name: &str) -> Vec<f64> {
        let column = self.kept.get(name);
        column
            .unwrap_or_else(|| panic!("no channel {name}"))
            .to_vec()
    }

    /// Names of all channels.
    pub fn names(&self) -> &[String] {
        self.kept.names()
    }

    pub fn len(&self) -> usize {
        self.kept.rows()
    }
}

/// The file of a scene of the project.
pub fn path(scene: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(scene)
}

/// The files of all scenes of the project, below the folder of scenes, in order.
pub fn all_scenes() -> Vec<String> {
    fn walk(folder: &Path, names: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let found = entry.unwrap().path();
            if found.is_dir() {
                walk(&found, names);
            } else if found.extension().is_some_and(|e| e == "toml") {
                let name = found.strip_prefix(path("")).unwrap();
                names.push(name.to_str().unwrap().to_owned());
            }
        }
    }
    let mut names = Vec::new();
    walk(&path(""), &mut names);
    names.sort();
    names
}

/// A scene with overrides.
pub fn load(scene: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    Scene::load(&path(scene), &overrides).unwrap_or_else(|e| panic!("{scene}: {e}"))
}

/// Runs a scene of the project to its end.
pub fn run(scene: &str, overrides: &[&str]) -> (Recording, Report) {
    run_scene(&load(scene, overrides))
}

/// Runs a scene to its end.
pub fn run_scene(scene: &Scene) -> (Recording, Report) {
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let mut kept = simulate::Recording::new(&simulation);
    simulation.run(&mut kept).unwrap_or_else(|e| panic!("{e}"));
    let onsets = kept.onsets.clone();
    let recording = Recording { kept, onsets };
    (recording, simulation.report())
}

/// Root mean square of the difference of two series of the same length.
pub fn rms_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let sum: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    (sum / a.len() as f64).sqrt()
}

/// Asserts that errors at steps h, each half of the one before, fall with an order within the bounds, pair by pair.
pub fn assert_order(name: &str, errors: &[(f64, f64)], bounds: std::ops::Range<f64>) {
    for pair in errors.windows(2) {
        let [(h, e), (h_next, e_next)] = [pair[0], pair[1]];
        let order = (e / e_next).ln() / (h / h_next).ln();
        assert!(
            bounds.contains(&order),
            "{name}: order {order:.3} between {h:e} and {h_next:e}; errors {errors:?}"
        );
    }
}

/// Asserts the order of errors whose constant varies from step to step, because events cut the grid at other places:
/// the slope of the least-squares line through (log h, log error).
pub fn assert_fitted_order(name: &str, errors: &[(f64, f64)], bounds: std::ops::Range<f64>) {
    let logs: Vec<(f64, f64)> = errors.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
    let n = logs.len() as f64;
    let (x, y) = logs
        .iter()
        .fold((0.0, 0.0), |(x, y), l| (x + l.0 / n, y + l.1 / n));
    let (up, down) = logs.iter().fold((0.0, 0.0), |(u, d), l| {
        (u + (l.0 - x) * (l.1 - y), d + (l.0 - x).powi(2))
    });
    let order = up / down;
    assert!(
        bounds.contains(&order),
        "{name}: order {order:.3}; errors {errors:?}"
    );
}
