//! Revolute joint with clearance (eqs. 19-23): a journal that moves inside a bearing and touches it.
//!
//! e = r_j - r_i from bearing to journal, n = e/|e|, t = n turned by 90 degrees, delta = |e| - c. With delta > 0 and the
//! contact closed, the bearing pushes the journal with -F_n n. n is evaluated in a touching contact only: at the start
//! of the paper's runs e = 0 and n does not exist.

use super::{Gap, Geometry, Touch};
use crate::contact::ContactState;
use crate::force::{LocalMatrix, WIDTH};
use crate::marker::Marker;
use crate::math::plane::quarter_turn;

/// A journal in a bearing.
#[derive(Debug)]
pub struct CircleInCircle {
    /// Point i, the centre of the bearing.
    pub bearing: Marker,
    /// Point j, the centre of the journal.
    pub journal: Marker,
    /// Radius R_i \[m\].
    pub bearing_radius: f64,
    /// Radial clearance c = R_i - R_j \[m\].
    pub clearance: f64,
}

impl Geometry for CircleInCircle {
    fn coordinates(&self) -> Vec<usize> {
        [self.bearing.coordinates(), self.journal.coordinates()].concat()
    }

    #[inline]
    fn columns(&self) -> usize {
        self.bearing.width() + self.journal.width()
    }

    #[inline]
    fn gap(&self, q: &[f64], v: &[f64]) -> Gap {
        let arms = [self.bearing.arm(q), self.journal.arm(q)];
        let e = self.journal.position(q, arms[1]) - self.bearing.position(q, arms[0]);
        let e_dot = self.journal.velocity(v, arms[1]) - self.bearing.velocity(v, arms[0]);
        let eccentricity = e.norm();
        Gap {
            e,
            e_dot,
            eccentricity,
            delta: eccentricity - self.clearance,
            arms,
        }
    }

    #[inline]
    fn push(&self, _: ContactState, gap: &Gap, force: f64, f: &mut [f64; WIDTH]) {
        let push = self.along_normal(gap, force);
        let mut column = 0;
        for (marker, sign, arm) in [
            (&self.bearing, -1.0, gap.arms[0]),
            (&self.journal, 1.0, gap.arms[1]),
        ] {
            for i in 0..2 {
                f[column + i] += sign * push[i];
            }
            if let Marker::OnBody { .. } = marker {
                f[column + 2] += sign * arm.perp(&push);
            }
            column += marker.width();
        }
    }

    fn touch(&self, at: ContactState, gap: &Gap) -> Touch {
        let n = 1.0 / gap.eccentricity * gap.e;
        let t = quarter_turn(n);
        let (rate, slip) = (gap.e_dot.dot(&n), gap.e_dot.dot(&t));
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
            if let Marker::OnBody { pose, .. } = *marker {
                let arm = gap.arms[side];
                let turn = sign * quarter_turn(arm);
                touch.normal[column + 2] = n.dot(&turn);
                touch.tangent[column + 2] = t.dot(&turn);
                // e_dot depends on theta through the direction of the arm
                let bend = -sign * arm;
                touch.rate_q[column + 2] = at.v[pose[2]] * n.dot(&bend);
                touch.slip_q[column + 2] = at.v[pose[2]] * t.dot(&bend);
                touch.bends[side] = Some((column + 2, bend));
            }
            column += marker.width();
        }
        // n and t turn with e: dn = t (t . de)/|e|, dt = -n (t . de)/|e|
        for c in 0..column {
            touch.rate_q[c] += slip / gap.eccentricity * touch.tangent[c];
            touch.slip_q[c] -= rate / gap.eccentricity * touch.tangent[c];
        }
        touch
    }

    #[inline]
    fn curve(
        &self,
        _: ContactState,
        gap: &Gap,
        touch: &Touch,
        normal: f64,
        tangential: f64,
        k: &mut LocalMatrix,
    ) {
        let turning = [normal, tangential].map(|force| force / gap.eccentricity);
        let columns = self.columns();
        for r in 0..columns {
            let row = turning[0] * touch.tangent[r] - turning[1] * touch.normal[r];
            for c in 0..columns {
                k[r][c] += row * touch.tangent[c];
            }
        }
        for (c, bend) in touch.bends.iter().flatten() {
            k[*c][*c] += normal * touch.n.dot(bend) + tangential * touch.t.dot(bend);
        }
    }

    /// delta/|e|.
    #[inline]
    fn share(&self, gap: &Gap) -> [f64; 2] {
        let square = gap.eccentricity * gap.eccentricity;
        [gap.delta / gap.eccentricity, self.clearance / square]
    }

    fn radii(&self) -> [f64; 2] {
        [-self.bearing_radius, self.bearing_radius - self.clearance]
    }
}
