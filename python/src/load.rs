//! A load on a point as a Python callable of the motion of the point: F(t, x, y, vx, vy).

use super::callable::{Given, NUMBER, call, finite, given, wrong_result};
use looselink::body::PointRef;
use looselink::document::Key;
use looselink::effect::Effect;
use looselink::force::{Force, LocalMatrix, WIDTH};
use looselink::interaction::{Ends, ForceKind, ForceModel};
use looselink::marker::Marker;
use looselink::math::plane::Vec2;
use looselink::system::{INTEGRALS, Integral, State, Weights};
use pyo3::prelude::*;
use std::sync::Arc;

/// Smallest scale of a difference \[m, m/s\]: loads change over shorter ways than the distance of a point from the origin.
const SCALE: f64 = 1e-2;

pub static LOAD: ForceKind = ForceKind {
    name: "callable",
    keys: &[Key::point("point", "where it acts"), NUMBER],
    read: |table, names| {
        let point = names.point(&table.field("point")?)?;
        let load = CallableLoad {
            path: table.path().to_owned(),
            given: given(table)?,
        };
        Ok(Arc::new(CallableLoadModel {
            point,
            load: Arc::new(load),
        }))
    },
};

/// F and its derivatives as functions of t and (x, y, vx, vy).
#[derive(Debug)]
struct CallableLoad {
    path: String,
    given: Arc<Given>,
}

/// dF/d(x, y, vx, vy), a row for each component of F.
type LoadGradient = [[f64; 4]; 2];

impl CallableLoad {
    /// F \[N\].
    fn force(&self, t: f64, [x, y, vx, vy]: [f64; 4]) -> Option<[f64; 2]> {
        call(|py| {
            let result = self.given.function.bind(py).call1((t, x, y, vx, vy))?;
            let force = result.extract();
            let force: [f64; 2] =
                force.map_err(|_| wrong_result(&self.path, "(fx, fy)", &result))?;
            finite(&self.path, t, &force)?;
            Ok(force)
        })
    }

    /// The derivatives: those of `tangent`, or forward differences with the step h = sqrt(eps) max(|x|, 0.01), at which truncation
    /// (h/2 times the second derivative) and rounding (eps |F|/h) are about equal. Newton's method needs the derivatives only to
    /// converge: an error of 1e-8 costs no iteration, and the solution does not depend on it.
    fn gradient(&self, t: f64, at: [f64; 4], force: [f64; 2]) -> Option<LoadGradient> {
        if let Some(tangent) = &self.given.tangent {
            let [x, y, vx, vy] = at;
            return call(|py| {
                let result = tangent.bind(py).call1((t, x, y, vx, vy))?;
                let wanted = "two rows of the derivatives by x, y, vx, vy as its tangent";
                let gradient = result.extract();
                let gradient: LoadGradient =
                    gradient.map_err(|_| wrong_result(&self.path, wanted, &result))?;
                finite(&self.path, t, gradient.as_flattened())?;
                Ok(gradient)
            });
        }
        let mut gradient = [[0.0; 4]; 2];
        for i in 0..4 {
            let mut moved = at;
            moved[i] += f64::EPSILON.sqrt() * at[i].abs().max(SCALE);
            let changed = self.force(t, moved)?;
            for (row, (changed, force)) in gradient.iter_mut().zip(changed.iter().zip(force)) {
                row[i] = (changed - force) / (moved[i] - at[i]);
            }
        }
        Some(gradient)
    }
}

#[derive(Debug)]
struct CallableLoadModel {
    point: PointRef,
    load: Arc<CallableLoad>,
}

impl ForceModel for CallableLoadModel {
    fn points(&self) -> Vec<PointRef> {
        vec![self.point]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = CallableForce {
            marker: ends.marker(self.point),
            load: self.load.clone(),
        };
        (Box::new(term), [self.point.body; 2])
    }
}

/// The load on a point r(q): f = -(dr/dq)^T F(t, r, dr/dt) on the left side of the equations of motion.
#[derive(Debug)]
struct CallableForce {
    marker: Marker,
    load: Arc<CallableLoad>,
}

impl CallableForce {
    /// (x, y, vx, vy) of the point.
    fn motion(&self, at: &State) -> [f64; 4] {
        let arm = self.marker.arm(&at.q);
        let (r, v) = (
            self.marker.position(&at.q, arm),
            self.marker.velocity(&at.v, arm),
        );
        [r.x, r.y, v.x, v.y]
    }

    fn value(&self, at: &State) -> Vec2 {
        let force = self.load.force(at.t, self.motion(at));
        force.unwrap_or([f64::NAN; 2]).into()
    }
}

impl Force for CallableForce {
    fn effect(&self) -> Effect {
        "callable_load"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [vec![], self.marker.coordinates()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let value = self.value(at);
        let columns = self.marker.columns(self.marker.arm(&at.q));
        for (f, column) in f.iter_mut().zip(columns.iter()) {
            *f -= value.dot(column);
        }
    }

    /// With J = dr/dq: -J^T (F_r J + F_v d(dr/dt)/dq) w.q - J^T F_v J w.v, and of a point of a rigid body, whose arm s turns by
    /// theta, also -F . d2r/dtheta2 = F . s, and d(dr/dt)/dtheta = -omega s.
    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let motion = self.motion(at);
        let found = self.load.force(at.t, motion).and_then(|force| {
            let gradient = self.load.gradient(at.t, motion, force)?;
            Some((force, gradient))
        });
        let (force, gradient) = found.unwrap_or(([f64::NAN; 2], [[f64::NAN; 4]; 2]));
        let force = Vec2::from(force);
        let arm = self.marker.arm(&at.q);
        let columns = self.marker.columns(arm);
        let by = |moved: &Vec2, first: usize| {
            Vec2::from(gradient.map(|row| row[first] * moved.x + row[first + 1] * moved.y))
        };
        let by_position = |moved: &Vec2| by(moved, 0);
        let by_velocity = |moved: &Vec2| by(moved, 2);
        let mut changes = [Vec2::zeros(); WIDTH];
        for (change, column) in changes.iter_mut().zip(columns.iter()) {
            *change = w.q * by_position(column) + w.v * by_velocity(column);
        }
        if let Marker::OnBody { x, .. } = self.marker {
            changes[2] -= w.q * at.v[x + 2] * by_velocity(&arm);
            k[2][2] += w.q * force.dot(&arm);
        }
        for (r, row) in columns.iter().enumerate() {
            f[r] -= force.dot(row);
            for c in 0..columns.len() {
                k[r][c] -= row.dot(&changes[c]);
            }
        }
    }

    fn powers(&self, at: &State, powers: &mut [f64; INTEGRALS]) {
        let velocity = self.marker.velocity(&at.v, self.marker.arm(&at.q));
        powers[Integral::Work as usize] += self.value(at).dot(&velocity);
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("fx", "N"), ("fy", "N")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let value = self.value(at);
        [value.x, value.y, 0.0]
    }
}
