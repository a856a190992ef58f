//! Shapes of bodies, and where they are at every row.

use super::stored::StoredRun;
use looselink::body::{FlexibleLink, Known};
use looselink::interaction::Placed;
use serde::Serialize;
use std::f64::consts::TAU;

/// The shape of a body.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BodyShape {
    /// Points that do not move.
    Ground,
    /// The convex hull of its points: two corners are a bar, none a point.
    Hull(Vec<[f64; 2]>),
    /// A disc of this radius about the origin of its frame, with a mark in the direction of x.
    Disc(f64),
    /// Cubics between nodes.
    Beam {
        /// Number of elements.
        elements: usize,
        /// Undeformed length \[m\].
        length: f64,
    },
}

impl BodyShape {
    /// That of a body.
    pub fn of(placed: &Placed) -> BodyShape {
        let kind = &placed.kind;
        let points: Vec<[f64; 2]> = kind.points().iter().map(|p| p.at.into()).collect();
        match (kind.get::<FlexibleLink>(), kind.radius(), &points[..]) {
            (Some(link), ..) => BodyShape::Beam {
                elements: link.elements,
                length: link.link.length,
            },
            (_, Some(radius), _) => BodyShape::Disc(radius),
            _ if matches!(kind.known(), Some(Known::Fixed)) => BodyShape::Ground,
            (.., points) => {
                // a disc of the same mass and moment of inertia
                let radius = kind.size() * 2_f64.sqrt();
                match points {
                    [] if radius > 0.0 => BodyShape::Disc(radius),
                    // about its centre of mass, or a bar from there to its point
                    [[x, y]] if radius >= x.hypot(*y) && radius > 0.0 => BodyShape::Disc(radius),
                    [point] => BodyShape::Hull(hull(&[[0.0; 2], *point])),
                    points => BodyShape::Hull(hull(points)),
                }
            }
        }
    }

    /// The largest distance of a point of the shape from the origin of its frame \[m\].
    pub fn reach(&self) -> f64 {
        match self {
            BodyShape::Ground => 0.0,
            BodyShape::Hull(corners) => corners.iter().fold(0.0, |m, [x, y]| m.max(x.hypot(*y))),
            BodyShape::Disc(radius) => *radius,
            BodyShape::Beam { length, .. } => *length,
        }
    }
}

/// How a body moves, row by row.
#[derive(Debug)]
pub struct Moved {
    /// What it looks like.
    pub shape: BodyShape,
    /// x, y, theta, and the length of the chord of a flexible link.
    pub pose: [Vec<f64>; 4],
    /// u, w of the position and of the slope of every node.
    pub deviations: Vec<Vec<f64>>,
    /// True where theta is a coordinate, which counts full turns. That of a link is known up to full turns: it is taken to turn by
    /// less than half a turn between two rows.
    counts_turns: bool,
}

/// Calls `see` with the coordinates of every row.
pub fn every_row(run: &StoredRun, mut see: impl FnMut(&[f64])) {
    let mut q = run.simulation.state().q.clone();
    for row in &run.motion {
        run.layout.restore(row, &mut q);
        see(&q);
    }
}

/// Least x and y, greatest x and y of all bodies over all rows \[m\]; a square of a metre about what has no extent.
pub fn bounds(run: &StoredRun) -> [f64; 4] {
    let bodies = run.simulation.model().bodies();
    let shapes: Vec<BodyShape> = bodies.iter().map(|b| BodyShape::of(&b.placed)).collect();
    let (mut least, mut greatest) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    let mut see = |at: [f64; 2], radius: f64| {
        for i in 0..2 {
            least[i] = least[i].min(at[i] - radius);
            greatest[i] = greatest[i].max(at[i] + radius);
        }
    };
    every_row(run, |q| {
        for (body, shape) in bodies.iter().zip(&shapes) {
            let placed = &body.placed;
            for point in 0..placed.kind.points().len() {
                let marker = placed.marker(point);
                see(marker.position(q, marker.arm(q)).into(), 0.0);
            }
            if let BodyShape::Disc(_) | BodyShape::Hull(_) = shape
                && let Some(frame) = placed.kind.frame_at(&placed.x, q, q)
            {
                let radius = if let BodyShape::Disc(radius) = shape {
                    *radius
                } else {
                    0.0
                };
                see([frame.position[0], frame.position[1]], radius);
            }
        }
    });
    match greatest[0] - least[0] > 0.0 || greatest[1] - least[1] > 0.0 {
        true => [least[0], least[1], greatest[0], greatest[1]],
        false => {
            let centre = least.map(|x| if x.is_finite() { x } else { 0.0 });
            [
                centre[0] - 0.5,
                centre[1] - 0.5,
                centre[0] + 0.5,
                centre[1] + 0.5,
            ]
        }
    }
}

impl Moved {
    /// All bodies of a run.
    pub fn all(run: &StoredRun) -> Vec<Moved> {
        let bodies = run.simulation.model().bodies();
        let mut moved: Vec<Moved> = bodies.iter().map(|b| Moved::new(&b.placed)).collect();
        every_row(run, |q| {
            for (body, placed) in moved.iter_mut().zip(bodies) {
                body.see(&placed.placed, q);
            }
        });
        moved
    }

    fn new(placed: &Placed) -> Moved {
        let shape = BodyShape::of(placed);
        let tracks = match shape {
            BodyShape::Beam { elements, .. } => 4 * (elements + 1),
            _ => 0,
        };
        let slots = placed.kind.slots();
        Moved {
            shape,
            pose: Default::default(),
            deviations: vec![Vec::new(); tracks],
            counts_turns: placed.kind.link().is_none()
                && slots.iter().any(|slot| slot.content.angle().is_some()),
        }
    }

    /// Adds a row.
    fn see(&mut self, placed: &Placed, q: &[f64]) {
        match self.shape {
            BodyShape::Ground => {}
            BodyShape::Beam { elements, length } => self.see_beam(&placed.x, q, elements, length),
            BodyShape::Hull(_) | BodyShape::Disc(_) => {
                // the velocities of the frame are not used
                if let Some(frame) = placed.kind.frame_at(&placed.x, q, q) {
                    let [x, y, theta] = frame.position;
                    self.push([x, y, theta, 0.0]);
                }
            }
        }
    }

    fn push(&mut self, mut pose: [f64; 4]) {
        if let Some(before) = self.pose[2].last().filter(|_| !self.counts_turns) {
            pose[2] += TAU * ((before - pose[2]) / TAU).round();
        }
        for (track, value) in self.pose.iter_mut().zip(pose) {
            track.push(value);
        }
    }

    fn see_beam(&mut self, x: &[usize], q: &[f64], elements: usize, length: f64) {
        let at = |slot: usize| [q[x[slot]], q[x[slot] + 1]];
        let (start, end) = (at(0), at(2 * elements));
        let [dx, dy] = [end[0] - start[0], end[1] - start[1]];
        let chord = dx.hypot(dy);
        self.push([start[0], start[1], dy.atan2(dx), chord]);
        // in the frame of the chord
        let [c, s] = [dx / chord, dy / chord];
        let turned = |[x, y]: [f64; 2]| [c * x + s * y, c * y - s * x];
        for node in 0..=elements {
            let [px, py] = at(2 * node);
            let [along, across] = turned([px - start[0], py - start[1]]);
            let [slope_x, slope_y] = turned(at(2 * node + 1));
            let straight = chord * node as f64 / elements as f64;
            let deviations = [along - straight, across, slope_x - chord / length, slope_y];
            for (track, value) in self.deviations[4 * node..].iter_mut().zip(deviations) {
                track.push(value);
            }
        }
    }
}

/// The convex hull of some points, counter-clockwise (Andrew's monotone chain); of points on a line the two ends.
fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let half = |points: &mut dyn Iterator<Item = &[f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                let turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                if turn > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut sorted.iter());
    [lower, half(&mut sorted.iter().rev())].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_leaves_out_what_lies_inside() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
        let mut points = corners.to_vec();
        points.extend([[1.0, 0.5], [1.0, 0.0], [2.0, 1.0]]);
        assert_eq!(hull(&points), corners);
        assert_eq!(hull(&[[1.0, 0.0], [0.0, 0.0], [0.5, 0.0]]).len(), 2);
        assert_eq!(hull(&[[1.0, 0.0]]), [[1.0, 0.0]]);
    }
}
