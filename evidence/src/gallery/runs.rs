//! The runs: which scenes there are, and what a run leaves.

use crate::gallery::Entry;
use looselink::body::FlexibleLink;
use looselink::scene::Scene;
use looselink::simulate::{Channel, Inspection, Recording, Report, Simulation};
use miette::{IntoDiagnostic, Result};
use std::path::Path;

/// A scene that has run.
pub struct SceneRun {
    /// The scene as it stands in its file.
    pub scene: Scene,
    /// What was simulated.
    pub inspection: Inspection,
    /// How the run went.
    pub report: Report,
    channels: Vec<Channel>,
    recording: Recording,
}

impl SceneRun {
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

/// Runs a scene and keeps the channels that are drawn.
///
/// # Errors
/// A scene that cannot be read or does not run to its end.
pub fn run(root: &Path, entry: &Entry) -> Result<SceneRun> {
    let path = root.join(&entry.name).with_extension("toml");
    let scene = Scene::load(&path, &[])?;
    let mut overrides = nodes(&scene);
    overrides.push(format!(
        "output.channels=[\"points.*\", \"{}\"]",
        entry.channel
    ));
    if let Some(duration) = entry.cut {
        overrides.push(format!("simulation.duration={duration:?}"));
    }
    let mut simulation = Simulation::new(&Scene::load(&path, &overrides)?)?;
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).into_diagnostic()?;
    Ok(SceneRun {
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
