//! What a study file says.

use crate::study_file::{StudyError, parsed, text_of};
use looselink::scene::{Scene, SceneError};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::{Path, PathBuf};

/// A smoke test of a study of statistics simulates this part of the time.
const SMOKE: f64 = 0.02;

/// A scene, a reference and the curves that are compared with it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// What is studied, in a line.
    pub title: String,
    /// The scene, a path beside the study file.
    pub scene: PathBuf,
    /// Overrides `path=value` of every run.
    #[serde(default)]
    pub set: Vec<String>,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Time between the rows that are compared \[s\].
    pub interval: f64,
    /// Channels whose largest difference is the error of position \[m\].
    pub position: Vec<String>,
    /// Channels whose largest difference is the error of acceleration \[m/s2\].
    #[serde(default)]
    pub acceleration: Vec<String>,
    /// Channels of force whose difference, integrated over time, is the error of impulse \[N s\].
    #[serde(default)]
    pub force: Vec<String>,
    /// What the curves are compared with.
    pub reference: ReferenceRuns,
    /// Present where not the motion is compared, which chaos has taken apart, but its statistics.
    pub statistics: Option<Sampling>,
    /// Methods with their steps or accuracies.
    pub curves: Vec<StudyCurve>,
}

/// Which part of a run statistics are of.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sampling {
    /// Start of that part \[s\].
    pub from: f64,
    /// Channels that are 1 in contact and 0 out of it.
    pub contact: Vec<String>,
}

/// Two runs of a method that none of the curves depends on: the difference between them is the floor.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReferenceRuns {
    /// Overrides that choose the method.
    pub set: Vec<String>,
    /// Elements of every flexible link; as in the scene unless given.
    pub elements: Option<usize>,
    /// Coarse and fine step \[s\].
    pub steps: [f64; 2],
}

/// One curve.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyCurve {
    /// Its name in diagrams and tables.
    pub name: String,
    /// Overrides that choose the method, or change the mechanism.
    #[serde(default)]
    pub set: Vec<String>,
    /// Elements of every flexible link; as in the scene unless given.
    pub elements: Option<usize>,
    /// Steps \[s\]; or
    #[serde(default)]
    pub steps: Vec<f64>,
    /// accuracies \[m\]
    #[serde(default)]
    pub accuracies: Vec<f64>,
    /// with, where given, this accuracy of the balance of energies \[J\] ...
    pub energy: Option<f64>,
    /// ... over this time \[s\]; the duration of the study unless given.
    pub horizon: Option<f64>,
}

/// What the steps of a run follow.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StudyPace {
    /// A step \[s\].
    Step(f64),
    /// An accuracy \[m\] over a horizon \[s\].
    Accuracy {
        /// Error allowed in positions.
        position: f64,
        /// Error allowed in the balance of energies \[J\].
        #[serde(skip_serializing_if = "Option::is_none")]
        energy: Option<f64>,
        /// Time over which it may gather.
        horizon: f64,
    },
    /// The relative tolerance of a program that is not ours.
    Tolerance(f64),
}

impl fmt::Display for StudyPace {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            StudyPace::Step(step) => write!(f, "step {}", numbers::si(*step, "s")),
            StudyPace::Accuracy {
                position, energy, ..
            } => {
                write!(f, "accuracy {}", numbers::si(*position, "m"))?;
                energy.map_or(Ok(()), |e| write!(f, " and {}", numbers::si(e, "J")))
            }
            StudyPace::Tolerance(relative) => write!(f, "tolerance {relative:e}"),
        }
    }
}

impl StudyPace {
    /// The pace between this one and another of the same curve.
    pub(super) fn towards(self, other: StudyPace, between: impl Fn(f64, f64) -> f64) -> StudyPace {
        match (self, other) {
            (StudyPace::Step(a), StudyPace::Step(b)) => StudyPace::Step(between(a, b)),
            (
                StudyPace::Accuracy { position: a, .. },
                StudyPace::Accuracy {
                    position: b,
                    energy,
                    horizon,
                },
            ) => StudyPace::Accuracy {
                position: between(a, b),
                energy,
                horizon,
            },
            (StudyPace::Tolerance(a), StudyPace::Tolerance(b)) => {
                StudyPace::Tolerance(between(a, b))
            }
            _ => other,
        }
    }
}

impl ReferenceRuns {
    /// Coarse and fine.
    pub fn paces(&self) -> [StudyPace; 2] {
        self.steps.map(StudyPace::Step)
    }
}

impl StudyCurve {
    /// Its points.
    pub fn paces(&self) -> Vec<StudyPace> {
        let steps = self.steps.iter().map(|h| StudyPace::Step(*h));
        let horizon = self.horizon.unwrap_or(f64::NAN);
        let accuracies = self.accuracies.iter().map(|position| StudyPace::Accuracy {
            position: *position,
            energy: self.energy,
            horizon,
        });
        steps.chain(accuracies).collect()
    }
}

impl Study {
    /// Reads a study and checks what can be seen without its scene.
    ///
    /// # Errors
    /// A file that cannot be read, or a fault with its line.
    pub fn load(path: &Path) -> Result<Study, StudyError> {
        Study::parse(path, &text_of(path)?)
    }

    /// Reads a study from text; `path` stands for the file in errors, and the scene is looked for beside it.
    ///
    /// # Errors
    /// The first fault found, with its line.
    pub fn parse(path: &Path, text: &str) -> Result<Study, StudyError> {
        let mut study: Study = parsed(path, text)?;
        let fault = |message: String| Err(StudyError::of(path, message));
        for (key, value) in [("duration", study.duration), ("interval", study.interval)] {
            if !(value > 0.0 && value.is_finite()) {
                return fault(format!("`{key}` must be greater than zero, not {value}"));
            }
        }
        if study.position.is_empty() || study.curves.is_empty() {
            return fault("a study needs at least one channel in `position` and one curve".into());
        }
        let [coarse, fine] = study.reference.steps;
        if fine.partial_cmp(&coarse) != Some(std::cmp::Ordering::Less) {
            return fault(format!(
                "`reference.steps` must be a coarse and a fine step, not {coarse:e} and {fine:e}"
            ));
        }
        for (i, curve) in study.curves.iter_mut().enumerate() {
            if curve.steps.is_empty() == curve.accuracies.is_empty() {
                return fault(format!(
                    "`curves.{i}` ({}) needs either `steps` or `accuracies`",
                    curve.name
                ));
            }
            curve.horizon = curve.horizon.or(Some(study.duration));
        }
        if let Some(Sampling { from, contact }) = &study.statistics
            && !(*from >= 0.0 && *from < study.duration && !contact.is_empty())
        {
            return fault(
                "`statistics` needs a `from` within the duration and channels of `contact`".into(),
            );
        }
        study.scene = path.with_file_name(&study.scene);
        Ok(study)
    }

    /// Name of the scene's file without the extension.
    pub(super) fn scene_name(&self) -> String {
        let stem = self.scene.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }

    /// The same, much shorter, to see that it works.
    pub(super) fn brief(&self) -> Study {
        let mut study = self.clone();
        let rows = (SMOKE * study.duration / study.interval).round();
        study.duration = rows * study.interval;
        if let Some(statistics) = &mut study.statistics {
            statistics.from = (0.5 * rows).round() * study.interval;
        }
        study
    }

    /// True of a study whose curves are numbers of elements: it compares meshes, not methods.
    pub fn compares_elements(&self) -> bool {
        self.curves.iter().any(|curve| curve.elements.is_some())
    }

    /// The scene of a run.
    ///
    /// # Errors
    /// A fault of the scene.
    pub fn scene(
        &self,
        set: &[String],
        elements: Option<usize>,
        pace: StudyPace,
    ) -> Result<Scene, SceneError> {
        let mut channels = [&self.position[..], &self.acceleration, &self.force].concat();
        if let Some(statistics) = &self.statistics {
            channels.extend_from_slice(&statistics.contact);
        }
        channels.push("energy.numerical".to_owned());
        if self.statistics.is_some() {
            channels.push("energy.contact_dissipated".to_owned());
        }
        let mut overrides = self.set.clone();
        overrides.extend_from_slice(set);
        if let Some(elements) = elements {
            let scene = Scene::load(&self.scene, &overrides)?;
            let links = scene.bodies.iter().filter(|body| !body.kind.is_rigid());
            overrides.extend(links.map(|link| format!("bodies.{}.elements={elements}", link.name)));
        }
        overrides.extend([
            format!("simulation.duration={:?}", self.duration),
            format!("output.interval={:?}", self.interval),
            format!("output.channels={channels:?}"),
            match pace {
                StudyPace::Step(step) => format!("integrator.step={step:?}"),
                StudyPace::Accuracy {
                    position,
                    energy,
                    horizon,
                } => {
                    let energy = energy.map_or(String::new(), |e| format!("energy = {e:?}, "));
                    format!("integrator.accuracy={{ position = {position:?}, {energy}horizon = {horizon:?} }}")
                }
                StudyPace::Tolerance(_) => unreachable!("curves of a study have steps or accuracies"),
            },
        ]);
        Scene::load(&self.scene, &overrides)
    }
}
