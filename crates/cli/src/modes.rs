//! `looselink modes`

use super::failure::CommandFailure;
use super::progress::{Display, remark, warn};
use super::terminal::say;
use super::{SceneArguments, print};
use clap::{Args, ValueEnum};
use folder::{json, naming, replace};
use looselink::model::Model;
use looselink::modes::{Modes, NaturalMode};
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Control, Observer, Progress, Simulation};
use messages::Ticker;
use numbers::{exact, number};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use studies::ablation::SceneEffect;
use view::{StoredRun, StoredSummary, page};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Time of the pose (s); the scene is simulated up to it. In a static analysis the measure of the load, up to its duration.
    #[arg(
        long,
        value_name = "T",
        default_value = "0",
        allow_negative_numbers = true
    )]
    at: f64,
    /// What the loose joints do.
    #[arg(long, value_name = "STATE", default_value = "as-is")]
    contacts: Contacts,
    /// Number of modes, the slowest first.
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..))]
    count: u16,
    /// Machine-readable output, with the shapes.
    #[arg(long)]
    json: bool,
    /// Write a page for each mode, in which it swings, into this folder.
    #[arg(long, value_name = "DIR")]
    view: Option<PathBuf>,
}

/// What the loose joints do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Contacts {
    /// Those that are closed at that time act as springs, the others not at all.
    AsIs,
    /// No contact acts.
    Open,
    /// Ideal joints take their place, also on the way to that time.
    Ideal,
}

/// What is printed.
#[derive(Serialize)]
struct ModesOutput<'a> {
    title: &'a str,
    /// Time of the pose \[s\].
    t: f64,
    asymmetry: f64,
    modes: Vec<NamedMode<'a>>,
}

/// A mode with the displacements of the unknown coordinates by their names.
#[derive(Serialize)]
struct NamedMode<'a> {
    #[serde(flatten)]
    mode: &'a NaturalMode,
    shape: BTreeMap<&'a str, f64>,
}

/// Shows how far the run up to the pose is.
struct Approach(Display, Ticker);

impl Observer for Approach {
    fn row(&mut self, _: &[f64]) -> io::Result<()> {
        Ok(())
    }

    fn step(&mut self, progress: &Progress) -> io::Result<Control> {
        self.0.show(progress, self.1.tick());
        Ok(Control::Continue)
    }
}

/// Natural frequencies and mode shapes of the mechanism in a pose.
pub fn modes(arguments: &Arguments) -> Result<(), CommandFailure> {
    let scene = scene(arguments)?;
    let (at, duration) = (arguments.at, scene.simulation.duration);
    if !(0.0..=duration).contains(&at) {
        let message = format!(
            "--at {} lies outside the duration, 0 to {} s",
            exact(at),
            exact(duration)
        );
        return Err(CommandFailure::bad_input(message));
    }
    let mut simulation = Simulation::new(&scene)?;
    if at > 0.0 || scene.simulation.analysis == Analysis::Static {
        let mut approach = Approach(Display::new(arguments.json, 0.0), Ticker::new());
        let reached = simulation.approach(at, &mut approach);
        approach.0.finish("");
        let warnings = simulation.report().warnings();
        warnings.iter().for_each(|warning| warn(warning));
        reached.map_err(|error| CommandFailure::run(&error))?;
    }
    let found = simulation.modes(arguments.contacts == Contacts::Open);
    let mut found = found.map_err(CommandFailure::cannot_go_on)?;
    let all = found.modes.len();
    found.modes.truncate(arguments.count.into());
    if let Some(note) = floating(arguments, &simulation) {
        remark(&note);
    }
    let simulation = Rc::new(simulation);
    match arguments.json {
        true => print(json(&output(&scene, simulation.model(), at, &found))?)?,
        false => print(text(arguments, &scene, &simulation, &found, all))?,
    }
    match &arguments.view {
        Some(folder) => pages(folder, &scene, &simulation, &found),
        None => Ok(()),
    }
}

/// The scene of a file or of a result.
fn scene(arguments: &Arguments) -> Result<Scene, CommandFailure> {
    let path = &arguments.scene.scene;
    let scene = match path.is_dir() {
        true => {
            let (_, stored) = StoredSummary::load(path)?;
            let file = path.join("scene.toml");
            arguments.scene.scene_with(&file, stored.overrides)?
        }
        false => arguments.scene.scene_with(path, Vec::new())?,
    };
    match arguments.contacts {
        Contacts::Ideal => Ok(SceneEffect::Clearance.removed_from(&scene)?),
        _ => Ok(scene),
    }
}

fn output<'a>(scene: &'a Scene, model: &'a Model, t: f64, found: &'a Modes) -> ModesOutput<'a> {
    let names = model.unknown_names();
    let named = |mode: &'a NaturalMode| {
        let shape = names
            .iter()
            .map(String::as_str)
            .zip(mode.shape.iter().copied());
        NamedMode {
            mode,
            shape: shape.take(model.shape().unknowns).collect(),
        }
    };
    ModesOutput {
        title: &scene.title,
        t,
        asymmetry: found.asymmetry,
        modes: found.modes.iter().map(named).collect(),
    }
}

fn text(
    arguments: &Arguments,
    scene: &Scene,
    simulation: &Simulation,
    found: &Modes,
    all: usize,
) -> String {
    let when = match scene.simulation.analysis {
        Analysis::Dynamic => format!("t = {} s", exact(arguments.at)),
        Analysis::Static => format!("loads at t = {}", exact(arguments.at)),
    };
    let mut out = format!(
        "{}, {when}{}\n\n",
        scene.title,
        contacts(arguments, simulation)
    );
    out += "mode  frequency [Hz]  damping ratio  moves most\n";
    for (k, mode) in found.modes.iter().enumerate() {
        let frequency = match (mode.frequency, mode.growth) {
            (_, growth) if growth > 0.0 => format!("unstable, e^({} t)", number(growth, 4)),
            (0.0, _) => "0 (free)".to_owned(),
            (frequency, _) => number(frequency, 7),
        };
        let damping = number(mode.damping, 3);
        let name = &mode.moves_most;
        out += &format!("{:>4}  {frequency:>14}  {damping:>13}  {name}\n", k + 1);
    }
    if all > found.modes.len() {
        out += &format!("and {} more: --count {all}\n", all - found.modes.len());
    }
    if let Some(note) = found.asymmetry_note() {
        out += &format!("note: {note}\n");
    }
    out
}

/// Which loose joints are closed.
fn contacts(arguments: &Arguments, simulation: &Simulation) -> String {
    let model = simulation.model();
    let state = simulation.state();
    let joints = model.joints().iter().enumerate();
    let gaps = joints.filter_map(|(j, joint)| Some((&joint.name, model.gap(j, state)?)));
    let closed: Vec<&str> = gaps
        .clone()
        .filter(|(_, (.., closed))| *closed)
        .map(|(name, _)| name.as_str())
        .collect();
    match arguments.contacts {
        Contacts::Ideal => ", with ideal joints".to_owned(),
        _ if gaps.count() == 0 => String::new(),
        Contacts::Open => ", with all loose joints open".to_owned(),
        Contacts::AsIs if closed.is_empty() => ", all loose joints open".to_owned(),
        Contacts::AsIs => format!(", closed: {}", closed.join(", ")),
    }
}

/// That journals float at the start, where nobody has asked for open contacts: a scene is assembled with journals in the middle of
/// their bearings, and no force has moved them yet.
fn floating(arguments: &Arguments, simulation: &Simulation) -> Option<String> {
    if arguments.at > 0.0 || arguments.contacts != Contacts::AsIs {
        return None;
    }
    let (model, state) = (simulation.model(), simulation.state());
    let joints = model.joints().iter().enumerate();
    let open = joints.filter(|(j, _)| model.gap(*j, state).is_some_and(|(.., closed)| !closed));
    let names: Vec<&str> = open.map(|(_, joint)| joint.name.as_str()).collect();
    let (journals, float, them) = match names.len() {
        0 => return None,
        1 => ("journal", "floats at t = 0: it moves", "it"),
        _ => ("journals", "float at t = 0: they move", "them"),
    };
    Some(format!(
        "the {journals} of {} {float} freely; `--contacts ideal` holds {them}, and `--at` finds contacts that are closed later",
        names.join(", ")
    ))
}

/// Writes a page for every mode that vibrates.
fn pages(
    folder: &Path,
    scene: &Scene,
    simulation: &Rc<Simulation>,
    found: &Modes,
) -> Result<(), CommandFailure> {
    let made = fs::create_dir_all(folder).map_err(naming(folder));
    made.map_err(CommandFailure::system)?;
    let modes = found.modes.iter().enumerate();
    let mut count = 0;
    for (k, mode) in modes.filter(|(_, mode)| mode.frequency > 0.0) {
        let frequency = number(mode.frequency, 4);
        let title = format!("Mode {}, {frequency} Hz: {}", k + 1, scene.title);
        let runs = StoredRun::swinging(scene, title, simulation, mode);
        let file = folder.join(format!("mode-{:02}.html", k + 1));
        replace(&file, page(&runs).as_bytes())?;
        count += 1;
    }
    say(&format!("{count} pages in `{}`", folder.display()));
    Ok(())
}
