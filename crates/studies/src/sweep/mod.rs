//! Sweeps: a scene at many points of its parameters, one row a run.
//!
//! A [`Sweep`] says what each run is ([`Task`]); [`execute`] makes runs on all cores and [`Store`] keeps their rows, each on the
//! disk before the next run of its thread begins; [`merge`] makes tables and pictures of them. Rows do not depend on the number
//! of threads or processes, nor on interruptions.

pub mod bisection;
pub mod columns;
mod csv_table;
pub mod design;
mod envelope;
mod execute;
mod measure;
mod merge;
mod page;
mod parameter;
#[cfg(feature = "parquet")]
mod parquet_table;
mod pictures;
mod recorded;
mod row;
mod run;
mod sobol_indices;
mod starts;
mod statistics;
mod store;
mod study;
mod value;

pub use bisection::{Crossing, SweepTarget};
pub use envelope::{Envelope, EnvelopePlan};
pub use execute::{SweepProgress, execute};
pub use measure::{CONTACTS, ContactMeasure, Measure, SERIES, SeriesMeasure};
pub use merge::{FILES, Merged, merge};
pub use parameter::{ParameterField, ScaledField, Spacing, SweepParameter};
pub use recorded::Recorded;
pub use row::{RowTiming, RunStatus, SweepRow};
pub use sobol_indices::{Estimated, SobolIndices, sobol_indices};
pub use starts::Starts;
pub use statistics::{EnsembleMean, quantile};
pub use store::{Shard, Store};
pub use study::SweepStudy;
pub use value::FieldValue;

use crate::study_file::{StudyError, text_of};
use bisection::{Search, Visited, search};
use design::Design;
use folder::OutputError;
use looselink::scene::{Analysis, Scene, SceneError};
use looselink::simulate::Simulation;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Digits of a SHA-256 that tell programs apart.
const DIGITS: usize = 12;

/// Why a sweep ends early.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// A fault of the study or of what it asks for.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A file cannot be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// It was interrupted; the same command goes on.
    #[error("interrupted: {done} of {total} runs are made; the same command goes on")]
    Interrupted {
        /// Runs made so far.
        done: usize,
        /// Runs of the sweep, in words: those of a bisection are not known.
        total: String,
    },
    /// A bisection has ended without an answer; its tables and pictures are written.
    #[error("the bisection has no answer: {0}")]
    NoAnswer(String),
}

impl From<SceneError> for SweepError {
    fn from(error: SceneError) -> SweepError {
        StudyError::from(error).into()
    }
}

impl From<std::io::Error> for SweepError {
    fn from(error: std::io::Error) -> SweepError {
        OutputError::from(error).into()
    }
}

/// The texts that a sweep is made of: equal texts are the same sweep on every machine.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SweepSource {
    /// Path of the study, for messages.
    pub path: PathBuf,
    /// Text of the study.
    pub study: String,
    /// Text of its scene.
    pub scene: String,
    /// A target that replaces that of the study.
    pub target: Option<SweepTarget>,
}

/// A run of a sweep that is to be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// Its number: points one after the other, all starts of a point together.
    pub run: usize,
    /// Number of its start.
    pub start: usize,
    /// Values of the parameters.
    pub values: Vec<FieldValue>,
}

/// How far a bisection is.
struct Searched {
    next: Search,
    /// The places that were visited, and the one that is wanted next.
    places: Vec<f64>,
    /// Means at those that were visited.
    visited: Vec<Visited>,
}

/// A study with its scene, checked.
#[derive(Debug)]
pub struct Sweep {
    /// What the study says.
    pub study: SweepStudy,
    source: SweepSource,
    /// None for a bisection.
    design: Option<Box<dyn Design>>,
    runs: Option<usize>,
    /// Units of the measures.
    units: Vec<String>,
    /// Units of the envelopes.
    envelope_units: Vec<String>,
    digest: String,
    /// Method and step of the scene.
    method: String,
    /// See [`SweepRow::program`].
    program: String,
}

impl Sweep {
    /// Reads a study and its scene.
    ///
    /// # Errors
    /// See [`Sweep::new`]; or a file that cannot be read.
    pub fn load(path: &Path, target: Option<SweepTarget>) -> Result<Sweep, SweepError> {
        let text = text_of(path)?;
        let study = SweepStudy::parse(path, &text, target.as_ref())?;
        // a scene that cannot be read is reported with the advice of the scene reader
        let scene = Scene::load(&study.scene, &study.set);
        let scene = scene.map_err(|error| fault_of_scene(path, &text, &study, error))?;
        Sweep::new(SweepSource {
            path: path.to_owned(),
            scene: scene.text().to_owned(),
            study: text,
            target,
        })
    }

    /// Checks a study: its scene must start as it is, and be readable with the values at both ends of every parameter.
    ///
    /// # Errors
    /// The first fault of the study or the scene.
    pub fn new(source: SweepSource) -> Result<Sweep, SweepError> {
        let study = SweepStudy::parse(&source.path, &source.study, source.target.as_ref())?;
        let fault = |message: String| StudyError::of_key(&source.path, &source.study, &message);
        let parameters = study.parameter_list();
        let samples = study.samples.unwrap_or(0);
        let design = study.design.design(&parameters, samples, study.seed);
        let design = design.map_err(fault)?;
        let runs = design.as_ref().map(|design| study.runs(design.points()));
        let runs = runs.transpose().map_err(fault)?;
        let mut sweep = Sweep {
            digest: digest(&source, &study),
            units: Vec::new(),
            envelope_units: Vec::new(),
            method: String::new(),
            program: program()?,
            study,
            source,
            design,
            runs,
        };
        let SweepSource {
            path, study: text, ..
        } = &sweep.source;
        let at_study = |error| fault_of_scene(path, text, &sweep.study, error);
        let scene = sweep.scene(&[]).map_err(at_study)?;
        let base = Simulation::new(&scene).map_err(at_study)?;
        let ends = [0.0, 1.0].map(|end| {
            let parameters = sweep.study.parameters.values();
            let values: Vec<FieldValue> = parameters.map(|p| p.at(end)).collect();
            sweep.scene(&values)
        });
        let [first, last] = ends.map(|scene| scene.map_err(at_study));
        let scenes = [scene, first?, last?];
        sweep.method = scenes[0].integrator.description();
        if sweep.study.starts.is_some() && scenes[0].simulation.analysis == Analysis::Static {
            let message = "`starts` change velocities, which a static analysis does not have";
            return Err(sweep.fault(message.to_owned()).into());
        }
        sweep.check_joints(&scenes)?;
        sweep.check_times(&scenes)?;
        let unit_of = |name: &str| {
            let channel = base.channels().iter().find(|c| c.name == name);
            channel.map_or(String::new(), |channel| channel.unit.to_owned())
        };
        let measures = sweep.study.measures.values();
        sweep.units = measures.map(|measure| measure.unit(unit_of)).collect();
        sweep.check_units(unit_of)?;
        let envelopes = sweep.study.envelopes.values();
        sweep.envelope_units = envelopes.map(|plan| unit_of(&plan.channels[0])).collect();
        Ok(sweep)
    }

    fn fault(&self, message: String) -> StudyError {
        StudyError::of_key(&self.source.path, &self.source.study, &message)
    }

    /// Refuses a measure of contacts of a joint that has clearance in none of some scenes.
    fn check_joints(&self, scenes: &[Scene]) -> Result<(), StudyError> {
        let known = || scenes[0].joints.iter().map(|joint| joint.name.as_str());
        let loose = |name: &String| {
            let joints = scenes.iter().flat_map(|scene| &scene.joints);
            let mut own = joints.filter(|joint| joint.name == *name);
            own.any(|joint| joint.contact().is_some())
        };
        for (name, measure) in &self.study.measures {
            let mut joints = measure.joints.iter();
            let Some(joint) = joints.find(|joint| !loose(joint)) else {
                continue;
            };
            return Err(self.fault(match known().any(|known| known == *joint) {
                true => {
                    format!("`measures.{name}` is of contacts of `{joint}`, which has no clearance")
                }
                false => {
                    let hint = looselink::document::did_you_mean(joint, known());
                    format!("`measures.{name}` names an unknown joint `{joint}`{hint}")
                }
            }));
        }
        Ok(())
    }

    /// Refuses a measure that begins after the end of all of some scenes.
    fn check_times(&self, scenes: &[Scene]) -> Result<(), StudyError> {
        let durations = scenes.iter().map(|scene| scene.simulation.duration);
        let longest = durations.fold(0.0, f64::max);
        let mut measures = self.study.measures.iter();
        match measures.find(|(_, measure)| measure.from >= longest) {
            Some((name, measure)) => Err(self.fault(format!(
                "`measures.{name}` begins at {} s, and the runs end at {longest} s",
                measure.from
            ))),
            None => Ok(()),
        }
    }

    /// Refuses a magnitude of quantities with different units.
    fn check_units(&self, unit_of: impl Fn(&str) -> String) -> Result<(), StudyError> {
        let measures = self.study.measures.iter();
        let measures = measures.map(|(name, m)| (format!("measures.{name}"), &m.channels));
        let envelopes = self.study.envelopes.iter();
        let envelopes = envelopes.map(|(name, e)| (format!("envelopes.{name}"), &e.channels));
        for (name, channels) in measures.chain(envelopes) {
            let mut units: Vec<String> = channels.iter().map(|c| unit_of(c)).collect();
            units.dedup();
            if units.len() > 1 {
                let units = units.join(" and ");
                let message = format!("`{name}` has channels with different units: {units}");
                return Err(self.fault(message));
            }
        }
        Ok(())
    }

    /// The texts it is made of.
    pub fn source(&self) -> &SweepSource {
        &self.source
    }

    /// Hexadecimal SHA-256 of the study, its scene and its target, without titles and comments.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// Number of runs; unknown for a bisection.
    pub fn runs(&self) -> Option<usize> {
        self.runs
    }

    /// Units of the measures, in their order.
    pub fn units(&self) -> &[String] {
        &self.units
    }

    /// Units of the envelopes, in their order.
    pub fn envelope_units(&self) -> &[String] {
        &self.envelope_units
    }

    /// Method and step of the scene as the study changes it.
    pub(crate) fn method(&self) -> &str {
        &self.method
    }

    /// The scene with these values of the parameters; as the study changes it with none.
    fn scene(&self, values: &[FieldValue]) -> Result<Scene, SceneError> {
        let name = self.study.scene.display().to_string();
        Scene::parse(&name, &self.source.scene, &self.study.overrides(values))
    }

    /// Refuses a shard of a bisection.
    fn check_shard(&self, shard: Shard) -> Result<(), StudyError> {
        let message = "a bisection has no shards: each of its points depends on those before it";
        match self.runs.is_none() && shard != Shard::WHOLE {
            true => Err(self.fault(message.to_owned())),
            false => Ok(()),
        }
    }

    /// Numbers of the runs that can be made now and are not in the store, those of a shard alone.
    ///
    /// # Errors
    /// A row that cannot be read.
    pub fn pending(&self, store: &Store, shard: Shard) -> Result<Vec<usize>, SweepError> {
        let runs = match self.runs {
            Some(runs) => 0..runs,
            None => {
                let searched = self.searched(store)?;
                let (starts, points) = (self.study.starts_of_a_point(), searched.places.len());
                match searched.next {
                    Search::Visit(_) => (points - 1) * starts..points * starts,
                    _ => 0..0,
                }
            }
        };
        let open = runs.filter(|run| shard.has(*run) && !store.has(*run));
        Ok(open.collect())
    }

    /// A run.
    ///
    /// # Errors
    /// A row on which the run depends cannot be read.
    pub fn task(&self, store: &Store, run: usize) -> Result<Task, SweepError> {
        let starts = self.study.starts_of_a_point();
        let (point, start) = (run / starts, run % starts);
        let parameters = self.study.parameter_list();
        let values = match &self.design {
            Some(design) => design.values(&parameters, point),
            None => {
                let Searched { places, .. } = self.searched(store)?;
                vec![parameters[0].at(places[point])]
            }
        };
        Ok(Task { run, start, values })
    }

    /// What a bisection has found so far.
    fn searched(&self, store: &Store) -> Result<Searched, SweepError> {
        let target = self.target();
        let place = self.study.measures.get_index_of(&target.measure);
        let place = place.expect("checked when the study was read");
        let starts = self.study.starts_of_a_point();
        let mut means = Vec::new();
        for point in 0.. {
            let runs = point * starts..(point + 1) * starts;
            if !runs.clone().all(|run| store.has(run)) {
                break;
            }
            let rows = runs.map(|run| store.row(run));
            let rows: Vec<SweepRow> = rows.collect::<Result<_, _>>()?;
            let values = rows.iter().map(|row| row.measures.get(place).copied()?);
            let values: Option<Vec<f64>> = values.collect();
            means.push(values.and_then(|values| EnsembleMean::of(&values)));
        }
        let (next, places) = search(target, |point| means.get(point).copied());
        let known = places.iter().zip(means);
        let visited = known.filter_map(|(place, mean)| {
            Some(Visited {
                place: *place,
                mean: mean?,
            })
        });
        Ok(Searched {
            next,
            visited: visited.collect(),
            places,
        })
    }

    fn target(&self) -> &SweepTarget {
        let target = self.study.target.as_ref();
        target.expect("only a bisection has no design, and it has a target")
    }

    /// Where the measure reaches the target, or why the search has ended without an answer; none in other designs, and before the
    /// search is at its end.
    ///
    /// # Errors
    /// A row that cannot be read.
    pub fn crossing(&self, store: &Store) -> Result<Option<Result<Crossing, String>>, SweepError> {
        if self.design.is_some() {
            return Ok(None);
        }
        let searched = self.searched(store)?;
        let crossing = |ends| Crossing::new(&self.study, self.target(), ends, &searched.visited);
        Ok(match searched.next {
            Search::Found(ends) => Some(Ok(crossing(ends))),
            Search::NoCrossing(ends) => Some(Err(self.no_crossing(&crossing(ends)))),
            Search::NoValue(place) => {
                Some(Err(self.no_value(store, place, searched.places.len() - 1)))
            }
            Search::Visit(_) => None,
        })
    }

    fn no_crossing(&self, crossing: &Crossing) -> String {
        let target = self.target();
        let place = self.study.measures.get_index_of(&target.measure);
        let unit = place.map_or("", |place| self.units[place].as_str());
        let [low, high] = crossing.means.map(|mean| numbers::number(mean, 4));
        let [from, to] = &crossing.between;
        format!(
            "`{}` does not cross {} {unit}: it is {low} {unit} with `{}` = {from} and {high} {unit} with {to}",
            target.measure,
            numbers::number(target.value, 4),
            crossing.parameter,
        )
    }

    fn no_value(&self, store: &Store, place: f64, point: usize) -> String {
        let (name, parameter) = self.study.parameters.first().expect("checked");
        let starts = self.study.starts_of_a_point();
        let rows = (point * starts..(point + 1) * starts).filter_map(|run| store.row(run).ok());
        let why = rows.filter_map(|row| row.error).next();
        let why = why.unwrap_or_else(|| "the measure has no value".to_owned());
        format!("with `{name}` = {}: {why}", parameter.at(place))
    }
}

/// A fault of the scene: of the study where it stands in a change that the study makes.
fn fault_of_scene(path: &Path, text: &str, study: &SweepStudy, error: SceneError) -> StudyError {
    let error = error.without_contents();
    let Some(change) = error.change() else {
        return error.into();
    };
    let field = change.split('=').next().unwrap_or_default().trim();
    let channel = error.underlined().trim_matches('"');
    let sets = |p: &SweepParameter| p.fields.iter().any(|own| own.path() == field);
    let records = |channels: &[String]| channels.iter().any(|name| name == channel);
    let parameter = study.parameters.iter().find(|(_, p)| sets(p));
    let parameter = parameter.filter(|_| !study.set.iter().any(|own| own == change));
    let measure = study.measures.iter().find(|(_, m)| records(&m.recorded()));
    let envelope = study.envelopes.iter().find(|(_, e)| records(&e.channels));
    let key = match (parameter, measure, envelope) {
        (Some((name, _)), ..) => format!("parameters.{name}"),
        _ if field != "output.channels" => "set".to_owned(),
        (_, Some((name, _)), _) => format!("measures.{name}"),
        (_, _, Some((name, _))) => format!("envelopes.{name}"),
        _ => "measures".to_owned(),
    };
    let advice = error
        .advice()
        .map_or(String::new(), |advice| format!("\n{advice}"));
    StudyError::of_key(path, text, &format!("`{key}`: {error}{advice}"))
}

/// That of all texts, each preceded by its length, so that no two lists of texts collide.
fn digest(source: &SweepSource, study: &SweepStudy) -> String {
    let mut hasher = Sha256::new();
    let target = study.target.as_ref().map(|target| {
        let SweepTarget {
            measure,
            value,
            tolerance,
        } = target;
        format!("{measure} {value:?} {tolerance:?}")
    });
    let [study, scene] = [&source.study, &source.scene].map(|text| without_title(text));
    for text in [study, scene, target.unwrap_or_default()] {
        hasher.update((text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    numbers::hexadecimal(&hasher.finalize())
}

/// See [`SweepRow::program`].
fn program() -> Result<String, SweepError> {
    let mut program = looselink::output::program()?;
    program.truncate(DIGITS);
    Ok(program)
}

/// The keys and values of a text but its title, in their order.
fn without_title(text: &str) -> String {
    let Ok(mut table) = text.parse::<toml::Table>() else {
        return text.to_owned();
    };
    table.remove("title");
    table.to_string()
}

/// Rows of a store by run.
pub(crate) type RowPlaces = BTreeMap<usize, store::RowPlace>;
