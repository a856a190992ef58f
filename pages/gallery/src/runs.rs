//! The runs: which scenes there are, what is shown of each, and what a run leaves.

use looselink::body::FlexibleLink;
use looselink::scene::Scene;
use looselink::simulate::{Channel, Inspection, Recording, Report, Simulation};
use miette::{IntoDiagnostic, Result, miette};
use std::path::Path;

/// What is shown of a scene.
#[derive(Clone, Copy)]
pub struct Show {
    /// The beginning of its name.
    name: &'static str,
    /// The channel on the right.
    pub channel: &'static str,
    /// What the channel is.
    pub label: &'static str,
    /// The mechanism is drawn between t = 0 and this time \[s\]; over the whole run when absent.
    pub drawn: Option<f64>,
    /// The run is cut here \[s\]; as long as the scene says when absent.
    pub duration: Option<f64>,
}

const fn show(name: &'static str, channel: &'static str, label: &'static str) -> Show {
    Show {
        name,
        channel,
        label,
        drawn: None,
        duration: None,
    }
}

impl Show {
    const fn drawn(self, drawn: f64) -> Show {
        Show {
            drawn: Some(drawn),
            ..self
        }
    }

    const fn cut(self, duration: f64) -> Show {
        Show {
            duration: Some(duration),
            ..self
        }
    }
}

/// The first entry whose name begins that of the scene counts.
const SHOWN: [Show; 32] = [
    show("3rrr/case1", "A1.torque", "Torque of motor A1").cut(0.5),
    show("3rrr/", "error.x", "Error of the platform, x").cut(0.5),
    show("ablation/", "rocker.alpha", "Acceleration of the rocker"),
    show("andrews", "K1.omega", "Angular velocity of K1"),
    show("bouncing-journal", "journal.vx", "Velocity of the journal"),
    show("cantilever-dynamic", "points.beam.end.y", "Tip, y").drawn(1.2),
    show("cantilever-static", "points.beam.end.y", "Tip, y"),
    show(
        "car-axis",
        "points.axle.right.y",
        "Right end of the axle, y",
    ),
    show("double-pendulum", "energy.bending", "Bending energy"),
    show(
        "driven-disc",
        "points.disc.center.x",
        "Centre of the disc, x",
    ),
    show(
        "four-bar-three-loose",
        "C.eccentricity",
        "Eccentricity in C",
    )
    .drawn(0.08),
    show("frame", "load.theta", "Angle of the body"),
    show("harmonic-slider", "main.torque", "Torque of the motor").drawn(0.4),
    show(
        "hard/slope-on",
        "weld.torque",
        "Couple of the weld on the body",
    ),
    show("maxwell", "element.force", "Pull of the element"),
    show("n-four-bar", "points.crank0.end.x", "B0, x").drawn(1.2),
    show("pendulum", "points.rod.bob.x", "Point at 1 m, x").drawn(1.18),
    show(
        "plucked-string",
        "points.string.middle.y",
        "Middle of the string, y",
    ),
    show("quick-return", "ram.vx", "Velocity of the ram").drawn(0.6),
    show("ramped-cantilever", "points.beam.end.y", "Tip, y").drawn(3.5),
    show("ringing-bar", "energy.bending", "Bending energy"),
    show("rod-linkage", "large.theta", "Angle of the large disc"),
    show("roll-up", "points.beam.end.y", "Tip, y"),
    show("scotch-yoke", "yoke.ax", "Acceleration of the yoke").drawn(0.5),
    show(
        "slider-crank/free",
        "points.slider.front.y",
        "Upper corner of the slider, y",
    ),
    show("slider-crank/", "slider.ax", "Acceleration of the slider").drawn(0.0096),
    show("soft-pendulum", "points.rod.end.y", "Tip, y"),
    show("spin-up", "hub.torque", "Torque of the hub").drawn(8.0),
    show("stiff-pendulum", "rod.strain", "Largest axial strain").drawn(0.5),
    show("stiff-spring", "spring.force", "Force of the spring").drawn(3.2),
    show("three-spring", "node2.ax", "Acceleration of node 2").drawn(5.236),
    // scenes without an entry of their own
    show("", "energy.kinetic", "Kinetic energy"),
];

/// A scene that has run.
pub struct SceneRun {
    /// Path of the scene below the folder of scenes, without its ending.
    pub name: String,
    /// The scene as it stands in its file.
    pub scene: Scene,
    /// What is shown of it.
    pub show: Show,
    /// What was simulated.
    pub inspection: Inspection,
    /// How the run went.
    pub report: Report,
    channels: Vec<Channel>,
    recording: Recording,
}

impl SceneRun {
    /// The name as a file name.
    pub fn slug(&self) -> String {
        self.name.replace('/', "-")
    }

    /// A channel over the rows; `None` where the scene has none of this name.
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        self.recording.get(name)
    }

    /// The unit of a channel.
    pub fn unit(&self, name: &str) -> &'static str {
        let found = self.channels.iter().find(|c| c.name == name);
        found.map_or("", |c| c.unit)
    }
}

/// The scenes below a folder, in order, without their ending.
///
/// # Errors
/// A folder that cannot be read.
pub fn names(root: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).into_diagnostic()? {
            let path = entry.into_diagnostic()?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let below = path.strip_prefix(root).into_diagnostic()?;
                names.push(below.with_extension("").display().to_string());
            }
        }
    }
    names.sort();
    Ok(names)
}

/// Runs a scene and keeps the channels that are drawn.
///
/// # Errors
/// A scene that cannot be read or does not run to its end.
pub fn run(root: &Path, name: &str) -> Result<SceneRun> {
    let path = root.join(name).with_extension("toml");
    let scene = Scene::load(&path, &[])?;
    let show = SHOWN
        .into_iter()
        .find(|s| name.starts_with(s.name))
        .ok_or_else(|| miette!("nothing to show of {name}"))?;
    let mut overrides = nodes(&scene);
    overrides.push(format!(
        "output.channels=[\"points.*\", \"{}\"]",
        show.channel
    ));
    if let Some(duration) = show.duration {
        overrides.push(format!("simulation.duration={duration:?}"));
    }
    let mut simulation = Simulation::new(&Scene::load(&path, &overrides)?)?;
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).into_diagnostic()?;
    Ok(SceneRun {
        name: name.to_owned(),
        show,
        inspection: simulation.inspect(),
        report: simulation.report(),
        channels: simulation.channels().to_vec(),
        recording,
        scene,
    })
}

/// Overrides that give every node of a flexible link a name, so that its place is recorded.
fn nodes(scene: &Scene) -> Vec<String> {
    let mut overrides = Vec::new();
    for body in &scene.bodies {
        let Some(flexible) = body.kind.get::<FlexibleLink>() else {
            continue;
        };
        let (elements, link) = (flexible.elements, &flexible.link);
        let named = |k: usize| Some(&link.points[flexible.nodes.iter().position(|n| *n == k)?]);
        let points: Vec<String> = (1..elements)
            .map(|k| {
                let name = named(k).map_or_else(|| format!("node{k}"), |p| p.name.clone());
                let place = link.length * k as f64 / elements as f64;
                format!("{name} = {place:?}")
            })
            .collect();
        if !points.is_empty() {
            let list = points.join(", ");
            overrides.push(format!("bodies.{}.points={{ {list} }}", body.name));
        }
    }
    overrides
}
