//! Runs scenes of the project and keeps what they tell.

use ladder::Worst;
use looselink::scene::Scene;
use looselink::simulate::{Impact, Recording, Report, Simulation};
use std::path::{Path, PathBuf};

/// All rows and onsets of a run.
#[derive(Debug)]
pub struct TestRecording {
    kept: Recording,
    pub onsets: Vec<Impact>,
}

impl TestRecording {
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

    /// The row at a time.
    pub fn row(&self, t: f64) -> usize {
        let times = self.get("t");
        let row = (0..times.len())
            .min_by(|a, b| (times[*a] - t).abs().total_cmp(&(times[*b] - t).abs()))
            .expect("a run has rows");
        assert!((times[row] - t).abs() < 1e-9, "no row at {t}");
        row
    }
}

/// The file of a scene of the project, from tests of any of its packages.
pub fn path(scene: &str) -> PathBuf {
    let mut above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let top = above.find(|folder| folder.join("scenes").is_dir());
    top.unwrap().join("scenes").join(scene)
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

/// Overrides that give the passive links of a 3-RRR mechanism natural coordinates, with a constraint each where they are rigid.
pub const NATURAL: [&str; 3] = [
    "bodies.link1.coordinates=\"natural\"",
    "bodies.link2.coordinates=\"natural\"",
    "bodies.link3.coordinates=\"natural\"",
];

/// A scene with overrides.
pub fn load(scene: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    Scene::load(&path(scene), &overrides).unwrap_or_else(|e| panic!("{scene}: {e}"))
}

/// Runs a scene of the project to its end.
pub fn run(scene: &str, overrides: &[&str]) -> (TestRecording, Report) {
    run_scene(&load(scene, overrides))
}

/// Runs a scene to its end.
pub fn run_scene(scene: &Scene) -> (TestRecording, Report) {
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    let mut kept = Recording::new(&simulation);
    simulation.run(&mut kept).unwrap_or_else(|e| panic!("{e}"));
    let onsets = kept.onsets.clone();
    let recording = TestRecording { kept, onsets };
    (recording, simulation.report())
}

/// The largest difference of channels of two recordings, relative to the largest value of each channel, or to `least` where
/// that is larger.
pub fn difference<N: AsRef<str>>(
    [a, b]: [&TestRecording; 2],
    names: impl IntoIterator<Item = N>,
    least: f64,
) -> Worst {
    let worst = Worst::new();
    for name in names {
        let (a, b) = (a.get(name.as_ref()), b.get(name.as_ref()));
        let size = a.iter().fold(least, |m, x| m.max(x.abs()));
        worst.at(name.as_ref());
        for (a, b) in a.iter().zip(&b) {
            worst.see((a - b) / size);
        }
    }
    worst
}

/// Times at which a series rises through zero, on the straight line between two rows.
pub fn rising_zeros(t: &[f64], x: &[f64]) -> Vec<f64> {
    let rows = t.windows(2).zip(x.windows(2));
    let rising = rows.filter(|(_, x)| x[0] < 0.0 && x[1] >= 0.0);
    rising
        .map(|(t, x)| t[0] + (t[1] - t[0]) * x[0] / (x[0] - x[1]))
        .collect()
}

/// Root mean square of the difference of two series of the same length.
pub fn rms_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let sum: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    (sum / a.len() as f64).sqrt()
}
