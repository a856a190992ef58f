//! `type = "point_mass"`: x, y.

use super::{Body, BodyKind, Levels, Point, Pose, Slot};
use crate::document::Key;
use crate::marker::{Marker, Spin};
use crate::math::plane::Vec2;
use crate::terms::{Inertia, Owner, Terms};
use std::sync::Arc;

pub(super) static KIND: BodyKind = BodyKind {
    name: "point_mass",
    keys: &[Key::positive("mass", "kg", "the mass")],
    read: |table, _| Ok(Arc::new(PointMass::new(table.number("mass")?))),
};

/// A point with mass; its only point is `center`.
#[derive(Debug, Clone)]
pub struct PointMass {
    /// Mass \[kg\].
    pub mass: f64,
    center: [Point; 1],
}

impl PointMass {
    fn new(mass: f64) -> PointMass {
        let center = [Point::new("center", Vec2::zeros())];
        PointMass { mass, center }
    }
}

impl Body for PointMass {
    fn points(&self) -> &[Point] {
        &self.center
    }

    fn slots(&self) -> Vec<Slot> {
        vec![Slot::node("center", 0)]
    }

    fn mass(&self) -> Option<f64> {
        Some(self.mass)
    }

    fn turns(&self) -> bool {
        false
    }

    fn marker(&self, _: usize, x: &[usize]) -> Marker {
        Marker::Node { x: x[0] }
    }

    fn spin(&self, _: usize, _: &[usize]) -> Spin {
        Spin::Fixed
    }

    fn terms(&self, x: &[usize], _: Owner, terms: &mut Terms) {
        let inertia = Inertia::planar([[self.mass]], [x[0]], [true], terms.gravity);
        terms.inertia.push(inertia);
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        let x = x[0];
        let [position, velocity, acceleration] = levels.map(|l| [l[x], l[x + 1], 0.0]);
        Pose {
            position,
            velocity,
            acceleration,
        }
    }

    fn velocity(&self, component: usize, x: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        (component < 2).then(|| vec![(x[0] + component, 1.0)])
    }
}
