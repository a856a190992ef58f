//! Starts beside that of the scene: what is left of a result where a motion is chaotic.

use looselink::simulate::{RunError, Simulation};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde::Deserialize;

/// `[starts]`
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Starts {
    /// Starts of every point; the first is that of the scene.
    pub count: usize,
    /// Largest change of an unknown velocity \[m/s; of slopes 1/s, of angles rad/s\].
    pub velocity: f64,
}

impl Starts {
    /// Changes every unknown velocity of a simulation that has not begun by a random amount, equally distributed between
    /// -`velocity` and `velocity`, and projects the velocities on the constraints. Start 0 is that of the scene.
    ///
    /// # Errors
    /// [`RunError::Physics`] where the changed state has no accelerations.
    pub fn disturb(
        &self,
        simulation: &mut Simulation,
        seed: u64,
        start: usize,
    ) -> Result<(), RunError> {
        if start == 0 {
            return Ok(());
        }
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(start as u64);
        let mut state = simulation.state().clone();
        let unknowns = simulation.model().shape().unknowns;
        for v in &mut state.v[..unknowns] {
            *v += self.velocity * (2.0 * unit(&mut random) - 1.0);
        }
        simulation.continue_from(&state)
    }
}

/// A random number in 0 <= u < 1 with 53 bits.
pub(super) fn unit(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (0.5_f64).powi(53)
}

/// A random whole number below `count`.
pub(super) fn below(random: &mut ChaCha8Rng, count: usize) -> usize {
    (unit(random) * count as f64) as usize
}
