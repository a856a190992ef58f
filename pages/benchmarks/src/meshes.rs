//! The processor time that one error takes, by the number of elements of the links of case 2.

use miette::{Result, miette};
use serde::{Deserialize, Serialize};
use std::path::Path;
use studies::precision::{Effort, Study, StudyOutcome, Times};

/// Elements of every link.
pub const ELEMENTS: [usize; 4] = [1, 4, 16, 64];
/// Errors of position \[m\].
pub const ERRORS: [f64; 2] = [1e-9, 1e-11];

/// The times of a curve with a number of elements.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MeshCost {
    /// Elements of every link.
    pub elements: usize,
    /// Curve of the study.
    pub curve: String,
    /// Time of each of [`ERRORS`]; absent where no step reaches it.
    pub times: [Option<MeshTime>; 2],
}

/// The time of an error.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct MeshTime {
    /// Processor time \[s\].
    pub seconds: f64,
    /// True where it is on the line between two runs.
    pub is_interpolated: bool,
}

/// Runs the study of the mesh for every number of elements; its reference has the same mesh.
///
/// # Errors
/// When the study is faulty.
pub fn measure(root: &Path, repeats: usize) -> Result<Vec<MeshCost>> {
    let path = root.join("pages/benchmarks/meshes.toml");
    let study = Study::load(&path).map_err(|e| miette!("{e}"))?;
    let mut costs = Vec::new();
    for elements in ELEMENTS {
        eprintln!("case 2 with {elements} elements a link");
        let mut study = study.clone();
        study.set = (1..=3)
            .map(|link| format!("bodies.link{link}.elements={elements}"))
            .collect();
        let effort = Effort {
            repeats,
            smoke: false,
        };
        let outcome = StudyOutcome::run(&study, effort, &mut |_| ()).map_err(|e| miette!("{e}"))?;
        for curve in outcome.curves() {
            costs.push(MeshCost {
                elements,
                curve: curve.to_owned(),
                times: ERRORS.map(|error| {
                    let found = outcome.time_at(curve, error, Times::Interpolated)?;
                    Some(MeshTime {
                        seconds: found.seconds,
                        is_interpolated: found.is_interpolated,
                    })
                }),
            });
        }
    }
    Ok(costs)
}
