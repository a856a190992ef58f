//! How fast actuated joints turn where the driven body moves: theta' = K x', with x the pose of this body.
//!
//! The path determines all coordinates, so Phi_q q' = -Phi_x x' has one solution, and K follows from it. A motion of the body in the null
//! space of K is one that the actuated joints do not prevent. Torques u with K^T u = 0 do no work in any motion: they are in equilibrium
//! with forces inside the mechanism.

use super::{Inner, Kinematics};
use crate::marker::Spin;
use crate::system::System;

/// Motions of the mechanism with unit velocities of the driven body along x, along y and about its reference point.
pub(crate) type UnitMotions = [Vec<f64>; 3];

impl Kinematics {
    /// The velocities of all coordinates for unit velocities of the three coordinates from `x` on, in the pose that `inner` was solved
    /// for. The rates in `inner` are lost.
    pub(crate) fn unit_motions(&self, inner: &mut Inner, x: usize) -> UnitMotions {
        let (mechanism, n) = (&*self.mechanism, self.mechanism.shape().unknowns);
        // what other drives prescribe stands still
        inner.state.v.fill(0.0);
        mechanism.constraint_velocity(&inner.state, &mut inner.phi);
        let own = inner.phi.clone();
        std::array::from_fn(|i| {
            inner.state.v.fill(0.0);
            inner.state.v[x + i] = 1.0;
            mechanism.move_driven_nodes(&mut inner.state);
            mechanism.constraint_velocity(&inner.state, &mut inner.phi);
            let phi = inner.phi.iter_mut().zip(&own);
            phi.for_each(|(phi, own)| *phi -= own);
            self.least_norm(inner);
            inner.state.v[..n].copy_from_slice(&inner.b[..n]);
            inner.state.v.clone()
        })
    }

    /// The multipliers that balance torques between pairs of directions, in the pose that `inner` was solved for: those of the unknown
    /// coordinates alone.
    pub(crate) fn multipliers_of_torques(
        &self,
        inner: &mut Inner,
        torques: &[([Spin; 2], f64)],
    ) -> Vec<f64> {
        let n = self.mechanism.shape().unknowns;
        let Inner {
            state, factors, b, ..
        } = inner;
        b.fill(0.0);
        state.v.fill(0.0);
        for (spins, torque) in torques {
            for (spin, sign) in spins.iter().zip([-1.0, 1.0]) {
                let rate_by = spin.derivatives(&state.q, &state.v).b;
                let own = spin.coordinates().into_iter().zip(rate_by);
                own.filter(|(i, _)| *i < n)
                    .for_each(|(i, by)| b[i] += sign * torque * by);
            }
        }
        self.mechanism.acceleration_matrix().solve(factors, b);
        b[n..].to_vec()
    }
}
