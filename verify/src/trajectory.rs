//! The same scene on both sides, as columns with the same names.

use crate::channels::Channels;
use crate::description::{Description, describe};
use crate::embedding::Embedding;
use crate::reference::{Row, Statistics, System, Tolerances};
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, Simulation};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What to run: a scene of the project, rows every `interval` up to `duration`.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Path below `scenes/` without the extension, or of a file.
    pub scene: Cow<'static, str>,
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
pub struct Impact {
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
    /// Time \[s\].
    pub t: Vec<f64>,
    /// Columns by the names of Looselink's channels.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Contacts that closed, in order.
    pub impacts: Vec<Impact>,
    /// Processor time of the integration \[s\], the start and what reads the scene left out.
    pub seconds: f64,
    /// Work of the solver.
    pub work: Work,
}

/// Work of a solver.
#[derive(Debug, Clone)]
pub enum Work {
    /// Looselink's own report.
    Rust(Box<Report>),
    /// Counts of IDA.
    Cpp(Statistics),
}

impl Trajectory {
    /// A column.
    ///
    /// # Panics
    /// When there is none of this name: callers name what their scene has.
    pub fn get(&self, name: &str) -> &[f64] {
        let column = self.columns.get(name);
        column.unwrap_or_else(|| panic!("no column {name}"))
    }
}

impl Plan {
    /// A plan without overrides.
    pub fn new(scene: &'static str, duration: f64, interval: f64) -> Plan {
        Plan {
            scene: scene.into(),
            overrides: Vec::new(),
            variant: "",
            duration,
            interval,
        }
    }

    /// A scene anywhere, with overrides that change the mechanism.
    pub fn of_file(scene: &Path, overrides: &[String], duration: f64, interval: f64) -> Plan {
        Plan {
            scene: scene
                .with_extension("")
                .to_string_lossy()
                .into_owned()
                .into(),
            overrides: overrides.to_vec(),
            variant: "",
            duration,
            interval,
        }
    }

    /// The same with overrides, called `variant` in reports.
    pub fn with(mut self, variant: &'static str, overrides: &[String]) -> Plan {
        self.variant = variant;
        self.overrides.extend_from_slice(overrides);
        self
    }

    /// The same with friction that acts against the slip of the material, in every loose joint.
    pub fn with_friction(self) -> Plan {
        let friction = "contacts.pin.friction={law=\"ambrosio\",coefficient=0.1,v0=1e-4,v1=1e-3}";
        self.with(", friction against material slip", &[friction.to_owned()])
    }

    /// How reports name it.
    pub fn name(&self) -> String {
        let name = self.scene.trim_start_matches("3rrr/");
        name.trim_start_matches("../verify/scenes/").to_owned() + self.variant
    }

    /// File of the scene.
    pub fn path(&self) -> PathBuf {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../scenes");
        root.join(&*self.scene).with_extension("toml")
    }

    /// The scene as Looselink reads it; `step` in seconds.
    ///
    /// # Errors
    /// A scene that is faulty.
    pub fn scene(&self, step: f64) -> Result<Scene> {
        let mut overrides = self.overrides.clone();
        overrides.extend([
            format!("integrator.step={step:e}"),
            format!("output.interval={:e}", self.interval),
            format!("simulation.duration={:?}", self.duration),
            "output.channels=[\"*\"]".to_owned(),
        ]);
        Ok(Scene::load(&self.path(), &overrides)?)
    }

    /// The scene as the reference takes it.
    ///
    /// # Errors
    /// A scene that the reference does not know.
    pub fn description(&self) -> Result<Description> {
        let path = self.path();
        let text = std::fs::read_to_string(&path).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", path.display()))?;
        describe(&text, &self.overrides)
    }

    /// Looselink's trajectory with this step \[s\].
    ///
    /// # Errors
    /// A scene or a run that fails.
    pub fn rust(&self, step: f64) -> Result<Trajectory> {
        self.rust_until(step, usize::MAX)
    }

    /// Looselink's trajectory, ended once `impacts` contacts have closed.
    ///
    /// # Errors
    /// A scene or a run that fails.
    pub fn rust_until(&self, step: f64, impacts: usize) -> Result<Trajectory> {
        let scene = self.scene(step)?;
        let mut simulation = Simulation::new(&scene)?;
        let mut recording = Recording::new(&simulation);
        recording.most_onsets = impacts;
        let clock = ThreadTime::now();
        match simulation.run(&mut recording) {
            Err(looselink::simulate::RunError::Interrupted { .. })
                if recording.onsets.len() >= impacts => {}
            result => result.into_diagnostic().wrap_err_with(|| self.name())?,
        }
        let seconds = clock.elapsed().as_secs_f64();
        let closed = recording.onsets.iter().map(|onset| Impact {
            t: onset.t,
            joint: onset.joint.clone(),
            velocity: onset.impact_velocity,
            course: onset.end.map(|_| [onset.angle, onset.deepest_penetration]),
        });
        let closed = closed.collect();
        let mut columns: BTreeMap<_, _> = recording.into_columns().collect();
        let t = columns
            .remove("t")
            .ok_or_else(|| miette!("no time channel"))?;
        Ok(Trajectory {
            t,
            columns,
            impacts: closed,
            seconds,
            work: Work::Rust(Box::new(simulation.report())),
        })
    }

    /// Where the reference starts: at the ideal mechanism of a path, otherwise where Looselink has assembled the scene.
    fn start(&self, description: &Description, system: &System) -> Result<(Vec<f64>, Vec<f64>)> {
        if !description.mechanism.legs.is_empty() {
            return system.start(0.0).into_diagnostic();
        }
        let simulation = Simulation::new(&self.scene(self.interval)?)?;
        let (model, at) = (simulation.model(), simulation.state());
        let embedding = Embedding::new(description, model, model.shape().coordinates);
        Ok((embedding.spread(&at.q), embedding.spread(&at.v)))
    }

    /// The reference's trajectory with these tolerances.
    ///
    /// # Errors
    /// A scene that the reference does not know, or a failure of IDA.
    pub fn cpp(&self, tolerances: &Tolerances) -> Result<Trajectory> {
        self.cpp_until(tolerances, usize::MAX)
    }

    /// The reference's trajectory, ended at the first row after `impacts` contacts have closed.
    ///
    /// # Errors
    /// A scene that the reference does not know, or a failure of IDA.
    pub fn cpp_until(&self, tolerances: &Tolerances, impacts: usize) -> Result<Trajectory> {
        let description = self.description()?;
        let system = System::new(&description.mechanism).into_diagnostic()?;
        let (q, v) = self.start(&description, &system)?;
        let mut channels = Channels::new(&description);
        let (mut t, mut row, mut seconds) = (Vec::new(), Row::default(), 0.0);
        // impacts so far; for every joint in contact the index of its impact and the direction of its eccentricity
        let mut closed: Vec<Impact> = Vec::new();
        let mut angles = BTreeMap::new();
        let clock = ThreadTime::now();
        let mut run = system.run(0.0, &q, &v, tolerances).into_diagnostic()?;
        seconds += clock.elapsed().as_secs_f64();
        let (mut seen, last) = (0, (self.duration / self.interval).round() as usize);
        for k in 0..=last {
            let clock = ThreadTime::now();
            let to = (k as f64 * self.interval).min(self.duration);
            run.advance(to, &mut row)
                .into_diagnostic()
                .wrap_err_with(|| self.name())?;
            seconds += clock.elapsed().as_secs_f64();
            t.push(row.t);
            channels.add(&system, &row)?;
            let events = run.events(seen);
            seen += events.len();
            for e in events {
                let joint = &description.joints[e.joint];
                if e.onset {
                    let [x, y] = e.eccentricity;
                    angles.insert(e.joint, (closed.len(), y.atan2(x)));
                    closed.push(Impact {
                        t: e.t,
                        joint: joint.clone(),
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
        Ok(Trajectory {
            t,
            columns: channels.columns,
            impacts: closed,
            seconds,
            work: Work::Cpp(run.statistics()),
        })
    }
}

/// Tolerances of IDA: `relative`, and absolute ones that fit it for a mechanism of some decimetres at some 0.1 m/s.
pub fn tolerances(relative: f64, position: f64, velocity: f64) -> Tolerances {
    Tolerances {
        relative,
        position,
        velocity,
        max_step: 0.0,
        max_order: 5,
        reserved: 0,
        max_steps: 100_000_000,
    }
}
