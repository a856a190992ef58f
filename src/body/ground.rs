//! `type = "ground"`: points that do not move.

use super::{Body, BodyKind, Frame, Known, Levels, Point, Pose, Slot, points};
use crate::document::{Key, Takes};
use crate::marker::{Marker, Spin};
use crate::terms::{Owner, Terms};
use std::sync::Arc;

pub(super) static KIND: BodyKind = BodyKind {
    name: "ground",
    keys: &[Key::new("points", Takes::Table, "named points [m]").or("none")],
    read: |table, _| {
        let points = points::read(table)?;
        Ok(Arc::new(Ground { points }))
    },
};

/// Points that do not move, each with two known coordinates.
#[derive(Debug, Clone)]
pub struct Ground {
    /// Named points \[m\].
    pub points: Vec<Point>,
}

impl Body for Ground {
    fn points(&self) -> &[Point] {
        &self.points
    }

    fn slots(&self) -> Vec<Slot> {
        let points = self.points.iter().enumerate();
        points.map(|(i, p)| Slot::node(&p.name, i)).collect()
    }

    fn terms(&self, _: &[usize], _: Owner, _: &mut Terms) {}

    fn known(&self) -> Option<Known<'_>> {
        Some(Known::Fixed)
    }

    fn carrier(&self, point: usize) -> usize {
        point
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        Marker::Node { x: x[point] }
    }

    fn spin(&self, _: usize, _: &[usize]) -> Spin {
        Spin::Fixed
    }

    fn pose(&self, _: &[usize], _: Levels) -> Pose {
        Pose::default()
    }

    fn frame_at(&self, _: &[usize], _: &[f64], _: &[f64]) -> Option<Frame> {
        None
    }

    fn place(&self, _: &Frame) -> Vec<[[f64; 3]; 2]> {
        let at = |p: &Point| [p.at.push(0.0).into(), [0.0; 3]];
        self.points.iter().map(at).collect()
    }

    fn velocity(&self, _: usize, _: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        None
    }
}
