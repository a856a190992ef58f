//! The scenes of the project with steps far too long.

use super::{largest, yes};
use crate::stability::map::{UNSAID, difference};
use crate::stability::outcome::{OutcomeClass, Stopped, judge, judge_stop, record};
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Recording, Report};
use records::root;
use std::path::{Path, PathBuf};

/// Long steps that are taken.
const STEPS: f64 = 20.0;

fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).expect("the folder of scenes");
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
}

/// Positions of all bodies at every long step.
fn rows(path: &Path, step: f64, interval: f64) -> Result<(Recording, Report), Stopped> {
    let settings = [
        format!("integrator.step={step:e}"),
        format!("output.interval={interval:e}"),
        format!("simulation.duration={:e}", STEPS * interval),
        "output.channels=[\"*.x\", \"*.y\"]".to_owned(),
    ];
    let scene = Scene::load(path, &settings).map_err(|e| Stopped::Refused(e.to_string(), 0.0))?;
    record(&scene)
}

/// Runs that are wrong in silence, and all runs.
pub(super) fn long_steps() -> Vec<f64> {
    let mut found = Vec::new();
    scenes(&root().join("scenes"), &mut found);
    found.sort();
    let (mut silent, mut runs) = (0.0, 0.0);
    for path in &found {
        let scene = Scene::load(path, &[]).expect("a scene of the project");
        let Some(step) = scene.integrator.step() else {
            continue;
        };
        let dynamic = scene.simulation.analysis == Analysis::Dynamic;
        for long in [10.0 * step, 100.0 * step].into_iter().filter(|_| dynamic) {
            let Ok((exact, _)) = rows(path, step, long) else {
                continue;
            };
            let outcome = match rows(path, long, long) {
                Ok((recording, report)) => {
                    let columns = exact.names()[1..].iter().filter_map(|name| exact.get(name));
                    let range = largest(columns.flat_map(|x| x.iter().map(|v| v - x[0])));
                    let error = difference(&exact, &recording);
                    judge(error, 0.01 * range, UNSAID * range, &report)
                }
                Err(stopped) => judge_stop(&stopped),
            };
            runs += 1.0;
            silent += yes(outcome == OutcomeClass::Silent);
            if outcome == OutcomeClass::Silent {
                eprintln!("{}, step {long:e} s: silent", path.display());
            }
        }
    }
    vec![silent, runs]
}
