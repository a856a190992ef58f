//! What Figs. 5 to 9 have in common, and the list of them.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::numbers::Numbers;
use crate::runs::Recording;
use crate::{fig05, fig06, fig07, fig08, fig09};
use looselink::scene::Method;
use miette::Result;
use plot::si;
use plot::{Axis, Figure, save};
use rayon::prelude::*;
use std::path::Path;

/// File name and content of every figure.
pub fn all(c: &Campaign, numbers: &mut Numbers) -> [(&'static str, Figure); 5] {
    [
        ("fig5", fig05::figure(c, numbers)),
        ("fig6", fig06::figure(c, numbers)),
        ("fig7", fig07::figure(c, numbers)),
        ("fig8", fig08::figure(c, numbers)),
        ("fig9", fig09::figure(c, numbers)),
    ]
}

/// Writes figures, one a core.
///
/// # Errors
/// The first file that cannot be written.
pub fn save_all(figures: &[(&str, Figure)], folder: &Path) -> Result<()> {
    figures
        .par_iter()
        .try_for_each(|(name, figure)| save(figure, folder, name))
}

/// The axis of the last two cycles.
pub fn time_axis() -> Axis {
    Axis::new("Time t", "s", 1.0).over(FROM, DURATION)
}

/// Legend entry of a recording.
pub fn step_label(recording: &Recording) -> String {
    format!("h = {}", si(recording.plan.step, "s"))
}

/// A caption: what is seen, then the scenes, the method and the steps it was made with.
pub fn caption(text: &str, made_with: &[&Recording]) -> String {
    let scenes: Vec<String> = made_with.iter().map(|r| r.plan.scene_name()).collect();
    let method = match made_with[0].scene.integrator.method {
        Method::Bathe { gamma, .. } => format!("Bathe method (γ = {gamma})"),
        other => other.name().to_owned(),
    };
    format!(
        "{text} Scenes: {}. {method}, step h as in the legends, rows every {}.",
        scenes.join(", "),
        si(made_with[0].plan.interval, "s")
    )
}
