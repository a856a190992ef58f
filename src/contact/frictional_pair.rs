//! A contact with friction, whose force acts against one of two slip velocities.
//!
//! * `paper`: eqs. 22-23 as printed. The contact points move with R_k dn/dt, so v_t = (e_dot . t) delta/|e|, and the force
//!   acts on the centres, without couples.
//! * `material`: the contact points move with the bodies, v_t = e_dot . t + omega_j R_j - omega_i R_i, and the force acts
//!   at the contact point: couples -R_j T on the journal's body and R_i T on the bearing's.

use super::friction::{FrictionLaw, TangentialForce};
use super::geometry::{Gap, Geometry, Touch};
use super::normal::NormalForce;
use super::{ContactPair, ContactState, FrictionlessPair, local_indices};
use crate::effect::{self, Effect};
use crate::force::{LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers, Side};
use crate::marker::{Spin, SpinDerivatives};
use crate::math::plane::Vec2;
use crate::system::Weights;
use std::sync::Arc;

/// Which slip velocity friction acts against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// Eqs. 22 and 23 as printed.
    Paper,
    /// Velocity of the material at the point of contact.
    Material,
}

/// What changes of normal forces add to the energy that internal states of friction store, of either sign.
pub static NORMAL_VARIATION: Entry = Entry {
    name: "normal_variation",
    side: Side::Supplied,
};

/// A contact with friction.
#[derive(Debug)]
pub struct FrictionalPair<G> {
    /// Geometry and normal law.
    pub surface: FrictionlessPair<G>,
    /// Tangential law.
    pub law: Arc<dyn FrictionLaw>,
    /// Index of its internal state, of a law that has one; the last of the local coordinates.
    state: Option<usize>,
    slip: Slip,
    /// Radius times sign, spin, and local indices of the coordinates of the spin, of both sides; none for `paper`.
    rims: Vec<(f64, Spin, Vec<usize>)>,
    coordinates: Vec<usize>,
}

/// The slip velocity and its derivatives in local coordinates.
struct SlipState {
    value: f64,
    /// d(slip)/dv for `material`; e_dot . t by v for `paper`. The force acts along it.
    lever: [f64; WIDTH],
    by_v: [f64; WIDTH],
    by_q: [f64; WIDTH],
    spins: [SpinDerivatives; 2],
}

/// A touching contact: geometry, slip and both forces.
struct Sliding {
    gap: Gap,
    touch: Touch,
    slip: SlipState,
    normal: NormalForce,
    tangential: TangentialForce,
}

impl<G: Geometry> FrictionalPair<G> {
    /// A contact of bodies that turn with the given spins, with the internal state of a law that has one.
    pub fn new(
        surface: FrictionlessPair<G>,
        law: Arc<dyn FrictionLaw>,
        slip: Slip,
        spins: [Spin; 2],
        state: Option<usize>,
    ) -> Self {
        let mut coordinates = surface.geometry.coordinates();
        let mut rims = Vec::new();
        if slip == Slip::Material {
            let sides = surface.geometry.radii().into_iter().zip(spins);
            for (radius, spin) in sides.filter(|(radius, _)| *radius != 0.0) {
                let local = local_indices(spin.coordinates(), &mut coordinates);
                rims.push((radius, spin, local));
            }
        }
        coordinates.extend(state);
        FrictionalPair {
            surface,
            law,
            state,
            slip,
            rims,
            coordinates,
        }
    }

    fn slip_state(&self, q: &[f64], v: &[f64], gap: &Gap, touch: &Touch) -> SlipState {
        let mut s = SlipState {
            value: touch.slip,
            lever: touch.tangent,
            by_v: touch.tangent,
            by_q: touch.slip_q,
            spins: Default::default(),
        };
        match self.slip {
            Slip::Paper => {
                let [share, growth] = self.surface.geometry.share(gap);
                s.value = touch.slip * share;
                for c in 0..self.surface.geometry.columns() {
                    s.by_v[c] *= share;
                    s.by_q[c] = share * touch.slip_q[c] + touch.slip * growth * touch.normal[c];
                }
            }
            Slip::Material => {
                for (side, (radius, spin, local)) in self.rims.iter().enumerate() {
                    let d = spin.derivatives(q, v);
                    s.value += radius * spin.rate(q, v);
                    for (m, &c) in local.iter().enumerate() {
                        s.by_v[c] += radius * d.b[m];
                        s.by_q[c] += radius * d.rate_q[m];
                    }
                    s.spins[side] = d;
                }
                s.lever = s.by_v;
            }
        }
        s
    }

    /// Everything about a touching contact, and about one that is closed and has an internal state; `None` where the surfaces are apart.
    fn sliding(&self, at: ContactState) -> Option<Sliding> {
        let gap = self.surface.geometry.gap(at.q, at.v);
        let force = self.surface.normal_force(&gap, at.impact_velocity);
        let has_state = self.state.is_some() && at.impact_velocity > 0.0;
        let normal = force.or(has_state.then(NormalForce::default))?;
        let touch = self.surface.geometry.touch(at, &gap);
        let slip = self.slip_state(at.q, at.v, &gap, &touch);
        let state = self.internal_state(at);
        let tangential = self.law.force(slip.value, normal.value, state);
        Some(Sliding {
            gap,
            touch,
            slip,
            normal,
            tangential,
        })
    }

    /// Normal and tangential force of a touching contact.
    pub fn forces(&self, at: ContactState) -> Option<(NormalForce, TangentialForce)> {
        self.sliding(at).map(|s| (s.normal, s.tangential))
    }

    /// The internal state of the law; zero where it has none.
    fn internal_state(&self, at: ContactState) -> f64 {
        self.state.map_or(0.0, |state| at.v[state])
    }

    /// What friction dissipates \[W\], the power of the tangential force on the velocities it acts on less what the state stores of it,
    /// and what the change of the normal force adds to what is stored.
    pub fn dissipation(&self, at: ContactState) -> [f64; 2] {
        self.sliding(at).map_or([0.0; 2], |s| {
            let levers = self.coordinates.iter().zip(s.slip.lever);
            let taken = s.tangential.value * levers.map(|(&i, l)| l * at.v[i]).sum::<f64>();
            if self.state.is_none() {
                return [taken, 0.0];
            }
            let [stored, slope] = self.law.stored(self.internal_state(at));
            let sum = |gradient: &[f64; WIDTH], of: &[f64]| {
                let local = self.coordinates.iter().zip(gradient);
                local.map(|(&i, g)| g * of[i]).sum::<f64>()
            };
            let rate = self.surface.geometry.rate(&s.gap);
            let growth = sum(&s.touch.normal, at.a) + sum(&s.touch.rate_q, at.v);
            let of_normal = s.normal.by_delta * rate + s.normal.by_rate * growth;
            [
                taken - s.normal.value * slope * s.tangential.rate.value,
                of_normal * stored,
            ]
        })
    }
}

impl<G: Geometry> ContactPair for FrictionalPair<G> {
    fn coordinates(&self) -> Vec<usize> {
        self.coordinates.clone()
    }

    fn effects(&self) -> &'static [Effect] {
        &[effect::CONTACT, effect::FRICTION]
    }

    fn gap(&self, q: &[f64], v: &[f64]) -> Gap {
        self.surface.geometry.gap(q, v)
    }

    fn rate(&self, gap: &Gap) -> f64 {
        self.surface.geometry.rate(gap)
    }

    fn force(&self, at: ContactState, f: &mut [f64; WIDTH]) -> bool {
        let sliding = self.sliding(at);
        if let Some(s) = &sliding {
            self.surface.geometry.push(at, &s.gap, s.normal.value, f);
            for (f, lever) in f.iter_mut().zip(s.slip.lever) {
                *f += s.tangential.value * lever;
            }
            if self.state.is_some() {
                f[self.coordinates.len() - 1] -= s.tangential.rate.value;
            }
        }
        sliding.is_some()
    }

    fn force_and_tangent(
        &self,
        at: ContactState,
        w: Weights,
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) -> bool {
        let Some(s) = self.sliding(at) else {
            return false;
        };
        let Sliding {
            gap,
            touch,
            slip,
            normal,
            tangential,
        } = s;
        let normal_gradient = self.surface.gradient(&touch, &normal, w);
        self.surface.press(&touch, &normal, &normal_gradient, f, k);
        for r in 0..self.coordinates.len() {
            f[r] += tangential.value * slip.lever[r];
            for c in 0..self.coordinates.len() {
                let slip_gradient = w.v * slip.by_v[c] + w.q * slip.by_q[c];
                let gradient =
                    tangential.by_slip * slip_gradient + tangential.by_normal * normal_gradient[c];
                k[r][c] += slip.lever[r] * gradient;
            }
        }
        if self.state.is_some() {
            let last = self.coordinates.len() - 1;
            let rate = tangential.rate;
            f[last] -= rate.value;
            for c in 0..last {
                k[c][last] += w.v * tangential.by_state * slip.lever[c];
                k[last][c] -= rate.by_slip * (w.v * slip.by_v[c] + w.q * slip.by_q[c]);
            }
            k[last][last] -= w.v * rate.by_state;
        }
        let [normal, tangential] = [w.q * normal.value, w.q * tangential.value];
        self.surface
            .geometry
            .curve(at, &gap, &touch, normal, tangential, k);
        for ((radius, _, local), d) in self.rims.iter().zip(slip.spins) {
            for (m, &r) in local.iter().enumerate() {
                for (n, &c) in local.iter().enumerate() {
                    k[r][c] += tangential * radius * d.b_q[m][n];
                }
            }
        }
        true
    }

    fn reaction(&self, at: ContactState) -> Vec2 {
        self.sliding(at).map_or(Vec2::zeros(), |s| {
            -(s.normal.value * s.touch.n + s.tangential.value * s.touch.t)
        })
    }

    fn energy(&self, at: ContactState) -> f64 {
        let normal = self.surface.energy(at);
        if self.state.is_none() {
            return normal;
        }
        let gap = self.surface.geometry.gap(at.q, at.v);
        let force = self.surface.normal_force(&gap, at.impact_velocity);
        let [stored, _] = self.law.stored(self.internal_state(at));
        normal + force.map_or(0.0, |force| force.value * stored)
    }

    fn state(&self) -> Option<usize> {
        self.state
    }

    fn slip(&self, at: ContactState) -> Option<(f64, &dyn FrictionLaw)> {
        let sliding = self.sliding(at)?;
        Some((sliding.slip.value, &*self.law))
    }

    fn entries(&self) -> Vec<&'static Entry> {
        let mut entries = self.surface.entries();
        entries.push(&ledger::FRICTION);
        if self.state.is_some() {
            entries.push(&NORMAL_VARIATION);
        }
        entries
    }

    fn powers(&self, at: ContactState, powers: &mut Powers) -> bool {
        let [dissipated, varied] = self.dissipation(at);
        powers.add(2, dissipated);
        if self.state.is_some() {
            powers.add(3, varied);
        }
        self.surface.powers(at, powers)
    }
}
