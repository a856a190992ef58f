//! The scenes of the project with steps far too long.

use super::yes;
use crate::stability::map::{UNSAID, difference};
use crate::stability::outcome::{OutcomeClass, Stopped, judge, judge_stop, largest, record};
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Recording, Report};
use std::path::Path;
use verify::compare::scenes;

/// Long steps that are taken.
const STEPS: f64 = 20.0;

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
    let plans = scenes::of(Analysis::Dynamic).expect("the folder of scenes");
    let (mut silent, mut runs) = (0.0, 0.0);
    // without those of `verify`
    for plan in plans.iter().filter(|plan| !plan.scene.starts_with("..")) {
        let path = plan.path();
        let scene = Scene::load(&path, &[]).expect("a scene of the project");
        let Some(step) = scene.integrator.step() else {
            continue;
        };
        for long in [10.0 * step, 100.0 * step] {
            let Ok((exact, _)) = rows(&path, step, long) else {
                continue;
            };
            let outcome = match rows(&path, long, long) {
                Ok((recording, report)) => {
                    let columns = exact.names()[1..].iter().filter_map(|name| exact.get(name));
                    let range = largest(columns.flat_map(|x| x.iter().map(|v| v - x[0])));
                    let error = difference(&exact, &recording);
                    judge(error, 0.01 * range, range, UNSAID, &report)
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
