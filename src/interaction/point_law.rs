//! A force on a point by a law F(t, r, v) of the time and of the motion of the point. Users of the library write such laws; no
//! scene can name one without a kind that reads it.

use super::{Ends, ForceModel};
use crate::body::PointRef;
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::marker::Marker;
use crate::math::plane::Vec2;
use crate::motion::Knot;
use crate::system::{State, Weights};
use nalgebra::{Matrix2, Matrix2x4};
use std::fmt::Debug;
use std::sync::Arc;

/// Smallest scale of a difference \[m, m/s\], for points near the origin and slow ones.
const SCALE: f64 = 1e-2;

/// dF/d(x, y, vx, vy), a row for each component of F \[N/m, N s/m\].
pub type LoadGradient = Matrix2x4<f64>;

/// The law of a force on a point, as a function of the time t, the position r and the velocity v of the point in the ground.
pub trait PointLaw: Debug + Send + Sync {
    /// What it is counted as.
    fn effect(&self) -> Effect;

    /// F(t, r, v) \[N\].
    fn force(&self, t: f64, r: Vec2, v: Vec2) -> Vec2;

    /// Where it is not a smooth function of time, up to a time \[s\]: steps end there.
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }

    /// dF/d(r, v), given F; without a formula by [`differences`].
    fn gradient(&self, t: f64, r: Vec2, v: Vec2, force: Vec2) -> LoadGradient {
        differences(|r, v| self.force(t, r, v), r, v, force)
    }
}

/// Forward differences of F(r, v) with the step h = sqrt(eps) max(|x|, 0.01) in every argument x. Truncation is h/2 times the second
/// derivative, rounding eps |F|/h, at most 1.5e-6 |F| per metre. Newton's method needs derivatives only to converge: the solution
/// does not depend on them.
pub fn differences(f: impl Fn(Vec2, Vec2) -> Vec2, r: Vec2, v: Vec2, force: Vec2) -> LoadGradient {
    let at = [r.x, r.y, v.x, v.y];
    LoadGradient::from_columns(&[0, 1, 2, 3].map(|i| {
        let mut moved = at;
        moved[i] += f64::EPSILON.sqrt() * at[i].abs().max(SCALE);
        let [x, y, vx, vy] = moved;
        (f(Vec2::new(x, y), Vec2::new(vx, vy)) - force) / (moved[i] - at[i])
    }))
}

/// A law that acts at a point.
#[derive(Debug)]
pub struct PointLoad {
    /// Where it acts.
    pub point: PointRef,
    /// The force on the point.
    pub law: Arc<dyn PointLaw>,
}

impl ForceModel for PointLoad {
    fn points(&self) -> Vec<PointRef> {
        vec![self.point]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = ForceByLaw {
            marker: ends.marker(self.point),
            law: self.law.clone(),
        };
        (Box::new(term), [self.point.body; 2])
    }
}

/// The force on a point r(q): f = -J^T F(t, r, dr/dt) with J = dr/dq on the left side of the equations of motion.
#[derive(Debug)]
pub struct ForceByLaw {
    /// Where it acts.
    pub marker: Marker,
    /// The force on the point.
    pub law: Arc<dyn PointLaw>,
}

impl ForceByLaw {
    /// r and dr/dt.
    fn motion(&self, at: &State) -> [Vec2; 2] {
        let arm = self.marker.arm(&at.q);
        [
            self.marker.position(&at.q, arm),
            self.marker.velocity(&at.v, arm),
        ]
    }

    fn value(&self, at: &State) -> Vec2 {
        let [r, v] = self.motion(at);
        self.law.force(at.t, r, v)
    }
}

impl Force for ForceByLaw {
    fn effect(&self) -> Effect {
        self.law.effect()
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [vec![], self.marker.coordinates()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let force = self.value(at);
        let columns = self.marker.columns(self.marker.arm(&at.q));
        for (f, column) in f.iter_mut().zip(columns.iter()) {
            *f -= force.dot(column);
        }
    }

    /// -J^T (F_r J + F_v d(dr/dt)/dq) w.q - J^T F_v J w.v, and of a point of a rigid body, whose arm s turns by theta, also
    /// -F . d2r/dtheta2 = F . s, and d(dr/dt)/dtheta = -omega s.
    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let [r, v] = self.motion(at);
        let force = self.law.force(at.t, r, v);
        let gradient = self.law.gradient(at.t, r, v, force);
        let by_position: Matrix2<f64> = gradient.fixed_columns::<2>(0).into();
        let by_velocity: Matrix2<f64> = gradient.fixed_columns::<2>(2).into();
        let arm = self.marker.arm(&at.q);
        let columns = self.marker.columns(arm);
        let by_column = w.q * by_position + w.v * by_velocity;
        let mut changes = [Vec2::zeros(); WIDTH];
        for (change, column) in changes.iter_mut().zip(columns.iter()) {
            *change = by_column * column;
        }
        if let Marker::OnBody { pose, .. } = self.marker {
            changes[2] -= w.q * at.v[pose[2]] * (by_velocity * arm);
            k[2][2] += w.q * force.dot(&arm);
        }
        for (r, row) in columns.iter().enumerate() {
            f[r] -= force.dot(row);
            for c in 0..columns.len() {
                k[r][c] -= row.dot(&changes[c]);
            }
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::WORK]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let [r, v] = self.motion(at);
        powers.add(0, self.law.force(at.t, r, v).dot(&v));
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.law.knots(until)
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("fx", "N"), ("fy", "N")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let force = self.value(at);
        [force.x, force.y, 0.0]
    }
}
