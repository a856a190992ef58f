//! Which points a sweep visits: one design a file.
//!
//! A design is a list of points; a point gives every parameter a value. Points do not depend on results, except those of a
//! [bisection](super::bisection).

mod grid;
mod latin_hypercube;
mod list;
mod sensitivity;
mod sobol;

pub use sensitivity::SensitivityDesign;

use super::{FieldValue, SweepParameter};
use serde::Deserialize;
use std::fmt::Debug;

/// Name of a design in a study.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DesignKind {
    /// Every combination of the values.
    #[default]
    Grid,
    /// The first values of all parameters, the second ones, and so on.
    List,
    /// Random, with every n-th part of every range visited once.
    LatinHypercube,
    /// Points of a Sobol sequence.
    Sobol,
    /// Pairs of points that tell the influence of every parameter.
    Sensitivity,
    /// Where a measure reaches a value.
    Bisection,
}

/// The points of a sweep.
pub trait Design: Debug + Send + Sync {
    /// Their number.
    fn points(&self) -> usize;
    /// The value of every parameter at a point.
    fn values(&self, parameters: &[&SweepParameter], point: usize) -> Vec<FieldValue>;
}

impl DesignKind {
    /// True where `samples` says how many points there are.
    pub fn is_sampled(self) -> bool {
        use DesignKind::{LatinHypercube, Sensitivity, Sobol};
        matches!(self, LatinHypercube | Sobol | Sensitivity)
    }

    /// The design of some parameters; none for a bisection, whose points depend on results.
    ///
    /// # Errors
    /// Parameters that the design cannot have.
    pub(super) fn design(
        self,
        parameters: &[&SweepParameter],
        samples: usize,
        seed: u64,
    ) -> Result<Option<Box<dyn Design>>, String> {
        Ok(Some(match self {
            DesignKind::Grid => Box::new(grid::GridDesign::new(parameters)),
            DesignKind::List => Box::new(list::ListDesign::new(parameters)?),
            DesignKind::LatinHypercube => Box::new(latin_hypercube::LatinHypercubeDesign::new(
                parameters.len(),
                samples,
                seed,
            )),
            DesignKind::Sobol => {
                Box::new(sobol::SobolDesign::new(parameters.len(), samples, seed)?)
            }
            DesignKind::Sensitivity => {
                Box::new(SensitivityDesign::new(parameters.len(), samples, seed)?)
            }
            DesignKind::Bisection => return Ok(None),
        }))
    }
}
