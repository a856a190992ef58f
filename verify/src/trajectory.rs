//! The same scene on both sides, as columns with the same names.

use crate::ida_of_system::{LinearSolver, NEWTON};
use crate::reference::{LIMIT, LsRest, LsTolerances, ReferenceScene};
use looselink::scene::Scene;
use looselink::simulate::{CriticalKind, FoundRest, Recording, RunError, Simulation, Stability};
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

/// An equilibrium.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedRest {
    /// Smallest eigenvalue of the stiffness relative to the masses \[1/s2\], 0 where nothing can move.
    pub eigenvalue: f64,
    /// 1 stable, 0 neutral, -1 unstable.
    pub stability: i32,
    /// The coordinate that moves most in its motion, in the words of this side; none where nothing can move.
    pub moves: Option<String>,
}

/// A point at which a static analysis loses or regains stability.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedCriticalPoint {
    /// The measure of the load.
    pub t: f64,
    /// The same as part of the full load.
    pub part: f64,
    /// True of a limit point, false of a bifurcation.
    pub is_limit: bool,
    /// The coordinate that moves most in the motion without resistance, in the words of this side.
    pub moves: String,
}

/// What one side computed.
#[derive(Debug)]
pub struct Trajectory {
    /// Columns, the time `t` among them, by the names of Looselink's channels.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Contacts that closed, in order.
    pub impacts: Vec<ComparedImpact>,
    /// The equilibrium of the start, or the last one of a static analysis.
    pub rest: Option<ComparedRest>,
    /// Those of a static analysis, in the order of its path; the last one may have ended it.
    pub critical_points: Vec<ComparedCriticalPoint>,
}

impl Trajectory {
    /// A column.
    pub fn get(&self, name: &str) -> &[f64] {
        let column = self.columns.get(name);
        column.unwrap_or_else(|| panic!("no column {name}"))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.get("t").len()
    }

    /// The first rows, and the last one if it comes later.
    pub fn first(&self, rows: usize, with_last: bool) -> Trajectory {
        let last = self.rows() - 1;
        let keep = |i: usize| i < rows || (with_last && i == last);
        let kept = |column: &Vec<f64>| {
            let values = column.iter().enumerate().filter(|(i, _)| keep(*i));
            values.map(|(_, value)| *value).collect()
        };
        let columns = self.columns.iter();
        Trajectory {
            columns: columns
                .map(|(name, column)| (name.clone(), kept(column)))
                .collect(),
            impacts: self.impacts.clone(),
            rest: self.rest.clone(),
            critical_points: self.critical_points.clone(),
        }
    }
}

impl ComparedRest {
    fn of_looselink(rest: &FoundRest) -> ComparedRest {
        let moves = Some(rest.moves_most.clone());
        ComparedRest {
            eigenvalue: rest.smallest_eigenvalue.unwrap_or(0.0),
            stability: match rest.stability() {
                Stability::Stable => 1,
                Stability::Neutral => 0,
                Stability::Unstable => -1,
            },
            moves: moves.filter(|moves| !moves.is_empty()),
        }
    }

    fn of_reference(scene: &ReferenceScene, rest: &LsRest) -> ComparedRest {
        let coordinate = usize::try_from(rest.coordinate).ok();
        ComparedRest {
            eigenvalue: rest.eigenvalue,
            stability: rest.stability,
            moves: coordinate.map(|i| scene.coordinates[i].clone()),
        }
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
            // it is among the critical points
            Err(RunError::Limit(_)) => {}
            result => result.into_diagnostic().wrap_err_with(|| self.name())?,
        }
        let closed = recording.onsets.iter().map(|onset| ComparedImpact {
            t: onset.t,
            joint: onset.joint.clone(),
            velocity: onset.impact_velocity,
        });
        let report = simulation.report();
        let critical = report.critical_points.iter();
        let critical = critical.map(|point| ComparedCriticalPoint {
            t: point.t,
            part: point.part,
            is_limit: point.kind == CriticalKind::Limit,
            moves: point.moves_most.clone(),
        });
        Ok(Trajectory {
            impacts: closed.collect(),
            columns: recording.into_columns().collect(),
            rest: report.rest.as_ref().map(ComparedRest::of_looselink),
            critical_points: critical.collect(),
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
            if matches!(&row, Err(error) if error.code == LIMIT) {
                break;
            }
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
        // a motion that does not start in equilibrium has none
        let rest = run.rest().or_else(|_| scene.rest()).ok();
        let critical = run.critical_points().into_iter();
        let critical = critical.map(|point| ComparedCriticalPoint {
            t: point.t,
            part: point.part,
            is_limit: point.is_limit != 0,
            moves: scene.coordinates[point.coordinate as usize].clone(),
        });
        Ok(Trajectory {
            columns: scene.channels.iter().cloned().zip(columns).collect(),
            impacts: closed,
            rest: rest.map(|rest| ComparedRest::of_reference(&scene, &rest)),
            critical_points: critical.collect(),
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
