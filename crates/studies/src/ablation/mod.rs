//! What every effect of a scene does and costs: each added to the rigid ideal mechanism, each removed from the full scene.
//!
//! An effect is taken out of the data of the scene ([`SceneEffect::removed_from`]), so that its absence is that of a scene
//! which never named it: no term, no unknown, no evaluation.

mod effects;
mod files;
mod measure;
mod picture;
mod report;
mod table;
mod variants;

pub use effects::{SceneEffect, effects};
pub use files::kind;
pub use measure::{CannotObserve, Cost, Observed, Origin, Physics, PhysicsQuantity, VariantCounts};
pub use picture::figure;
pub use report::{AblationTiming, Repeatable};
pub use variants::{Variant, VariantRole, variants};

use looselink::scene::Scene;
use looselink::simulate::Notice;
use measure::{VariantRun, run, time};
use serde::Serialize;

/// A scene, effect by effect.
#[derive(Debug, Clone)]
pub struct Ablation {
    header: AblationHeader,
    /// The rigid ideal mechanism, what is added to it, the full scene, what is removed from it.
    pub rows: Vec<AblationRow>,
}

/// A variant and what came of it.
#[derive(Debug, Clone)]
pub struct AblationRow {
    /// The variant.
    pub variant: Variant,
    /// Its measurements, or why there are none.
    pub outcome: Result<VariantOutcome, String>,
}

/// Measurements of a variant that runs to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct VariantOutcome {
    /// What it does.
    pub physics: Physics,
    /// The joint with the largest force.
    pub peak_joint: Option<String>,
    /// Sizes and work.
    pub counts: VariantCounts,
    /// What its run warns of.
    pub warnings: Vec<String>,
    /// Processor time.
    pub cost: Cost,
}

/// What is common to all variants.
#[derive(Debug, Clone, Serialize)]
struct AblationHeader {
    title: String,
    scene_hash: String,
    overrides: Vec<String>,
    version: &'static str,
    effects: Vec<SceneEffect>,
    body: Observed,
    /// Simulated time \[s\].
    duration: f64,
    /// Time between rows \[s\].
    interval: f64,
    /// Rows that the quantities are taken from.
    rows: usize,
}

/// Runs every variant of a scene and measures it; variants with the same effects share one measurement.
///
/// `runs` is the number of timed runs, chosen by their length when absent; `tell` hears of what is begun and of
/// warnings.
pub fn ablate(
    scene: &Scene,
    body: Observed,
    runs: Option<usize>,
    tell: &mut dyn FnMut(Notice),
) -> Ablation {
    let variants = variants(scene);
    let mut distinct: Vec<(&Variant, Result<VariantRun, String>)> = Vec::new();
    for variant in &variants {
        if distinct.iter().any(|(v, _)| v.effects == variant.effects) {
            continue;
        }
        let name = variant.name();
        tell(Notice::Begun(&name));
        let ideal = distinct.first().and_then(|(_, run)| run.as_ref().ok());
        let measured = run(variant, &body, ideal.map(|run| &run.path));
        for warning in measured.iter().flat_map(|run| &run.warnings) {
            tell(Notice::Warned {
                run: &name,
                warning,
            });
        }
        distinct.push((variant, measured));
    }
    tell(Notice::Begun("processor times"));
    let ran = distinct.iter().filter(|(_, run)| run.is_ok());
    let ran: Vec<&Scene> = ran.filter_map(|(v, _)| v.scene.as_ref().ok()).collect();
    let mut seconds = time(&ran, runs).into_iter();
    let mut rows_seen = 0;
    let mut outcome = |run: VariantRun| {
        rows_seen = run.rows;
        let seconds = seconds.next().unwrap_or_default();
        VariantOutcome {
            cost: Cost::new(seconds, run.counts.steps, scene.simulation.duration),
            physics: run.physics,
            peak_joint: run.peak_joint,
            counts: run.counts,
            warnings: run.warnings,
        }
    };
    let outcomes = distinct.into_iter();
    let outcomes: Vec<_> = outcomes
        .map(|(variant, run)| (&variant.effects, run.map(&mut outcome)))
        .collect();
    let rows = variants.iter().filter_map(|variant| {
        let mut outcomes = outcomes.iter();
        let (_, outcome) = outcomes.find(|(effects, _)| **effects == variant.effects)?;
        Some(AblationRow {
            variant: variant.clone(),
            outcome: outcome.clone(),
        })
    });
    Ablation {
        rows: rows.collect(),
        header: AblationHeader {
            title: scene.title.clone(),
            scene_hash: scene.hash(),
            overrides: scene.overrides().map(str::to_owned).collect(),
            version: env!("CARGO_PKG_VERSION"),
            effects: effects(scene),
            body,
            duration: scene.simulation.duration,
            interval: scene.output.interval,
            rows: rows_seen,
        },
    }
}

impl Ablation {
    /// The measurements of the variant with this role.
    pub fn outcome(&self, role: VariantRole) -> Option<&VariantOutcome> {
        let row = self.rows.iter().find(|row| row.variant.role == role)?;
        row.outcome.as_ref().ok()
    }
}
