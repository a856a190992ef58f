//! What is compared, one file each. Every function returns rows that the tests assert and the report prints.

pub mod classes;
pub mod equations;
pub mod flexible;
pub mod impacts;
pub mod machines;
pub mod rigid;
pub mod scenes;
pub mod stability;
pub mod statistics;

use crate::trajectory::ComparisonPlan;
use serde::Deserialize;

/// `verify/plans.toml`
#[derive(Deserialize)]
struct Plans {
    scenes: Vec<ComparisonPlan>,
    equations: Vec<ComparisonPlan>,
    motions: Vec<ComparisonPlan>,
    convergence: Vec<flexible::ConvergencePlan>,
    impacts: Vec<impacts::ImpactSeries>,
}

/// What is compared besides the scenes of the project.
fn plans() -> Plans {
    toml::from_str(include_str!("../../plans.toml")).expect("a list of plans")
}
