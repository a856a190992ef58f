//! `type = "moving"`: a body without mass that follows a path.

use super::rigid_body::pose;
use super::{Body, BodyKind, Content, Frame, Known, Levels, Point, Pose, Slot, points};
use crate::document::{Key, Takes};
use crate::marker::{Marker, Spin};
use crate::motion::{Path, read_path};
use crate::terms::{Owner, Terms};
use std::sync::Arc;

pub(super) static KIND: BodyKind = BodyKind {
    name: "moving",
    keys: &[
        Key::new(
            "path",
            Takes::Path,
            "the path of its reference point and its angle, see [Paths](#paths)",
        ),
        Key::new(
            "points",
            Takes::Table,
            "named points relative to the reference point at theta = 0 [m]",
        )
        .or("none"),
    ],
    read: |table, known| {
        let path = read_path(&table.field("path")?, known.duration)?;
        let points = points::read(table)?;
        Ok(Arc::new(Moving { path, points }))
    },
};

/// A body without mass of its own that follows a path: x, y of its reference point and theta are known.
#[derive(Debug, Clone)]
pub struct Moving {
    /// Path of its reference point and its angle.
    pub path: Arc<dyn Path>,
    /// Named points relative to the reference point at theta = 0 \[m\].
    pub points: Vec<Point>,
}

impl Body for Moving {
    fn points(&self) -> &[Point] {
        &self.points
    }

    fn slots(&self) -> Vec<Slot> {
        vec![Slot::own(String::new(), Content::Pose)]
    }

    fn known(&self) -> Option<Known<'_>> {
        Some(Known::Path(&self.path))
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        let s = self.points[point].at;
        Marker::OnBody { x: x[0], s }
    }

    fn spin(&self, _: usize, x: &[usize]) -> Spin {
        Spin::Angle { theta: x[0] + 2 }
    }

    fn terms(&self, _: &[usize], _: Owner, _: &mut Terms) {}

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        pose(x[0], levels)
    }

    fn frame_at(&self, x: &[usize], q: &[f64], v: &[f64]) -> Option<Frame> {
        let Pose {
            position, velocity, ..
        } = pose(x[0], [q, v, v]);
        Some(Frame { position, velocity })
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        vec![[frame.position, frame.velocity]]
    }

    fn velocity(&self, component: usize, x: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        Some(vec![(x[0] + component, 1.0)])
    }
}
