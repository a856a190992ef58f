//! The same scene on both sides, as columns with the same names.

use crate::ida_of_system::{LinearSolver, NEWTON};
use crate::reference::{LsTolerances, ReferenceScene};
use looselink::scene::Scene;
use looselink::simulate::{Recording, RunError, Simulation};
use miette::{IntoDiagnostic, Result, WrapErr};
use records::root;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Coordinates up to which IDA's Newton matrix is factorised as a dense one; KLU takes the larger ones.
const DENSE: usize = 100;

/// What to run: a scene of the project, rows every `interval` up to `duration`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComparisonPlan {
    /// Path below `scenes/` without the extension, or of a file with it.
    pub scene: String,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Time between rows \[s\].
    pub interval: f64,
    /// Overrides `path=value` that change the mechanism.
    #[serde(default)]
    pub overrides: Vec<String>,
    /// What the overrides make of it, for reports.
    #[serde(default)]
    pub variant: String,
}

/// A contact that closes.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedImpact {
    /// When \[s\].
    pub t: f64,
    /// Name of the joint.
    pub joint: String,
    /// Impact velocity \[m/s\].
    pub velocity: f64,
}

/// What one side computed.
#[derive(Debug)]
pub struct Trajectory {
    /// Columns, the time `t` among them, by the names of Looselink's channels.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Contacts that closed, in order.
    pub impacts: Vec<ComparedImpact>,
}

impl Trajectory {
    /// A column.
    pub fn get(&self, name: &str) -> &[f64] {
        let column = self.columns.get(name);
        column.unwrap_or_else(|| panic!("no column {name}"))
    }
}

impl ComparisonPlan {
    /// A plan without overrides.
    pub fn new(scene: impl Into<String>, duration: f64, interval: f64) -> ComparisonPlan {
        ComparisonPlan {
            scene: scene.into(),
            duration,
            interval,
            overrides: Vec::new(),
            variant: String::new(),
        }
    }

    /// The same with more overrides.
    pub fn with(mut self, overrides: &[String]) -> ComparisonPlan {
        self.overrides.extend_from_slice(overrides);
        self
    }

    /// The file.
    pub fn path(&self) -> PathBuf {
        match self.scene.ends_with(".toml") {
            true => PathBuf::from(&self.scene),
            false => root().join(format!("scenes/{}.toml", self.scene)),
        }
    }

    /// How reports name it.
    pub fn name(&self) -> String {
        let name = self.scene.trim_start_matches("3rrr/");
        name.trim_start_matches("../verify/scenes/").to_owned() + &self.variant
    }

    /// Overrides of both sides.
    fn overrides(&self) -> Vec<String> {
        let output = [
            format!("output.interval={:e}", self.interval),
            format!("simulation.duration={:?}", self.duration),
            "output.channels=[\"*\"]".to_owned(),
        ];
        [&self.overrides[..], &output].concat()
    }

    /// The scene as Looselink reads it, with a step in seconds or its own.
    pub fn scene(&self, step: Option<f64>) -> Result<Scene> {
        let mut overrides = self.overrides();
        overrides.extend(step.map(|step| format!("integrator.step={step:e}")));
        Ok(Scene::load(&self.path(), &overrides)?)
    }

    /// The scene as the reference reads it.
    pub fn reference(&self) -> Result<ReferenceScene> {
        let text = std::fs::read_to_string(self.path()).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", self.path().display()))?;
        let scene = ReferenceScene::read(&text, &self.overrides()).into_diagnostic();
        scene.wrap_err_with(|| self.name())
    }

    /// Looselink's trajectory with this step \[s\].
    pub fn rust(&self, step: f64) -> Result<Trajectory> {
        self.run(Some(step), usize::MAX)
    }

    /// Looselink's trajectory with a step or the scene's own, ended once `impacts` contacts have closed.
    pub fn run(&self, step: Option<f64>, impacts: usize) -> Result<Trajectory> {
        let scene = self.scene(step)?;
        let mut simulation = Simulation::new(&scene)?;
        let mut recording = Recording::new(&simulation);
        recording.most_onsets = impacts;
        match simulation.run(&mut recording) {
            Err(RunError::Interrupted { .. }) if recording.onsets.len() >= impacts => {}
            result => result.into_diagnostic().wrap_err_with(|| self.name())?,
        }
        let closed = recording.onsets.iter().map(|onset| ComparedImpact {
            t: onset.t,
            joint: onset.joint.clone(),
            velocity: onset.impact_velocity,
        });
        Ok(Trajectory {
            impacts: closed.collect(),
            columns: recording.into_columns().collect(),
        })
    }

    /// The reference's trajectory with these tolerances.
    pub fn cpp(&self, tolerances: &LsTolerances) -> Result<Trajectory> {
        self.cpp_until(tolerances, usize::MAX)
    }

    /// The reference's trajectory, ended at the first row after `impacts` contacts have closed.
    pub fn cpp_until(&self, tolerances: &LsTolerances, impacts: usize) -> Result<Trajectory> {
        let scene = self.reference()?;
        let tolerances = LsTolerances {
            linear_solver: i32::from(linear_solver(&scene) == LinearSolver::Klu),
            ..*tolerances
        };
        let mut columns = vec![Vec::new(); scene.channels.len()];
        let mut closed = Vec::new();
        let mut run = scene.run(&tolerances).into_diagnostic()?;
        let (mut seen, last) = (0, (self.duration / self.interval).round() as usize);
        for k in 0..=last {
            let row = run.advance((k as f64 * self.interval).min(self.duration));
            let row = row.into_diagnostic().wrap_err_with(|| self.name())?;
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(value);
            }
            let events = run.events(seen);
            seen += events.len();
            let onsets = events.iter().filter(|event| event.onset != 0);
            closed.extend(onsets.map(|event| ComparedImpact {
                t: event.time,
                joint: scene.joints[event.joint as usize].clone(),
                velocity: event.velocity,
            }));
            if closed.len() >= impacts {
                closed.truncate(impacts);
                break;
            }
        }
        Ok(Trajectory {
            columns: scene.channels.iter().cloned().zip(columns).collect(),
            impacts: closed,
        })
    }
}

/// What factorises IDA's Newton matrix.
fn linear_solver(scene: &ReferenceScene) -> LinearSolver {
    match scene.coordinates.len() > DENSE {
        true => LinearSolver::Klu,
        false => LinearSolver::Dense,
    }
}

/// Tolerances of IDA: `relative`, and absolute ones that fit it for a mechanism of some decimetres at some 0.1 m/s.
pub fn tolerances(relative: f64) -> LsTolerances {
    LsTolerances {
        relative,
        position: 1e-3 * relative,
        velocity: 0.1 * relative,
        max_step: 0.0,
        // tighter than IDA's own: the drift of energy counts
        newton: NEWTON[0],
        max_order: 5,
        linear_solver: 0,
        max_steps: 100_000_000,
    }
}
