//! A rigid link in x, y of its centre of mass and theta. Where no other body shares its ends, these are fewer unknowns than in
//! natural coordinates, and the link needs no constraint.

use super::rigid_link::frame;
use super::{Body, Frame, Levels, Link, Point, Pose, carried, pose};
use crate::marker::Marker;
use crate::math::plane::{Vec2, full_turns};
use crate::terms::{Inertia, Owner, Terms};

/// A link that does not deform, in coordinates that no other body shares.
#[derive(Debug, Clone)]
pub struct CentredLink {
    /// Dimensions and points.
    pub link: Link,
}

impl Body for CentredLink {
    fn points(&self) -> &[Point] {
        &self.link.points
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
        let along = self.link.shares[point] - 0.5;
        let s = Vec2::new(along * self.link.length, 0.0);
        Marker::OnBody { pose: pose(x), s }
    }

    fn lever(&self, _: usize) -> f64 {
        0.5 * self.link.length
    }

    fn terms(&self, x: &[usize], _: Owner, terms: &mut Terms) {
        let mass = self.link.mass();
        let inertia = mass * self.link.length.powi(2) / 12.0;
        let inertia = Inertia::of_pose(pose(x), mass, inertia, terms.gravity);
        terms.inertia.push(inertia);
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        let mut pose = Pose::of(pose(x), levels);
        let theta = &mut pose.position[2];
        *theta -= full_turns(*theta);
        pose
    }

    fn frame(&self, position: [f64; 3], velocity: [f64; 3]) -> Frame {
        frame(self.link.length, position, velocity)
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        let [mut position, mut velocity] = carried(frame, 0.5 * self.link.length);
        position[2] = frame.position[2];
        velocity[2] = frame.velocity[2];
        vec![[position, velocity]]
    }
}
