//! A spring and a damper between two points.

use super::{Ends, ForceKind, ForceModel};
use crate::body::PointRef;
use crate::document::{Fields, Key, SceneError};
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::marker::Marker;
use crate::math::plane::{Vec2, dot, norm, scale, sub};
use crate::system::{INTEGRALS, Integral, State, Weights};
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

/// A spring and a damper as a scene describes them.
#[derive(Debug, Clone, Copy)]
pub struct SpringDamperModel {
    /// One end.
    pub from: PointRef,
    /// The other.
    pub to: PointRef,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
    /// Rest length \[m\].
    pub rest_length: f64,
}

impl ForceModel for SpringDamperModel {
    fn points(&self) -> Vec<PointRef> {
        vec![self.from, self.to]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = SpringDamper {
            from: ends.marker(self.from),
            to: ends.marker(self.to),
            stiffness: self.stiffness,
            damping: self.damping,
            rest_length: self.rest_length,
        };
        (Box::new(term), [self.from.body, self.to.body])
    }
}

/// Pull N = k (L - L_0) + c L_dot along the line between two points, L their distance.
///
/// With a rest length of 0 the pull vanishes where the points meet, and the damper has no direction there and no force.
/// With any other rest length points that meet leave the spring without a direction: the state is not finite.
#[derive(Debug, Clone, Copy)]
pub struct SpringDamper {
    /// One end.
    pub from: Marker,
    /// The other.
    pub to: Marker,
    /// k \[N/m\].
    pub stiffness: f64,
    /// c \[N s/m\].
    pub damping: f64,
    /// L_0 \[m\].
    pub rest_length: f64,
}

/// Ends at a smaller distance coincide \[m\]: the digits of typed positions.
const MEETING: f64 = 1e-9;

/// The line between the ends.
pub(super) struct Line {
    length: f64,
    /// Unit vector from one end to the other.
    n: Vec2,
    rate: f64,
    /// 1/L, or 0 where the points of a spring without rest length meet.
    inverse: f64,
    e_dot: Vec2,
    /// n^T d(e)/dq
    pub along: [f64; WIDTH],
    columns: [Vec2; WIDTH],
    count: usize,
}

impl SpringDamper {
    pub(super) fn line(&self, at: &State) -> Line {
        let arms = [self.from.arm(&at.q), self.to.arm(&at.q)];
        let e = sub(
            self.to.position(&at.q, arms[1]),
            self.from.position(&at.q, arms[0]),
        );
        let e_dot = sub(
            self.to.velocity(&at.v, arms[1]),
            self.from.velocity(&at.v, arms[0]),
        );
        let length = norm(e);
        let meeting = length == 0.0 && self.rest_length == 0.0;
        let n = if meeting {
            [0.0; 2]
        } else {
            scale(1.0 / length, e)
        };
        let mut line = Line {
            length,
            n,
            rate: dot(n, e_dot),
            inverse: if meeting { 0.0 } else { 1.0 / length },
            e_dot,
            along: [0.0; WIDTH],
            columns: [[0.0; 2]; WIDTH],
            count: 0,
        };
        for (marker, sign) in [(&self.from, -1.0), (&self.to, 1.0)] {
            for column in marker.columns(marker.arm(&at.q)).iter() {
                line.columns[line.count] = scale(sign, *column);
                line.along[line.count] = sign * dot(n, *column);
                line.count += 1;
            }
        }
        line
    }

    fn pull(&self, line: &Line) -> f64 {
        self.stiffness * (line.length - self.rest_length) + self.damping * line.rate
    }
}

impl Force for SpringDamper {
    fn effect(&self) -> Effect {
        "spring_damper"
    }

    fn coordinates(&self) -> Vec<usize> {
        [self.from.coordinates(), self.to.coordinates()].concat()
    }

    fn split(&self) -> usize {
        self.from.width()
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let line = self.line(at);
        let pull = self.pull(&line);
        for (f, along) in f.iter_mut().zip(line.along) {
            *f += pull * along;
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let line = self.line(at);
        let pull = self.pull(&line);
        // N/L, whose limit for a spring without rest length is k
        let turning = if line.inverse == 0.0 {
            self.stiffness
        } else {
            pull * line.inverse
        };
        // d(L_dot)/dq: n turns with e, and e_dot with the arms
        let arms = [self.from.arm(&at.q), self.to.arm(&at.q)];
        let mut rate_q = [0.0; WIDTH];
        for c in 0..line.count {
            let across = sub(line.columns[c], scale(line.along[c], line.n));
            rate_q[c] = dot(line.e_dot, across) * line.inverse;
        }
        let sides = [(&self.from, -1.0, 0), (&self.to, 1.0, self.from.width())];
        for (side, (marker, sign, first)) in sides.into_iter().enumerate() {
            if let Marker::OnBody { x, .. } = *marker {
                let bend = scale(-sign, arms[side]);
                rate_q[first + 2] += at.v[x + 2] * dot(line.n, bend);
                k[first + 2][first + 2] += w.q * pull * dot(line.n, bend);
            }
        }
        for r in 0..line.count {
            f[r] += pull * line.along[r];
            for c in 0..line.count {
                let by_length = w.q * self.stiffness + w.v * self.damping;
                let gradient = by_length * line.along[c] + w.q * self.damping * rate_q[c];
                let across = dot(line.columns[r], line.columns[c]) - line.along[r] * line.along[c];
                k[r][c] += line.along[r] * gradient + w.q * turning * across;
            }
        }
    }

    fn stores_energy(&self) -> bool {
        true
    }

    fn fault(&self, at: &State) -> Option<&'static str> {
        let length = self.line(at).length;
        let undefined = self.rest_length != 0.0 && (length.is_nan() || length <= MEETING);
        undefined.then_some("a spring with a rest length has no direction where its ends coincide")
    }

    fn energy(&self, at: &State) -> f64 {
        let stretch = self.line(at).length - self.rest_length;
        0.5 * self.stiffness * stretch * stretch
    }

    fn powers(&self, at: &State, powers: &mut [f64; INTEGRALS]) {
        let rate = self.line(at).rate;
        powers[Integral::DampingDissipated as usize] += self.damping * rate * rate;
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("force", "N"), ("length", "m"), ("rate", "m/s")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let line = self.line(at);
        // ends that meet part at the magnitude of their relative velocity, in whatever direction
        let rate = match line.length {
            0.0 => norm(line.e_dot),
            _ => line.rate,
        };
        [self.pull(&line), line.length, rate]
    }
}
