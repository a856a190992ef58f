//! Newton's iteration, which stages, projections, equilibria, poses of a mechanism and its assembly share.

use super::Failure;

/// The tangent is renewed when an update is larger than this part of the previous one.
const SLOW: f64 = 0.1;

/// What is known before an iteration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Iteration {
    /// Iterations so far.
    pub number: usize,
    /// The last update; infinite before the first.
    pub last: f64,
    /// True where an earlier tangent would not do: at the beginning, and after updates that decrease slowly.
    pub renew: bool,
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
    pub fn largest(changes: impl Iterator<Item = f64>) -> Update {
        let mut update = Update {
            size: 0.0,
            index: 0,
        };
        for (index, change) in changes.enumerate() {
            let size = change.abs();
            if size.is_nan() || size > update.size {
                update = Update { size, index };
            }
        }
        update
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
        renew: true,
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
            renew: iteration.number > 0 && size / iteration.last > SLOW,
            number: iteration.number + 1,
            last: size,
        };
    }
    Err(Failure::NoConvergence {
        index: worst,
        update: iteration.last,
    })
}
