//! A rigid link in natural coordinates (eqs. 1-5): the positions of its two ends, at a constant distance.

use super::{Body, CentredLink, Frame, HeldBody, Levels, Link, Point, Pose, Slot, Ties, carried};
use crate::constraint::Length;
use crate::link::natural_rigid;
use crate::marker::{Marker, Spin};
use crate::math::plane::{Vec2, pair, quarter_turn, unit};
use crate::terms::{ConstraintTerm, Inertia, Owner, Terms};
use std::sync::Arc;

/// A link that does not deform.
#[derive(Debug, Clone)]
pub struct RigidLink {
    /// Dimensions and points.
    pub link: Link,
    /// The coordinates that the scene asks for.
    pub coordinates: Option<LinkCoordinates>,
}

/// What the unknowns of a rigid link are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkCoordinates {
    /// The positions of its ends.
    Natural,
    /// x, y of its centre of mass and theta.
    Centre,
}

impl Body for RigidLink {
    fn points(&self) -> &[Point] {
        &self.link.points
    }

    fn slots(&self) -> Vec<Slot> {
        vec![Slot::node("start", 0), Slot::node("end", 1)]
    }

    fn mass(&self) -> Option<f64> {
        Some(self.link.mass())
    }

    fn link(&self) -> Option<&Link> {
        Some(&self.link)
    }

    fn size(&self) -> f64 {
        self.link.length
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        match point {
            0 | 1 => Marker::Node { x: x[point] },
            inner => Marker::OnChord {
                from: x[0],
                to: x[1],
                share: self.link.shares[inner],
            },
        }
    }

    fn spin(&self, _: usize, x: &[usize]) -> Spin {
        Spin::Chord {
            from: x[0],
            to: x[1],
        }
    }

    fn direction_size(&self) -> f64 {
        self.link.length
    }

    fn carrier(&self, point: usize) -> usize {
        point
    }

    fn terms(&self, x: &[usize], owner: Owner, terms: &mut Terms) {
        let [i, j] = [x[0], x[1]];
        let mass = natural_rigid::mass(self.link.mass());
        let inertia = Inertia::planar(mass, [i, j], [true; 2], terms.gravity);
        terms.inertia.push(inertia);
        let length = Length {
            i,
            j,
            length: self.link.length,
        };
        let name = &format!("length of {}", owner.name);
        let term = ConstraintTerm::Length(length);
        terms.constrain(term, Owner { name, ..owner }, &[""]);
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        let [i, j] = [x[0], x[1]];
        pose(
            levels.map(|l| 0.5 * (pair(l, i) + pair(l, j))),
            levels.map(|l| pair(l, j) - pair(l, i)),
        )
    }

    fn frame(&self, position: [f64; 3], velocity: [f64; 3]) -> Frame {
        frame(self.link.length, position, velocity)
    }

    fn frame_at(&self, x: &[usize], q: &[f64], v: &[f64]) -> Option<Frame> {
        let (from, from_rate) = (pair(q, x[0]), pair(v, x[0]));
        let (d, d_dot) = (pair(q, x[1]) - from, pair(v, x[1]) - from_rate);
        let omega = d.perp(&d_dot) / d.dot(&d);
        Some(Frame {
            position: from.push(d.y.atan2(d.x)).into(),
            velocity: from_rate.push(omega).into(),
        })
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        vec![carried(frame, 0.0), carried(frame, self.link.length)]
    }

    fn real(&self, ties: &Ties) -> Option<Arc<dyn Body>> {
        let link = self.link.clone();
        match (self.coordinates, &ties.holds[..]) {
            (None, [hold]) if !ties.shares => {
                let (mass, length) = (link.mass(), link.length);
                let inertia = mass * length * length / 12.0;
                let center = Vec2::new(0.5 * length, 0.0);
                let body = Arc::new(self.clone());
                Some(Arc::new(HeldBody::new(body, mass, inertia, center, *hold)))
            }
            // with both ends known its length would be a constraint on nothing
            (None, _) if ties.anchored < 2 && (ties.shares || ties.anchored > 0) => None,
            (Some(LinkCoordinates::Natural), _) => None,
            _ => Some(Arc::new(CentredLink { link })),
        }
    }

    fn velocity(&self, component: usize, x: &[usize], q: &[f64]) -> Option<Vec<(usize, f64)>> {
        let [i, j] = [x[0], x[1]];
        if component < 2 {
            return Some(vec![(i + component, 0.5), (j + component, 0.5)]);
        }
        let d = pair(q, j) - pair(q, i);
        let b = 1.0 / d.dot(&d) * quarter_turn(d);
        Some(vec![(i, -b.x), (i + 1, -b.y), (j, b.x), (j + 1, b.y)])
    }
}

/// The frame at the start of a link, from its centre of mass.
pub(super) fn frame(length: f64, position: [f64; 3], velocity: [f64; 3]) -> Frame {
    let ([.., theta], [.., omega]) = (position, velocity);
    let half = 0.5 * length * unit(theta);
    let start = pair(&position, 0) - half;
    let rate = pair(&velocity, 0) - omega * quarter_turn(half);
    Frame {
        position: start.push(theta).into(),
        velocity: rate.push(omega).into(),
    }
}

/// Pose of a link from its centre and its chord, each as (position, velocity, acceleration).
pub(super) fn pose(centre: [Vec2; 3], chord: [Vec2; 3]) -> Pose {
    let [d, d_dot, d_ddot] = chord;
    let square = d.dot(&d);
    let omega = d.perp(&d_dot) / square;
    let alpha = (d.perp(&d_ddot) - 2.0 * omega * d.dot(&d_dot)) / square;
    Pose {
        position: centre[0].push(d.y.atan2(d.x)).into(),
        velocity: centre[1].push(omega).into(),
        acceleration: centre[2].push(alpha).into(),
    }
}
