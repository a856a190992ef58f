//! A spring and a damper between two points.

use super::{Ends, ForceKind, ForceModel};
use crate::body::PointRef;
use crate::document::{Fields, Key, SceneError};
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::marker::{Marker, Separation};
use crate::math::plane::Vec2;
use crate::system::{State, Weights};
use std::sync::Arc;

pub(super) static KIND: ForceKind = ForceKind {
    name: "spring_damper",
    keys: &[
        Key::point("from", "one end"),
        Key::point("to", "the other end"),
        Key::non_negative("stiffness", "N/m", "the stiffness k, 0 for a damper"),
        Key::non_negative("damping", "N s/m", "the damping c, 0 for a spring"),
        Key::non_negative("rest_length", "m", "the length L_0 without force"),
    ],
    read: |table, names| {
        let [from, to] = names.two_points(table)?;
        let (stiffness, damping) = rates(table)?;
        Ok(Arc::new(SpringDamperModel {
            from,
            to,
            stiffness,
            damping,
            rest_length: table.number("rest_length")?,
        }))
    },
};

/// Stiffness and damping, one of them at least.
pub(super) fn rates(table: &Fields) -> Result<(f64, f64), SceneError> {
    let (stiffness, damping) = (table.number("stiffness")?, table.number("damping")?);
    if stiffness == 0.0 && damping == 0.0 {
        let message = format!("`{}` has neither stiffness nor damping", table.path());
        return Err(table.fault(message, "does nothing"));
    }
    Ok((stiffness, damping))
}

/// Pull N = k (L - L_0) + c L_dot along the line between two points, L their distance; its ends are points of a scene or
/// markers.
///
/// With a rest length of 0 the pull vanishes where the points meet, and the damper has no direction there and no force.
/// With any other rest length points that meet leave the spring without a direction: the state is not finite.
#[derive(Debug, Clone, Copy)]
pub struct SpringDamper<P = Marker> {
    /// One end.
    pub from: P,
    /// The other.
    pub to: P,
    /// k \[N/m\].
    pub stiffness: f64,
    /// c \[N s/m\].
    pub damping: f64,
    /// L_0 \[m\].
    pub rest_length: f64,
}

/// A spring and a damper as a scene describes them.
pub type SpringDamperModel = SpringDamper<PointRef>;

impl SpringDamperModel {
    /// The same between markers, and the bodies of its two sides.
    pub(super) fn place(&self, ends: &Ends) -> (SpringDamper, [usize; 2]) {
        let placed = SpringDamper {
            from: ends.marker(self.from),
            to: ends.marker(self.to),
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: self.rest_length,
        };
        (placed, [self.from.body, self.to.body])
    }
}

impl ForceModel for SpringDamperModel {
    fn points(&self) -> Vec<PointRef> {
        vec![self.from, self.to]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let (term, bodies) = self.place(ends);
        (Box::new(term), bodies)
    }
}

/// Ends at a smaller distance than this part of the rest length coincide: the digits of typed positions.
const MEETING: f64 = 1e-9;

/// The line between the ends.
pub(super) struct LineOfAction {
    pub length: f64,
    /// Unit vector from one end to the other.
    n: Vec2,
    rate: f64,
    /// 1/L, or 0 where the points of a spring without rest length meet.
    inverse: f64,
    e_dot: Vec2,
    /// n^T d(e)/dq
    pub along: [f64; WIDTH],
}

impl SpringDamper {
    pub(super) fn ends(&self) -> Separation {
        Separation {
            from: self.from,
            to: self.to,
        }
    }

    pub(super) fn line(&self, at: &State) -> LineOfAction {
        let ends = self.ends();
        let arms = ends.arms(&at.q);
        let (e, e_dot) = (ends.vector(&at.q, arms), ends.rate(&at.v, arms));
        let length = e.norm();
        let meeting = length == 0.0 && self.rest_length == 0.0;
        let inverse = if meeting { 0.0 } else { 1.0 / length };
        let n = inverse * e;
        let mut along = [0.0; WIDTH];
        for (along, column) in along.iter_mut().zip(ends.columns(arms).iter()) {
            *along = n.dot(column);
        }
        LineOfAction {
            length,
            n,
            rate: n.dot(&e_dot),
            inverse,
            e_dot,
            along,
        }
    }

    pub(super) fn pull(&self, line: &LineOfAction) -> f64 {
        self.stiffness * (line.length - self.rest_length) + self.damping * line.rate
    }

    /// Adds the local force of a pull.
    pub(super) fn pull_ends(line: &LineOfAction, pull: f64, f: &mut [f64; WIDTH]) {
        for (f, along) in f.iter_mut().zip(line.along) {
            *f += pull * along;
        }
    }

    /// Adds the tangent.
    pub(super) fn tangent(&self, at: &State, w: Weights, line: &LineOfAction, k: &mut LocalMatrix) {
        let (ends, pull) = (self.ends(), self.pull(line));
        // N/L, whose limit for a spring without rest length is k
        let turning = if line.inverse == 0.0 {
            self.stiffness
        } else {
            pull * line.inverse
        };
        // d(L_dot)/dq: n turns with e, and e_dot with the arms
        let arms = ends.arms(&at.q);
        let columns = ends.columns(arms);
        let mut rate_q = [0.0; WIDTH];
        for (c, column) in columns.iter().enumerate() {
            let across = column - line.along[c] * line.n;
            rate_q[c] = line.e_dot.dot(&across) * line.inverse;
        }
        for (theta, x, bend) in ends.bends(arms) {
            rate_q[theta] += at.v[x] * line.n.dot(&bend);
            k[theta][theta] += w.q * pull * line.n.dot(&bend);
        }
        let by_length = w.q * self.stiffness + w.v * self.damping;
        for (r, row) in columns.iter().enumerate() {
            for (c, column) in columns.iter().enumerate() {
                let gradient = by_length * line.along[c] + w.q * self.damping * rate_q[c];
                let across = row.dot(column) - line.along[r] * line.along[c];
                k[r][c] += line.along[r] * gradient + w.q * turning * across;
            }
        }
    }
}

impl Force for SpringDamper {
    fn effect(&self) -> Effect {
        "spring_damper"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        self.ends().sides()
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let line = self.line(at);
        Self::pull_ends(&line, self.pull(&line), f);
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let line = self.line(at);
        Self::pull_ends(&line, self.pull(&line), f);
        self.tangent(at, w, &line, k);
    }

    fn stores_energy(&self) -> bool {
        true
    }

    fn fault(&self, at: &State) -> Option<&'static str> {
        let length = self.line(at).length;
        let undefined = self.rest_length != 0.0
            && (length.is_nan() || length <= MEETING * self.rest_length.abs());
        undefined.then_some("a spring with a rest length has no direction where its ends coincide")
    }

    fn energy(&self, at: &State) -> f64 {
        let stretch = self.line(at).length - self.rest_length;
        0.5 * self.stiffness * stretch * stretch
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::DAMPING]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let rate = self.line(at).rate;
        powers.add(0, self.damping * rate * rate);
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("force", "N"), ("length", "m"), ("rate", "m/s")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let line = self.line(at);
        // ends that meet part at the magnitude of their relative velocity, in whatever direction
        let rate = match line.length {
            0.0 => line.e_dot.norm(),
            _ => line.rate,
        };
        [self.pull(&line), line.length, rate]
    }
}
