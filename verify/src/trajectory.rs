//! The same scene on both sides, as columns with the same names.

use crate::ida_of_system::{LinearSolver, NEWTON};
use crate::reference::{LsStatistics, LsTolerances, ReferenceScene};
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::{Recording, RunError, Simulation};
use miette::{IntoDiagnostic, Result, WrapErr};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Coordinates up to which IDA's Newton matrix is factorised as a dense one; KLU takes the larger ones.
const DENSE: usize = 100;

/// What to run: a scene of the project, rows every `interval` up to `duration`.
#[derive(Debug, Clone)]
pub struct ComparisonPlan {
    /// Path below `scenes/` without the extension, or of a file.
    pub scene: String,
    /// The file.
    pub path: PathBuf,
    /// Overrides `path=value` that change the mechanism.
    pub overrides: Vec<String>,
    /// What the overrides make of it, for reports.
    pub variant: &'static str,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Time between rows \[s\].
    pub interval: f64,
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
    /// Direction of the eccentricity \[rad\] and the largest penetration of a contact that has been lost again \[m\], where
    /// they were kept.
    pub course: Option<[f64; 2]>,
}

/// What one side computed.
#[derive(Debug)]
pub struct Trajectory {
    /// Columns, the time `t` among them, by the names of Looselink's channels.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Contacts that closed, in order.
    pub impacts: Vec<ComparedImpact>,
    /// Processor time of IDA \[s\], the start and what reads the scene left out.
    pub seconds: f64,
    /// Counts of IDA.
    pub counts: LsStatistics,
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
        let scene = scene.into();
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        ComparisonPlan {
            path: root.join(format!("{scene}.toml")),
            scene,
            overrides: Vec::new(),
            variant: "",
            duration,
            interval,
        }
    }

    /// A scene anywhere, with overrides that change the mechanism.
    pub fn of_file(
        scene: &Path,
        overrides: &[String],
        duration: f64,
        interval: f64,
    ) -> ComparisonPlan {
        ComparisonPlan {
            path: scene.to_owned(),
            overrides: overrides.to_vec(),
            ..ComparisonPlan::new(scene.display().to_string(), duration, interval)
        }
    }

    /// The same with overrides, called `variant` in reports.
    pub fn with(mut self, variant: &'static str, overrides: &[&str]) -> ComparisonPlan {
        self.variant = variant;
        self.overrides
            .extend(overrides.iter().map(|o| (*o).to_owned()));
        self
    }

    /// The same with friction that acts against the slip of the material, in every loose joint.
    pub fn with_friction(self) -> ComparisonPlan {
        let friction = "contacts.pin.friction={law=\"ambrosio\",coefficient=0.1,v0=1e-4,v1=1e-3}";
        self.with(", friction against material slip", &[friction])
    }

    /// How reports name it.
    pub fn name(&self) -> String {
        let name = self.scene.trim_start_matches("3rrr/");
        name.trim_start_matches("../verify/scenes/").to_owned() + self.variant
    }

    /// Overrides of both sides.
    fn overrides(&self) -> Vec<String> {
        let mut overrides = self.overrides.clone();
        overrides.extend([
            format!("output.interval={:e}", self.interval),
            format!("simulation.duration={:?}", self.duration),
            "output.channels=[\"*\"]".to_owned(),
        ]);
        overrides
    }

    /// The scene as Looselink reads it, with a step in seconds or its own.
    pub fn scene(&self, step: Option<f64>) -> Result<Scene> {
        let mut overrides = self.overrides();
        overrides.extend(step.map(|step| format!("integrator.step={step:e}")));
        Ok(Scene::load(&self.path, &overrides)?)
    }

    /// The scene as the reference reads it.
    pub fn reference(&self) -> Result<ReferenceScene> {
        let text = std::fs::read_to_string(&self.path).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", self.path.display()))?;
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
            course: onset.end.map(|_| [onset.angle, onset.deepest_penetration]),
        });
        Ok(Trajectory {
            impacts: closed.collect(),
            columns: recording.into_columns().collect(),
            seconds: 0.0,
            counts: LsStatistics::default(),
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
        // impacts so far; for every joint in contact the index of its impact and the direction of its eccentricity
        let mut closed: Vec<ComparedImpact> = Vec::new();
        let mut angles = BTreeMap::new();
        let clock = ThreadTime::now();
        let mut run = scene.run(&tolerances).into_diagnostic()?;
        let mut seconds = clock.elapsed().as_secs_f64();
        let (mut seen, last) = (0, (self.duration / self.interval).round() as usize);
        for k in 0..=last {
            let clock = ThreadTime::now();
            let row = run.advance((k as f64 * self.interval).min(self.duration));
            let row = row.into_diagnostic().wrap_err_with(|| self.name())?;
            seconds += clock.elapsed().as_secs_f64();
            for (column, value) in columns.iter_mut().zip(row) {
                column.push(value);
            }
            let events = run.events(seen);
            seen += events.len();
            for e in events {
                if e.onset != 0 {
                    let [x, y] = e.eccentricity;
                    angles.insert(e.joint, (closed.len(), y.atan2(x)));
                    let joint = usize::try_from(e.joint).into_diagnostic()?;
                    closed.push(ComparedImpact {
                        t: e.time,
                        joint: scene.joints[joint].clone(),
                        velocity: e.velocity,
                        course: None,
                    });
                } else if let Some((impact, angle)) = angles.remove(&e.joint) {
                    closed[impact].course = Some([angle, e.deepest]);
                }
            }
            if closed.len() >= impacts {
                closed.truncate(impacts);
                break;
            }
        }
        let names = scene.channels.iter().cloned();
        Ok(Trajectory {
            columns: names.zip(columns).collect(),
            impacts: closed,
            seconds,
            counts: run.statistics(),
        })
    }
}

/// What factorises IDA's Newton matrix.
pub fn linear_solver(scene: &ReferenceScene) -> LinearSolver {
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
