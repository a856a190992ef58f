//! Shapes of bodies, and where they are at every row.

use super::stored::StoredRun;
use looselink::body::FlexibleLink;
use looselink::interaction::Placed;
use serde::Serialize;
use std::f64::consts::TAU;

/// The shape of a body.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
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

/// How a body moves, row by row.
pub struct Moved {
    /// What it looks like.
    pub shape: Shape,
    /// x, y, theta, and the length of the chord of a flexible link.
    pub pose: [Vec<f64>; 4],
    /// u, w of the position and of the slope of every node.
    pub deviations: Vec<Vec<f64>>,
}

impl Moved {
    /// All bodies of a run, and the bounds of their points.
    pub fn all(run: &StoredRun) -> (Vec<Moved>, [f64; 4]) {
        let model = run.simulation.model();
        let mut bodies: Vec<Moved> = model
            .bodies()
            .iter()
            .map(|b| Moved::new(&b.placed))
            .collect();
        let mut bounds = [
            f64::INFINITY,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NEG_INFINITY,
        ];
        let mut q = run.simulation.state().q.clone();
        let still = vec![0.0; q.len()];
        for row in &run.motion {
            run.layout.restore(row, &mut q);
            for (body, placed) in bodies.iter_mut().zip(model.bodies()) {
                let placed = &placed.placed;
                body.see(placed, &q, &still);
                for point in 0..placed.kind.points().len() {
                    let marker = placed.marker(point);
                    let at = marker.position(&q, marker.arm(&q));
                    for (i, x) in [at.x, at.y].into_iter().enumerate() {
                        bounds[i] = bounds[i].min(x);
                        bounds[2 + i] = bounds[2 + i].max(x);
                    }
                }
            }
        }
        (bodies, bounds)
    }

    fn new(placed: &Placed) -> Moved {
        let kind = &placed.kind;
        let points: Vec<[f64; 2]> = kind.points().iter().map(|p| p.at.into()).collect();
        let beam = kind.get::<FlexibleLink>();
        let shape = match (beam, kind.radius(), &points[..]) {
            (Some(link), ..) => Shape::Beam {
                elements: link.elements,
                length: link.link.length,
            },
            (_, Some(radius), _) => Shape::Disc(radius),
            _ if kind.known().is_some() && kind.slots().len() == points.len() => Shape::Ground,
            // a disc of the same mass and moment of inertia
            (.., [] | [_]) if kind.size() > 0.0 => Shape::Disc(kind.size() * 2_f64.sqrt()),
            (.., points) => Shape::Hull(hull(points)),
        };
        Moved {
            shape,
            pose: Default::default(),
            deviations: vec![Vec::new(); beam.map_or(0, |link| 4 * (link.elements + 1))],
        }
    }

    /// Adds a row.
    fn see(&mut self, placed: &Placed, q: &[f64], still: &[f64]) {
        match self.shape {
            Shape::Ground => {}
            Shape::Beam { elements, length } => self.see_beam(&placed.x, q, elements, length),
            Shape::Hull(_) | Shape::Disc(_) => {
                if let Some(frame) = placed.kind.frame_at(&placed.x, q, still) {
                    let [x, y, theta] = frame.position;
                    self.push([x, y, theta, 0.0]);
                }
            }
        }
    }

    fn push(&mut self, mut pose: [f64; 4]) {
        if let Some(before) = self.pose[2].last() {
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
