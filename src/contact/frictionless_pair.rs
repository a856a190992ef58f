//! A contact without friction.

use super::geometry::{Gap, Geometry, Touch};
use super::normal::{NormalForce, NormalLaw};
use super::{ContactPair, ContactState};
use crate::effect::{self, Effect};
use crate::force::{LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::math::plane::Vec2;
use crate::system::Weights;

/// A geometry and a normal law.
#[derive(Debug)]
pub struct FrictionlessPair<G> {
    /// The surfaces.
    pub geometry: G,
    /// Normal law.
    pub law: Box<dyn NormalLaw>,
}

impl<G: Geometry> FrictionlessPair<G> {
    /// The normal force of a closed contact; `None` where the surfaces are apart.
    #[inline]
    pub fn normal_force(&self, gap: &Gap, impact_velocity: f64) -> Option<NormalForce> {
        let closed = impact_velocity > 0.0 && gap.delta > 0.0;
        closed.then(|| {
            let rate = self.geometry.rate(gap);
            self.law.force(gap.delta, rate, impact_velocity)
        })
    }

    /// Gradient of the normal force by the stage unknown.
    #[inline]
    pub(super) fn gradient(&self, touch: &Touch, force: &NormalForce, w: Weights) -> [f64; WIDTH] {
        let mut gradient = [0.0; WIDTH];
        let by_normal = w.q * force.by_delta + w.v * force.by_rate;
        for c in 0..self.geometry.columns() {
            gradient[c] = by_normal * touch.normal[c] + w.q * force.by_rate * touch.rate_q[c];
        }
        gradient
    }

    /// Adds the normal force to `f` and its gradient times its direction to `k`.
    #[inline]
    pub(super) fn press(
        &self,
        touch: &Touch,
        force: &NormalForce,
        gradient: &[f64; WIDTH],
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) {
        let columns = self.geometry.columns();
        for r in 0..columns {
            f[r] += force.value * touch.normal[r];
            for c in 0..columns {
                k[r][c] += touch.normal[r] * gradient[c];
            }
        }
    }
}

impl<G: Geometry> ContactPair for FrictionlessPair<G> {
    fn coordinates(&self) -> Vec<usize> {
        self.geometry.coordinates()
    }

    fn effects(&self) -> &'static [Effect] {
        &[effect::CONTACT]
    }

    fn gap(&self, q: &[f64], v: &[f64]) -> Gap {
        self.geometry.gap(q, v)
    }

    fn rate(&self, gap: &Gap) -> f64 {
        self.geometry.rate(gap)
    }

    fn force(&self, at: ContactState, f: &mut [f64; WIDTH]) -> bool {
        let gap = self.geometry.gap(at.q, at.v);
        let force = self.normal_force(&gap, at.impact_velocity);
        if let Some(force) = &force {
            self.geometry.push(at, &gap, force.value, f);
        }
        force.is_some()
    }

    fn force_and_tangent(
        &self,
        at: ContactState,
        w: Weights,
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) -> bool {
        let gap = self.geometry.gap(at.q, at.v);
        let Some(force) = self.normal_force(&gap, at.impact_velocity) else {
            return false;
        };
        let touch = self.geometry.touch(at, &gap);
        let gradient = self.gradient(&touch, &force, w);
        self.press(&touch, &force, &gradient, f, k);
        self.geometry
            .curve(at, &gap, &touch, w.q * force.value, 0.0, k);
        true
    }

    fn reaction(&self, at: ContactState) -> Vec2 {
        let gap = self.geometry.gap(at.q, at.v);
        let force = self.normal_force(&gap, at.impact_velocity);
        force.map_or(Vec2::zeros(), |force| {
            -self.geometry.along_normal(&gap, force.value)
        })
    }

    fn energy(&self, at: ContactState) -> f64 {
        if at.impact_velocity > 0.0 {
            self.law.energy(self.geometry.gap(at.q, at.v).delta)
        } else {
            0.0
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::CONTACT, &ledger::CLAMP]
    }

    fn powers(&self, at: ContactState, powers: &mut Powers) -> bool {
        let gap = self.geometry.gap(at.q, at.v);
        let Some(force) = self.normal_force(&gap, at.impact_velocity) else {
            return false;
        };
        let loss = (force.value - force.elastic) * self.geometry.rate(&gap);
        powers.add(0, loss);
        if force.clamped {
            powers.add(1, loss);
        }
        force.clamped
    }
}
