//! Newton's iteration, which stages, projections, equilibria, poses of a mechanism and its assembly share.

use super::Failure;
use super::interruption;
use crate::math::larger;

/// What is known before an iteration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iteration {
    /// Iterations so far.
    pub number: usize,
    /// The last update; infinite before the first.
    pub last: f64,
    /// Ratio of the last update to the one before; zero where there are not two.
    pub rate: f64,
}

/// The largest change of an unknown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Update {
    /// Its magnitude.
    pub size: f64,
    /// The unknown.
    pub index: usize,
}

impl Update {
    /// The largest of some changes; what is not a number counts as larger than all numbers.
    #[inline]
    pub fn largest(changes: impl Iterator<Item = f64> + Clone) -> Update {
        let size = changes.clone().fold(0.0, larger);
        let index = changes.map(f64::abs).position(|x| x.is_nan() || x >= size);
        Update {
            size,
            index: index.unwrap_or(0),
        }
    }
}

/// Repeats `step`, which moves the unknowns and says how far and whether this is enough, at most `limit` times.
///
/// # Errors
/// That of `step`, an update that is not finite, no convergence.
#[inline]
pub(crate) fn iterate(
    limit: usize,
    mut step: impl FnMut(&Iteration) -> Result<(Update, bool), Failure>,
) -> Result<(), Failure> {
    let mut iteration = Iteration {
        number: 0,
        last: f64::INFINITY,
        rate: 0.0,
    };
    let mut worst = 0;
    while iteration.number < limit {
        let (Update { size, index }, converged) = step(&iteration)?;
        worst = index;
        if !size.is_finite() {
            return Err(Failure::NotFinite { index });
        }
        if converged {
            return Ok(());
        }
        iteration = Iteration {
            rate: size / iteration.last,
            number: iteration.number + 1,
            last: size,
        };
    }
    Err(Failure::NoConvergence {
        index: worst,
        update: iteration.last,
    })
}

/// As [`iterate`], where it may take long and is no part of a step: see [`super::interruptible`].
///
/// # Errors
/// Those of [`iterate`]; an interruption counts as an update that is not finite.
pub(crate) fn iterate_interruptibly(
    limit: usize,
    mut step: impl FnMut(&Iteration) -> Result<(Update, bool), Failure>,
) -> Result<(), Failure> {
    iterate(limit, |iteration| match interruption::has_come() {
        true => Err(Failure::NotFinite { index: 0 }),
        false => step(iteration),
    })
}
