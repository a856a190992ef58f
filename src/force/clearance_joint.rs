//! Revolute joint with clearance (eqs. 19-23): a journal that moves inside a bearing and touches it.
//!
//! e = r_j - r_i from bearing to journal, n = e/|e|, t = n turned by 90 degrees, delta = |e| - c. With delta > 0 and the
//! contact closed, the bearing pushes the journal with -F_n n. Neither n nor a law is evaluated otherwise: at the start
//! of the paper's runs e = 0 and n does not exist.

use super::{LocalMatrix, WIDTH};
use crate::contact::{NormalForce, NormalLaw};
use crate::marker::Marker;
use crate::math::plane::{Vec2, cross, dot, norm, perp, scale, sub};
use crate::system::Weights;

/// A loose joint without friction.
#[derive(Debug)]
pub struct ClearanceJoint {
    /// Point i, the centre of the bearing.
    pub bearing: Marker,
    /// Point j, the centre of the journal.
    pub journal: Marker,
    /// Radial clearance c = R_i - R_j \[m\].
    pub clearance: f64,
    /// Normal law.
    pub law: Box<dyn NormalLaw>,
}

/// Where the journal is in its bearing.
#[derive(Debug, Clone, Copy)]
pub struct Geometry {
    /// Eccentricity vector (eq. 19) \[m\].
    pub e: Vec2,
    /// Its rate \[m/s\].
    pub e_dot: Vec2,
    /// |e| \[m\].
    pub eccentricity: f64,
    /// delta = |e| - c (eq. 21) \[m\].
    pub delta: f64,
    arms: [Vec2; 2],
}

/// A touching contact: directions, rates, and the gradients of both in local coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub n: Vec2,
    pub t: Vec2,
    /// e_dot . t
    pub slip: f64,
    /// n^T J_e = d(delta)/dq = d(delta_dot)/dv.
    pub normal: [f64; WIDTH],
    /// t^T J_e.
    pub tangent: [f64; WIDTH],
    /// d(delta_dot)/dq.
    pub rate_q: [f64; WIDTH],
    /// d(e_dot . t)/dq.
    pub slip_q: [f64; WIDTH],
    /// For a marker on a body: local index of theta and d2(e)/d(theta)2.
    pub bends: [Option<(usize, Vec2)>; 2],
}

impl ClearanceJoint {
    /// The coordinates in local order: bearing, journal.
    pub fn coordinates(&self) -> Vec<usize> {
        [self.bearing.coordinates(), self.journal.coordinates()].concat()
    }

    /// Number of local coordinates.
    #[inline]
    pub fn columns(&self) -> usize {
        self.bearing.width() + self.journal.width()
    }

    /// Eccentricity and penetration.
    #[inline]
    pub fn geometry(&self, q: &[f64], v: &[f64]) -> Geometry {
        let arms = [self.bearing.arm(q), self.journal.arm(q)];
        let e = sub(
            self.journal.position(q, arms[1]),
            self.bearing.position(q, arms[0]),
        );
        let e_dot = sub(
            self.journal.velocity(v, arms[1]),
            self.bearing.velocity(v, arms[0]),
        );
        let eccentricity = norm(e);
        Geometry {
            e,
            e_dot,
            eccentricity,
            delta: eccentricity - self.clearance,
            arms,
        }
    }

    /// d(delta)/dt = n . e_dot \[m/s\]; |e_dot| for a journal that leaves the centre.
    pub fn rate(g: &Geometry) -> f64 {
        if g.eccentricity > 0.0 {
            dot(g.e, g.e_dot) / g.eccentricity
        } else {
            norm(g.e_dot)
        }
    }

    /// Directions, rates and gradients, for a journal off the centre.
    pub(super) fn touch(&self, v: &[f64], g: &Geometry) -> Touch {
        let n = scale(1.0 / g.eccentricity, g.e);
        let t = perp(n);
        let (rate, slip) = (dot(g.e_dot, n), dot(g.e_dot, t));
        let mut touch = Touch {
            n,
            t,
            slip,
            normal: [0.0; WIDTH],
            tangent: [0.0; WIDTH],
            rate_q: [0.0; WIDTH],
            slip_q: [0.0; WIDTH],
            bends: [None; 2],
        };
        let mut column = 0;
        for (side, (marker, sign)) in [(&self.bearing, -1.0), (&self.journal, 1.0)]
            .into_iter()
            .enumerate()
        {
            if let Marker::OnChord { .. } = marker {
                unreachable!("links of a mechanism with contacts have nodes where joints are");
            }
            for i in 0..2 {
                touch.normal[column + i] = sign * n[i];
                touch.tangent[column + i] = sign * t[i];
            }
            if let Marker::OnBody { x, .. } = *marker {
                let arm = g.arms[side];
                let turn = scale(sign, perp(arm));
                touch.normal[column + 2] = dot(n, turn);
                touch.tangent[column + 2] = dot(t, turn);
                // e_dot depends on theta through the direction of the arm
                let bend = scale(-sign, arm);
                touch.rate_q[column + 2] = v[x + 2] * dot(n, bend);
                touch.slip_q[column + 2] = v[x + 2] * dot(t, bend);
                touch.bends[side] = Some((column + 2, bend));
            }
            column += marker.width();
        }
        // n and t turn with e: dn = t (t . de)/|e|, dt = -n (t . de)/|e|
        for c in 0..column {
            touch.rate_q[c] += slip / g.eccentricity * touch.tangent[c];
            touch.slip_q[c] -= rate / g.eccentricity * touch.tangent[c];
        }
        touch
    }

    /// The normal force of a closed contact; `None` where the surfaces are apart.
    #[inline]
    pub fn normal_force(&self, g: &Geometry, impact_velocity: f64) -> Option<NormalForce> {
        let closed = impact_velocity > 0.0 && g.delta > 0.0;
        closed.then(|| {
            self.law
                .force(g.delta, dot(g.e, g.e_dot) / g.eccentricity, impact_velocity)
        })
    }

    /// Adds to `f` the local force of a touching contact (left side of the equations of motion).
    #[inline]
    pub(super) fn add_force(&self, touch: &Touch, force: &NormalForce, f: &mut [f64; WIDTH]) {
        for c in 0..self.columns() {
            f[c] += force.value * touch.normal[c];
        }
    }

    /// Gradient of the normal force by the stage unknown.
    #[inline]
    pub(super) fn force_gradient(
        &self,
        touch: &Touch,
        force: &NormalForce,
        w: Weights,
    ) -> [f64; WIDTH] {
        let mut gradient = [0.0; WIDTH];
        let by_normal = w.q * force.by_delta + w.v * force.by_rate;
        for c in 0..self.columns() {
            gradient[c] = by_normal * touch.normal[c] + w.q * force.by_rate * touch.rate_q[c];
        }
        gradient
    }

    /// Adds to `k` the local tangent of a touching contact.
    #[inline]
    pub(super) fn add_tangent(
        &self,
        g: &Geometry,
        touch: &Touch,
        force: &NormalForce,
        w: Weights,
        k: &mut LocalMatrix,
    ) {
        let gradient = self.force_gradient(touch, force, w);
        let turning = w.q * force.value / g.eccentricity;
        let columns = self.columns();
        for r in 0..columns {
            for c in 0..columns {
                k[r][c] +=
                    touch.normal[r] * gradient[c] + turning * touch.tangent[r] * touch.tangent[c];
            }
        }
        for (c, bend) in touch.bends.iter().flatten() {
            k[*c][*c] += w.q * force.value * dot(touch.n, *bend);
        }
    }

    /// Adds the local force to `f`; returns the normal force where the surfaces touch.
    #[inline]
    pub fn force(
        &self,
        q: &[f64],
        v: &[f64],
        impact_velocity: f64,
        f: &mut [f64; WIDTH],
    ) -> Option<NormalForce> {
        let g = self.geometry(q, v);
        let force = self.normal_force(&g, impact_velocity)?;
        let push = scale(force.value / g.eccentricity, g.e);
        let mut column = 0;
        for (marker, sign, arm) in [
            (&self.bearing, -1.0, g.arms[0]),
            (&self.journal, 1.0, g.arms[1]),
        ] {
            for i in 0..2 {
                f[column + i] += sign * push[i];
            }
            if let Marker::OnBody { .. } = marker {
                f[column + 2] += sign * cross(arm, push);
            }
            column += marker.width();
        }
        Some(force)
    }

    /// Adds the local force to `f` and the tangent to `k`; returns the normal force where the surfaces touch.
    #[inline]
    pub fn force_and_tangent(
        &self,
        q: &[f64],
        v: &[f64],
        impact_velocity: f64,
        w: Weights,
        f: &mut [f64; WIDTH],
        k: &mut LocalMatrix,
    ) -> Option<NormalForce> {
        let g = self.geometry(q, v);
        let force = self.normal_force(&g, impact_velocity)?;
        let touch = self.touch(v, &g);
        self.add_force(&touch, &force, f);
        self.add_tangent(&g, &touch, &force, w, k);
        Some(force)
    }
}
