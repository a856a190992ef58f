//! What accuracy costs: every study of precision in `studies`, whether runs reach the accuracy that they are asked for, and what
//! every effect of the paper's case 4 does and costs.

mod amplification;
mod diagram;
mod guarantee;
mod guarantee_page;
pub mod page;

use crate::campaign::{Campaign, Renderer, results};
pub use diagram::levels;
use looselink::scene::Scene;
use miette::{IntoDiagnostic, Result, miette};
use numbers::rounded;
use plot::Figure;
use records::{Journal, root};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::Path;
use studies::ablation::{Observed, ablate};
use studies::precision::{
    Compared, Effort, Found, MotionReference, RunTiming, StatisticsReference, Study,
};

/// The campaigns.
pub const CAMPAIGNS: [Campaign; 2] = [
    Campaign {
        name: "accuracy",
        minutes: 15,
        seeds: "none",
        measure,
    },
    Campaign {
        name: "guarantee",
        minutes: 20,
        seeds: "none",
        measure: guarantee::measure,
    },
];

/// The page and its pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["accuracy", "guarantee"],
    render: page::render,
};

/// What the campaign `accuracy` finds.
#[derive(Serialize, Deserialize)]
struct Accuracy {
    /// Errors of motions.
    studies: Vec<MadeStudy<MotionReference>>,
    /// Statistics of long runs.
    surveys: Vec<MadeStudy<StatisticsReference>>,
    effects: Effects,
}

/// A study and what came of it.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct MadeStudy<C: Compared> {
    /// Name of its file without the extension.
    pub name: String,
    pub found: Found<C>,
    /// Times of the runs, which `found` leaves out.
    timings: Vec<Option<RunTiming>>,
}

/// Case 4, effect by effect, over one cycle of the platform.
#[derive(Serialize, Deserialize)]
struct Effects {
    figure: Figure,
    /// Tables in Markdown.
    summary: String,
    warnings: Vec<String>,
}

/// Timed runs of every point, and of the points of a long study.
const REPEATS: [usize; 2] = [5, 3];
/// Digits of what is kept.
const DIGITS: usize = 5;

fn measure(journal: &Journal) -> Result<Value> {
    let (mut motions, mut surveys) = (Vec::new(), Vec::new());
    for name in names(&root().join("studies"))? {
        let study = study(&root(), &name)?;
        match study.statistics {
            None => motions.push(journal.item(&name, || MadeStudy::make(&name, &study))?),
            Some(_) => surveys.push(journal.item(&name, || MadeStudy::make(&name, &study))?),
        }
    }
    let effects = journal.item("effects of case 4", || {
        let path = root().join("scenes/3rrr/case4.toml");
        let scene = Scene::load(&path, &["simulation.duration=1".to_owned()])?;
        let body = Observed::choose(&scene, None).map_err(|e| miette!("{e}"))?;
        let ablation = ablate(&scene, body, None, &mut |_| ());
        Ok(Effects {
            figure: studies::ablation::figure(&ablation).thinned(),
            summary: ablation.summary(),
            warnings: ablation.warnings(),
        })
    })?;
    let mut value = results(Accuracy {
        studies: motions,
        surveys,
        effects,
    })?;
    shorten(&mut value);
    Ok(value)
}

/// Names of the studies, in their order.
fn names(folder: &Path) -> Result<Vec<String>> {
    let files = std::fs::read_dir(folder).into_diagnostic()?;
    let paths = files.map(|file| Ok(file.into_diagnostic()?.path()));
    let mut paths = paths.collect::<Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let stems = paths.iter().filter_map(|path| path.file_stem());
    Ok(stems.map(|s| s.to_string_lossy().into_owned()).collect())
}

/// One of the studies.
///
/// # Errors
/// When it cannot be read.
pub fn study(root: &Path, name: &str) -> Result<Study> {
    let path = root.join("studies").join(name).with_extension("toml");
    Study::load(&path).into_diagnostic()
}

impl<C: Compared> MadeStudy<C> {
    fn make(name: &str, study: &Study) -> Result<MadeStudy<C>> {
        let effort = Effort {
            repeats: REPEATS[usize::from(study.statistics.is_some())],
            smoke: false,
        };
        let mut found = Found::run(study, effort, &mut |_| ()).into_diagnostic()?;
        Ok(MadeStudy {
            name: name.to_owned(),
            timings: std::mem::take(&mut found.timings),
            found,
        })
    }

    /// With the times where they were.
    fn restored(mut self) -> MadeStudy<C> {
        self.found.timings = std::mem::take(&mut self.timings);
        self
    }
}

/// Rounds all numbers.
fn shorten(value: &mut Value) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(shorten),
        Value::Object(fields) => fields.values_mut().for_each(shorten),
        Value::Number(number) if number.is_f64() => {
            *value = rounded(number.as_f64().unwrap_or(f64::NAN), DIGITS).into();
        }
        _ => {}
    }
}
