//! Loose joint with friction: eq. 26 acting against one of two slip velocities.
//!
//! * `paper`: eqs. 22-23 as printed. The contact points move with R_k dn/dt, so v_t = (e_dot . t) delta/|e|, and the force
//!   acts on the centres, without couples.
//! * `material`: the contact points move with the bodies, v_t = e_dot . t + omega_j R_j - omega_i R_i, and the force acts
//!   at the contact point: couples -R_j T on the journal's body and R_i T on the bearing's.

use super::clearance_joint::Touch;
use super::{ClearanceJoint, Geometry, LocalMatrix, WIDTH};
use crate::contact::ambrosio::TangentialForce;
use crate::contact::{Ambrosio, NormalForce};
use crate::marker::{Spin, SpinDerivatives};
use crate::math::plane::{Vec2, add, dot, scale};
use crate::scene::Slip;
use crate::system::Weights;

/// A loose joint with friction.
#[derive(Debug)]
pub struct FrictionalJoint {
    /// Geometry and normal law.
    pub joint: ClearanceJoint,
    /// Tangential law.
    pub law: Ambrosio,
    slip: Slip,
    /// Radius times sign, spin, and local indices of the coordinates of the spin: bearing, journal; none for `paper`.
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
    g: Geometry,
    touch: Touch,
    slip: SlipState,
    normal: NormalForce,
    tangential: TangentialForce,
}

impl FrictionalJoint {
    /// A joint whose bodies turn with the given spins; `bearing_radius` is R_i \[m\].
    pub fn new(
        joint: ClearanceJoint,
        law: Ambrosio,
        slip: Slip,
        bearing_radius: f64,
        spins: [Spin; 2],
    ) -> Self {
        let mut coordinates = joint.coordinates();
        let mut rims = Vec::new();
        if slip == Slip::Material {
            let radii = [-bearing_radius, bearing_radius - joint.clearance];
            for (radius, spin) in radii.into_iter().zip(spins) {
                let local = spin.coordinates().into_iter().map(|index| {
                    coordinates
                        .iter()
                        .position(|&known| known == index)
                        .unwrap_or_else(|| {
                            coordinates.push(index);
                            coordinates.len() - 1
                        })
                });
                let local = local.collect();
                rims.push((radius, spin, local));
            }
        }
        FrictionalJoint {
            joint,
            law,
            slip,
            rims,
            coordinates,
        }
    }

    /// The coordinates in local order.
    pub fn coordinates(&self) -> Vec<usize> {
        self.coordinates.clone()
    }

    fn slip_state(&self, q: &[f64], v: &[f64], g: &Geometry, touch: &Touch) -> SlipState {
        let mut s = SlipState {
            value: touch.slip,
            lever: touch.tangent,
            by_v: touch.tangent,
            by_q: touch.slip_q,
            spins: Default::default(),
        };
        match self.slip {
            Slip::Paper => {
                let share = g.delta / g.eccentricity;
                let growth = self.joint.clearance / (g.eccentricity * g.eccentricity);
                s.value = touch.slip * share;
                for c in 0..self.joint.columns() {
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

    /// Everything about a touching contact; `None` where the surfaces are apart.
    fn sliding(&self, q: &[f64], v: &[f64], impact_velocity: f64) -> Option<Sliding> {
        let g = self.joint.geometry(q, v);
        let normal = self.joint.normal_force(&g, impact_velocity)?;
        let touch = self.joint.touch(v, &g);
        let slip = self.slip_state(q, v, &g, &touch);
        let tangential = self.law.force(slip.value, normal.value);
        Some(Sliding {
            g,
            touch,
            slip,
            normal,
            tangential,
        })
    }

    /// Normal and tangential force of a touching contact.
    pub fn forces(
        &self,
        q: &[f64],
        v: &[f64],
        impact_velocity: f64,
    ) -> Option<(NormalForce, TangentialForce)> {
        let s = self.sliding(q, v, impact_velocity)?;
        Some((s.normal, s.tangential))
    }

    /// Force of the bearing on the journal \[N\].
    pub fn journal_force(&self, q: &[f64], v: &[f64], impact_velocity: f64) -> Vec2 {
        self.sliding(q, v, impact_velocity).map_or([0.0; 2], |s| {
            let normal = scale(s.normal.value, s.touch.n);
            scale(-1.0, add(normal, scale(s.tangential.value, s.touch.t)))
        })
    }

    /// Power taken by friction \[W\]: the tangential force on the velocities it acts on.
    pub fn dissipation(&self, q: &[f64], v: &[f64], impact_velocity: f64) -> f64 {
        self.sliding(q, v, impact_velocity).map_or(0.0, |s| {
            let levers = self.coordinates.iter().zip(s.slip.lever);
            s.tangential.value * levers.map(|(&i, l)| l * v[i]).sum::<f64>()
        })
    }

    /// Adds the local force to `f`; returns the normal force where the surfaces touch.
    pub fn force(
        &self,
        q: &[f64],
        v: &[f64],
        impact_velocity: f64,
        f: &mut [f64; WIDTH],
    ) -> Option<NormalForce> {
        let s = self.sliding(q, v, impact_velocity)?;
        self.add_force(&s, f);
        Some(s.normal)
    }

    fn add_force(&self, s: &Sliding, f: &mut [f64; WIDTH]) {
        self.joint.add_force(&s.touch, &s.normal, f);
        for (f, lever) in f.iter_mut().zip(s.slip.lever) {
            *f += s.tangential.value * lever;
        }
    }

    /// Adds the local force to `f` and the tangent to `k`; returns the normal force where the surfaces touch.
    pub fn force_and_tangent(
        &self,
        q: &[f64],
        v: &[f64],
        impact_velocity: f64,
        w: Weights,
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) -> Option<NormalForce> {
        let s = self.sliding(q, v, impact_velocity)?;
        self.add_force(&s, f);
        let Sliding {
            g,
            touch,
            slip,
            normal,
            tangential,
        } = s;
        self.joint.add_tangent(&g, &touch, &normal, w, k);

        let normal_gradient = self.joint.force_gradient(&touch, &normal, w);
        let turning = w.q * tangential.value / g.eccentricity;
        for r in 0..self.coordinates.len() {
            for c in 0..self.coordinates.len() {
                let slip_gradient = w.v * slip.by_v[c] + w.q * slip.by_q[c];
                let gradient =
                    tangential.by_slip * slip_gradient + tangential.by_normal * normal_gradient[c];
                k[r][c] += slip.lever[r] * gradient - turning * touch.normal[r] * touch.tangent[c];
            }
        }
        for (c, bend) in touch.bends.iter().flatten() {
            k[*c][*c] += w.q * tangential.value * dot(touch.t, *bend);
        }
        for ((radius, _, local), d) in self.rims.iter().zip(slip.spins) {
            for (m, &r) in local.iter().enumerate() {
                for (n, &c) in local.iter().enumerate() {
                    k[r][c] += w.q * tangential.value * radius * d.b_q[m][n];
                }
            }
        }
        Some(normal)
    }
}
