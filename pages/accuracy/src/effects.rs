//! What every effect of a scene does and costs.

use looselink::scene::Scene;
use miette::{Result, miette};
use std::path::Path;
use studies::ablation::{Ablation, Observed, SceneEffect, VariantOutcome, VariantRole, ablate};

/// Over one cycle of the platform.
const DURATION: &str = "simulation.duration=1";

/// The variants of a scene.
///
/// # Errors
/// A scene that cannot be read, or in which nothing moves.
pub fn ablation(path: &Path) -> Result<Ablation> {
    let scene = Scene::load(path, &[DURATION.to_owned()]).map_err(|e| miette!("{e}"))?;
    let body = Observed::choose(&scene, None).map_err(|e| miette!("{e}"))?;
    Ok(ablate(&scene, body, None, &mut |reported| {
        crate::show("ablation", reported)
    }))
}

/// Its part of the page.
pub fn section(ablation: &Ablation) -> String {
    format!(
        "## Influence and cost of each effect\n\n![Case 4, effect by effect](pages/accuracy/figures/ablation.png)\n\n{}\n\n{}\n",
        conclusion(ablation).unwrap_or_default(),
        ablation.summary()
    )
}

/// Which effect matters most to the error and which to the time.
fn conclusion(ablation: &Ablation) -> Option<String> {
    let full = ablation.outcome(VariantRole::Full)?;
    let error = |outcome: &VariantOutcome| outcome.physics.rms_error;
    let seconds = |outcome: &VariantOutcome| outcome.cost.cpu_seconds_a_simulated_second;
    let removed = SceneEffect::ALL.iter().filter_map(|effect| {
        let outcome = ablation.outcome(VariantRole::Removed(*effect))?;
        let change = error(outcome)? / error(full)?;
        Some((effect.name(), change, seconds(outcome) / seconds(full)))
    });
    let removed: Vec<(&str, f64, f64)> = removed.collect();
    let far = |change: f64| change.ln().abs();
    let moves = removed
        .iter()
        .max_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
    let costs = removed.iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
    Some(format!(
        "Removing {} changes the rms displacement error most: to {} times that of the full scene. Removing {} leaves the \
         cheapest variant, with {} times the processor time of the full scene. Variants with clearance are chaotic, so a small \
         difference between two of them is not the influence of an effect.",
        moves.0,
        numbers::digits(moves.1),
        costs.0,
        numbers::digits(costs.2)
    ))
}
