//! The steps that are counted and timed, as `evidence/steps.toml` lists them.

use crate::benchmarks::REPEATS;
use crate::benchmarks::count::{self, ENDS};
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};
use std::path::Path;
use studies::machine::median;

/// Step of all rows \[s\].
pub const STEP: f64 = 1e-5;
/// Differences that are timed: each is of some milliseconds.
const TIMED: usize = 5 * REPEATS;

/// The list.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StepList {
    steps: Vec<StepRow>,
}

/// A scene and a method.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRow {
    /// Its name on the page.
    pub name: String,
    /// The scene, from the root of the workspace.
    pub scene: String,
    /// Changes to the scene.
    #[serde(default)]
    set: Vec<String>,
}

/// What a step costs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StepCost {
    /// Name of the row.
    pub name: String,
    /// Instructions.
    pub instructions: u64,
    /// Processor time \[s\].
    pub seconds: f64,
}

/// Reads the list.
///
/// # Errors
/// When it is not there or has faults.
pub fn read(root: &Path) -> Result<Vec<StepRow>> {
    let path = root.join("evidence/steps.toml");
    let text = std::fs::read_to_string(&path).into_diagnostic();
    let list = text.and_then(|text| toml::from_str(&text).into_diagnostic());
    let StepList { steps } = list.wrap_err_with(|| path.display().to_string())?;
    Ok(steps)
}

impl StepRow {
    /// Changes to the scene for a run that ends at `end` \[s\] and records almost nothing.
    pub fn overrides(&self, end: f64) -> Vec<String> {
        let own = [
            format!("simulation.duration={end}"),
            format!("integrator.step={STEP}"),
            "output.interval=1e-3".to_owned(),
        ];
        [&own[..], &self.set].concat()
    }

    /// Counts and times the step.
    ///
    /// # Errors
    /// When Valgrind is missing or a run fails.
    pub fn cost(&self, root: &Path, program: &Path) -> Result<StepCost> {
        let difference = || Ok((self.run(root, ENDS[1])? - self.run(root, ENDS[0])?) * STEP);
        let seconds = (0..TIMED)
            .map(|_| difference())
            .collect::<Result<Vec<f64>>>()?;
        Ok(StepCost {
            name: self.name.clone(),
            instructions: count::per_step(program, root, self)?,
            seconds: median(&seconds) / (ENDS[1] - ENDS[0]),
        })
    }

    /// Processor time of a run \[s\].
    fn run(&self, root: &Path, end: f64) -> Result<f64> {
        let scene = Scene::load(&root.join(&self.scene), &self.overrides(end))?;
        let mut simulation = Simulation::new(&scene)?;
        let clock = ThreadTime::now();
        simulation.run(&mut ()).into_diagnostic()?;
        Ok(clock.elapsed().as_secs_f64())
    }
}
