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
    let mut overrides = named(&scene);
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

/// Names of the nodes of a flexible link from end to end: that of a point of the link, or the number of the node.
pub fn nodes(flexible: &FlexibleLink) -> Vec<String> {
    let point = |k: usize| flexible.nodes.iter().position(|n| *n == k);
    let name = |k| match point(k) {
        Some(point) => flexible.link.points[point].name.clone(),
        None => format!("node{k}"),
    };
    (0..=flexible.elements).map(name).collect()
}

/// Overrides that give every node of a flexible link its name, so that its place is recorded.
fn named(scene: &Scene) -> Vec<String> {
    let links = scene.bodies.iter();
    let links = links.filter_map(|body| Some((&body.name, body.kind.get::<FlexibleLink>()?)));
    let inner = links.filter(|(_, flexible)| flexible.elements > 1);
    let named = inner.map(|(body, flexible)| {
        let place = |k| flexible.link.length * k as f64 / flexible.elements as f64;
        let names = nodes(flexible).into_iter().enumerate().skip(1);
        let inner = names.take(flexible.elements - 1);
        let list: Vec<String> = inner
            .map(|(k, name)| format!("{name} = {:?}", place(k)))
            .collect();
        format!("bodies.{body}.points={{ {} }}", list.join(", "))
    });
    named.collect()
}
