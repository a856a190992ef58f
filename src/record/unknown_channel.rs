//! What to say of a channel that a mechanism does not have.

use super::channels::ACTUATOR;
use crate::document::listed;
use crate::scene::{ChannelPattern, Scene, SceneError};

/// The fault of a pattern that fits none of the channels of these names.
pub(super) fn fault(scene: &Scene, wanted: &ChannelPattern, names: &[&str]) -> SceneError {
    let pattern = &*wanted.pattern;
    let likeness = |name: &str| strsim::jaro_winkler(name, pattern);
    let nearest = names.iter().copied();
    let nearest = nearest.max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let message = format!(
        "no channel of this scene is named {pattern:?}; the nearest is {:?}",
        nearest.unwrap_or_default()
    );
    let mut error = scene.error(wanted.span, message, "unknown channel");
    let owner = pattern.rsplit_once('.').map_or("", |(owner, _)| owner);
    if let Some(said) = undriven(scene, pattern) {
        error = error.with_help(said);
    }
    let is_own = |name: &str| name.rsplit_once('.').is_some_and(|(of, _)| of == owner);
    let own: Vec<&str> = names.iter().copied().filter(|n| is_own(n)).collect();
    error = error.with_help(match own.is_empty() {
        true => listed(pattern, names),
        false => format!("known of {owner}: {}", own.join(", ")),
    });
    error.with_help("`looselink inspect --all` with `--set 'output.channels=[\"*\"]'` lists all")
}

/// What to say where a drive would give a joint this channel.
fn undriven(scene: &Scene, pattern: &str) -> Option<String> {
    let (name, quantity) = pattern.split_once('.')?;
    let joint = scene.joints.iter().find(|joint| joint.name == name)?;
    let driven = ACTUATOR.iter().any(|(name, _)| *name == quantity);
    (driven && joint.model.is_revolute()).then(|| {
        format!(
            "joint {name} has `{quantity}` where a drive turns it, and none does: it keeps its degree of freedom"
        )
    })
}
