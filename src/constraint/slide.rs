//! A point on a line: the guide of a prismatic joint, a pin in a slot.

use super::{Constraint, Curvature, Gradient, ROWS, WIDTH};
use crate::effect::Effect;
use crate::marker::{Marker, Spin};
use crate::math::plane::{Vec2, cross, dot, norm, perp, rotate, scale, sub};
use crate::system::State;

/// Phi = u x e with e = r_slider - r_guide and the unit direction u of the line, one row: the distance of the slider from
/// the line through the guide's point \[m\].
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// A point of the line.
    pub guide: Marker,
    /// The body that carries the line.
    pub spin: Spin,
    /// Direction of the line relative to that of the spin \[rad\].
    pub angle: f64,
    /// 1/|d| of the spin's undeformed direction.
    pub scale: f64,
    /// The point on the line.
    pub slider: Marker,
}

impl Slide {
    fn turned(&self, x: Vec2) -> Vec2 {
        let (sine, cosine) = self.angle.sin_cos();
        scale(self.scale, rotate(cosine, sine, x))
    }

    /// u and e.
    fn geometry(&self, at: &State) -> (Vec2, Vec2) {
        let point = |m: &Marker| m.position(&at.q, m.arm(&at.q));
        (
            self.turned(self.spin.vector(&at.q)),
            sub(point(&self.slider), point(&self.guide)),
        )
    }

    /// Local index of the first column of the spin and of the slider.
    fn firsts(&self) -> (usize, usize) {
        let spin = self.guide.width();
        (spin, spin + self.spin.width())
    }
}

impl Constraint for Slide {
    fn effect(&self) -> Effect {
        "sliding_constraint"
    }

    fn rows(&self) -> usize {
        1
    }

    fn coordinates(&self) -> Vec<usize> {
        [
            self.guide.coordinates(),
            self.spin.coordinates(),
            self.slider.coordinates(),
        ]
        .concat()
    }

    fn split(&self) -> usize {
        self.firsts().1
    }

    fn value(&self, at: &State) -> [f64; ROWS] {
        let (u, e) = self.geometry(at);
        [cross(u, e), 0.0]
    }

    fn gradient(&self, at: &State) -> Gradient {
        let (u, e) = self.geometry(at);
        let (spin, slider) = self.firsts();
        let mut gradient = [[0.0; WIDTH]; ROWS];
        let row = &mut gradient[0];
        for (c, column) in self.guide.columns(self.guide.arm(&at.q)).iter().enumerate() {
            row[c] = -cross(u, *column);
        }
        for (c, column) in self.spin.columns(&at.q).iter().enumerate() {
            row[spin + c] = cross(self.turned(*column), e);
        }
        for (c, column) in self
            .slider
            .columns(self.slider.arm(&at.q))
            .iter()
            .enumerate()
        {
            row[slider + c] = cross(u, *column);
        }
        gradient
    }

    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        let (u, e) = self.geometry(at);
        let (spin, slider) = self.firsts();
        let s = lambda[0];
        for (i, d) in self.spin.columns(&at.q).iter().enumerate() {
            let d = self.turned(*d);
            let points = [(&self.guide, -1.0, 0), (&self.slider, 1.0, slider)];
            for (marker, sign, first) in points {
                for (j, column) in marker.columns(marker.arm(&at.q)).iter().enumerate() {
                    let mixed = s * sign * cross(d, *column);
                    out.add(spin + i, first + j, mixed);
                    out.add(first + j, spin + i, mixed);
                }
            }
        }
        if let Spin::Angle { .. } = self.spin {
            out.add(spin, spin, -s * cross(u, e));
        }
        let points = [(&self.guide, -1.0, 0), (&self.slider, 1.0, slider)];
        for (marker, sign, first) in points {
            if let Marker::OnBody { .. } = marker {
                let bend = -s * sign * cross(u, marker.arm(&at.q));
                out.add(first + 2, first + 2, bend);
            }
        }
    }

    fn velocity(&self, at: &State) -> [f64; ROWS] {
        let (u, e) = self.geometry(at);
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        let u_dot = self.turned(self.spin.vector_rate(&at.q, &at.v));
        let e_dot = sub(rate(&self.slider), rate(&self.guide));
        [cross(u_dot, e) + cross(u, e_dot), 0.0]
    }

    fn acceleration(&self, at: &State) -> [f64; ROWS] {
        let (u, e) = self.geometry(at);
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        let second = |m: &Marker| m.acceleration(&at.v, &at.a, m.arm(&at.q));
        let u_dot = self.turned(self.spin.vector_rate(&at.q, &at.v));
        let u_ddot = self.turned(self.spin.vector_acceleration(&at.q, &at.v, &at.a));
        let e_dot = sub(rate(&self.slider), rate(&self.guide));
        let e_ddot = sub(second(&self.slider), second(&self.guide));
        let sum = cross(u_ddot, e) + 2.0 * cross(u_dot, e_dot) + cross(u, e_ddot);
        [sum, 0.0]
    }

    fn force(&self, at: &State, lambda: [f64; ROWS]) -> Vec2 {
        let (u, _) = self.geometry(at);
        scale(-lambda[0], perp(u))
    }
}

impl Slide {
    /// Distance along the line from the guide's point to the slider \[m\] and its rate \[m/s\].
    pub fn travel(&self, at: &State) -> [f64; 2] {
        let (u, e) = self.geometry(at);
        let rate = |m: &Marker| m.velocity(&at.v, m.arm(&at.q));
        let u_dot = self.turned(self.spin.vector_rate(&at.q, &at.v));
        let e_dot = sub(rate(&self.slider), rate(&self.guide));
        // the slope of a flexible guide is longer than 1 where the link is stretched
        let (size, along) = (norm(u), dot(u, e));
        let stretching = dot(u, u_dot) / (size * size);
        [
            along / size,
            (dot(u, e_dot) + dot(u_dot, e) - along * stretching) / size,
        ]
    }
}
