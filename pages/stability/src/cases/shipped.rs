//! The scenes of the project with steps far too long.

use super::{Check, largest};
use crate::map::difference;
use crate::outcome::{OutcomeClass, Stopped, judge, judge_stop, record};
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Recording;
use std::path::{Path, PathBuf};

/// Long steps that are taken.
const STEPS: f64 = 20.0;
/// As in maps.
const UNSAID: f64 = 0.05;

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
fn rows(
    path: &Path,
    step: f64,
    interval: f64,
) -> Result<Result<(Recording, looselink::simulate::Report), Stopped>, String> {
    let settings = [
        format!("integrator.step={step:e}"),
        format!("output.interval={interval:e}"),
        format!("simulation.duration={:e}", STEPS * interval),
        "output.channels=[\"*.x\", \"*.y\"]".to_owned(),
    ];
    let scene = Scene::load(path, &settings).map_err(|e| e.to_string())?;
    Ok(record(&scene))
}

pub(super) fn long_steps() -> Vec<Check> {
    let mut found = Vec::new();
    scenes(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"),
        &mut found,
    );
    found.sort();
    let mut counts = [0_usize; OutcomeClass::ALL.len()];
    for path in &found {
        let scene = Scene::load(path, &[]).expect("a scene of the project");
        let Some(step) = scene.integrator.step() else {
            continue;
        };
        if scene.simulation.analysis == Analysis::Static {
            continue;
        }
        for factor in [10.0, 100.0] {
            let long = factor * step;
            let Ok(Ok((exact, _))) = rows(path, step, long) else {
                continue;
            };
            let outcome = match rows(path, long, long) {
                Ok(Ok((recording, report))) => {
                    let error = difference(&exact, &recording);
                    let columns = exact.names().iter().skip(1);
                    let ranges = columns.filter_map(|name| {
                        let x = exact.get(name)?;
                        Some(largest(x.iter().map(|v| v - x[0])))
                    });
                    let range = ranges.fold(0.0, f64::max);
                    judge(error, 0.01 * range, UNSAID * range, &report)
                }
                Ok(Err(stopped)) => judge_stop(&stopped),
                Err(_) => OutcomeClass::Refused,
            };
            let place = OutcomeClass::ALL
                .iter()
                .position(|o| *o == outcome)
                .expect("listed");
            counts[place] += 1;
        }
    }
    let runs: usize = counts.iter().sum();
    let named = OutcomeClass::ALL
        .iter()
        .zip(counts)
        .map(|(o, n)| format!("{n} {}", o.name()));
    vec![
        Check::below(
            format!(
                "Every dynamic scene with 10 and 100 times its step ({}): silent runs",
                named.collect::<Vec<String>>().join(", ")
            ),
            counts[OutcomeClass::ALL.len() - 1] as f64,
            0.0,
        ),
        Check::new("The same: number of runs", runs as f64, 40.0..=f64::MAX),
    ]
}
