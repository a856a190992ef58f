//! Contact between two bodies. A pair composes three things: a geometry (where the surfaces are and how they move), a normal
//! law (how hard they push), and a friction law, if there is friction.

pub mod friction;
mod frictional_pair;
mod frictionless_pair;
pub mod geometry;
pub mod normal;

pub use frictional_pair::{FrictionalPair, NORMAL_VARIATION, Slip};
pub use frictionless_pair::FrictionlessPair;

use crate::effect::Effect;
use crate::force::{LocalMatrix, WIDTH};
use crate::ledger::{Entry, Powers};
use crate::math::plane::Vec2;
use crate::system::Weights;
use friction::FrictionLaw;
use geometry::Gap;

/// Positions and velocities, and the memory of one contact: the impact velocity \[m/s\], 0 while the contact is open.
#[derive(Debug, Clone, Copy)]
pub struct ContactState<'a> {
    /// Coordinates.
    pub q: &'a [f64],
    /// Velocities.
    pub v: &'a [f64],
    /// Accelerations.
    pub a: &'a [f64],
    /// Impact velocity.
    pub impact_velocity: f64,
}

/// Local indices of some coordinates; those that are not in the list yet are appended to it.
pub(crate) fn local_indices(own: Vec<usize>, coordinates: &mut Vec<usize>) -> Vec<usize> {
    let local = own.into_iter().map(|index| {
        let known = coordinates.iter().position(|&x| x == index);
        known.unwrap_or_else(|| {
            coordinates.push(index);
            coordinates.len() - 1
        })
    });
    local.collect()
}

/// A pair of surfaces that can touch. Its force and what it dissipates are asked of closed contacts only.
pub trait ContactPair: std::fmt::Debug + Send + Sync {
    /// The coordinates in local order. None occurs twice.
    fn coordinates(&self) -> Vec<usize>;
    /// What an evaluation counts as while the surfaces touch.
    fn effects(&self) -> &'static [Effect];
    /// Where the surfaces are.
    fn gap(&self, q: &[f64], v: &[f64]) -> Gap;
    /// d(delta)/dt \[m/s\].
    fn rate(&self, gap: &Gap) -> f64;
    /// Adds the local force (left side of the equations of motion); false where the surfaces do not touch.
    fn force(&self, at: ContactState, f: &mut [f64; WIDTH]) -> bool;
    /// Adds the local force and its tangent w.q df/dq + w.v df/dv; false where the surfaces do not touch.
    fn force_and_tangent(
        &self,
        at: ContactState,
        w: Weights,
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) -> bool;
    /// Force of the first side on the second \[N\].
    fn reaction(&self, at: ContactState) -> Vec2;
    /// Index of the internal state of its friction law, which is zero while the contact is open.
    fn state(&self) -> Option<usize> {
        None
    }
    /// Stored energy of a closed contact \[J\].
    fn energy(&self, at: ContactState) -> f64;
    /// The slip \[m/s\] of a touching contact with friction, and its law.
    fn slip(&self, _at: ContactState) -> Option<(f64, &dyn FrictionLaw)> {
        None
    }
    /// Its entries of the energy ledger.
    fn entries(&self) -> Vec<&'static Entry>;
    /// Adds what it dissipates to its entries; true where the normal force is clamped at zero.
    fn powers(&self, at: ContactState, powers: &mut Powers) -> bool;
}
