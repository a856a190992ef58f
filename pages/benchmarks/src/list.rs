//! The steps that are counted, as `steps.toml` lists them.

use miette::{IntoDiagnostic, Result, WrapErr};
use serde::Deserialize;
use std::path::Path;

/// The list.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepList {
    /// Commit with which the steps are compared.
    pub baseline: String,
    /// The steps.
    pub steps: Vec<StepRow>,
}

/// A scene and a method.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRow {
    /// Its name on the page.
    pub name: String,
    /// The scene, from the root of the workspace.
    pub scene: String,
    /// Changes to the scene.
    #[serde(default)]
    pub set: Vec<String>,
}

impl StepList {
    /// Reads the list.
    ///
    /// # Errors
    /// When it is not there or has faults.
    pub fn read(root: &Path) -> Result<StepList> {
        let path = root.join("pages/benchmarks/steps.toml");
        let text = std::fs::read_to_string(&path)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", path.display()))?;
        toml::from_str(&text)
            .into_diagnostic()
            .wrap_err_with(|| path.display().to_string())
    }
}
