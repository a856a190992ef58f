//! The gallery: every scene of the folder by what it shows, each demonstration with a picture.

mod drawing;
mod runs;

use crate::campaign::{Campaign, Renderer, results};
use crate::output::{Data, Output, stamp};
use looselink::scene::{Accuracy, Analysis, Pace, Scene};
use miette::{IntoDiagnostic, Result, WrapErr};
use minijinja::{Value, context};
use plot::Figure;
use records::Journal;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;
use studies::precision::StudyPace;

/// The campaign.
pub const CAMPAIGN: Campaign = Campaign {
    name: "gallery",
    minutes: 5,
    seeds: "none",
    measure,
};

/// The page and its pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["gallery"],
    render,
};

/// `evidence/gallery.toml`
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Gallery {
    section: Vec<Section>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    title: String,
    #[serde(default = "yes")]
    pictures: bool,
    scenes: Vec<Entry>,
}

fn yes() -> bool {
    true
}

/// What is shown of a scene.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// Path below `scenes/`, without the ending.
    name: String,
    says: String,
    #[serde(default)]
    channel: String,
    #[serde(default)]
    label: String,
    #[serde(default)]
    prefix: String,
    drawn: Option<f64>,
    cut: Option<f64>,
}

/// What the run of a scene leaves.
#[derive(Serialize, Deserialize)]
struct SceneCard {
    name: String,
    unknowns: usize,
    multipliers: usize,
    contacts: usize,
    onsets: u64,
    figure: Figure,
}

impl Gallery {
    fn read(root: &Path) -> Result<Gallery> {
        let path = root.join("evidence/gallery.toml");
        let text = fs::read_to_string(&path).into_diagnostic();
        let text = text.wrap_err_with(|| format!("cannot read {}", path.display()))?;
        toml::from_str(&text).into_diagnostic()
    }
}

fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let root = records::root();
    let gallery = Gallery::read(&root)?;
    let shown = gallery.section.iter().filter(|section| section.pictures);
    let entries: Vec<&Entry> = shown.flat_map(|section| &section.scenes).collect();
    let cards: Vec<SceneCard> = journal.items(
        &entries,
        2,
        |entry| entry.name.clone(),
        |entry| {
            let run = runs::run(&root.join("scenes"), entry)?;
            Ok(SceneCard {
                name: entry.name.clone(),
                unknowns: run.inspection.unknowns,
                multipliers: run.inspection.multipliers,
                contacts: run.inspection.contacts,
                onsets: run.report.onsets,
                figure: drawing::figure(&run, entry).thinned(),
            })
        },
    )?;
    results(cards)
}

/// scenes/README.md and its pictures.
///
/// # Errors
/// A record that is missing or lacks a scene, a scene that cannot be read.
fn render(data: &Data, out: &mut Output) -> Result<()> {
    let record = data.read::<Vec<SceneCard>>("gallery")?;
    let mut sections = Vec::new();
    for section in Gallery::read(data.root())?.section {
        let mut entries = Vec::new();
        for entry in &section.scenes {
            let card = record.results.iter().find(|card| card.name == entry.name);
            let slug = entry.name.replace('/', "-");
            let scene = scene(data.root(), &entry.name)?;
            if let Some(card) = card {
                let mut figure = card.figure.clone();
                figure.caption = caption(&entry.name, &scene);
                out.picture(&format!("gallery/{slug}"), &figure)?;
            }
            entries.push(context! { ..context! { slug, name => entry.name, says => entry.says, title => scene.title },
                ..card.map_or(Value::UNDEFINED, |c| context! { unknowns => c.unknowns, contacts => c.contacts, onsets => c.onsets, multipliers => c.multipliers }) });
        }
        sections.push(context! { title => section.title, pictures => section.pictures, entries });
    }
    let page = context! { stamp => stamp(&record.origin), sections };
    out.page("scenes/README.md", "gallery.md", page)
}

fn scene(root: &Path, name: &str) -> Result<Scene> {
    let path = root.join("scenes").join(name).with_extension("toml");
    Ok(Scene::load(&path, &[])?)
}

/// How a run of a scene was made that changed nothing of it.
///
/// # Errors
/// A scene that cannot be read.
pub fn caption_of(root: &Path, name: &str) -> Result<String> {
    Ok(caption(name, &scene(root, name)?))
}

fn caption(name: &str, scene: &Scene) -> String {
    let integrator = &scene.integrator;
    let method = match integrator.automatic {
        true => "auto",
        false => integrator.method.name(),
    };
    let how = match (scene.simulation.analysis, integrator.pace) {
        (Analysis::Static, _) => "equilibria".to_owned(),
        (_, Pace::Step(step)) => format!("method {method}, {}", StudyPace::Step(step)),
        (
            _,
            Pace::Accuracy(Accuracy {
                position,
                energy,
                horizon,
            }),
        ) => {
            let pace = StudyPace::Accuracy {
                position,
                energy,
                horizon,
            };
            format!("method {method}, {pace}")
        }
    };
    format!("Scene {name}: {how}.")
}

#[cfg(test)]
mod tests {
    use super::Gallery;
    use records::root;
    use std::fs;
    use std::path::Path;

    /// The scenes below a folder, without their ending.
    fn scenes(folder: &Path, below: &str, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = format!("{below}{}", path.file_stem().unwrap().display());
            if path.is_dir() {
                scenes(&path, &format!("{name}/"), found);
            } else if path.extension().is_some_and(|e| e == "toml") {
                found.push(name);
            }
        }
    }

    #[test]
    fn every_scene_is_in_the_gallery_once() {
        let gallery = Gallery::read(&root()).unwrap();
        let entries = gallery.section.iter().flat_map(|section| &section.scenes);
        let mut listed: Vec<String> = entries.map(|entry| entry.name.clone()).collect();
        let mut found = Vec::new();
        scenes(&root().join("scenes"), "", &mut found);
        listed.sort();
        found.sort();
        assert_eq!(listed, found);
    }
}
