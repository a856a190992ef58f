//! A spring and a damper between two points.

use super::{Force, LocalMatrix, WIDTH};
use crate::effect::Effect;
use crate::marker::Marker;
use crate::math::plane::{Vec2, dot, norm, scale, sub};
use crate::system::{INTEGRALS, Integral, State, Weights};

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

/// The line between the ends.
struct Line {
    length: f64,
    /// Unit vector from one end to the other.
    n: Vec2,
    rate: f64,
    /// 1/L, or 0 where the points of a spring without rest length meet.
    inverse: f64,
    e_dot: Vec2,
    /// n^T d(e)/dq
    along: [f64; WIDTH],
    columns: [Vec2; WIDTH],
    count: usize,
}

impl SpringDamper {
    fn line(&self, at: &State) -> Line {
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
        Effect::SpringDamper
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
