//! `type = "moving"`: a body without mass that follows a path.

use super::{Body, BodyKind, Known, Point, points};
use crate::document::{Key, Takes};
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
        let path = read_path(&table.field("path")?, &known.functions)?;
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

    fn terms(&self, _: &[usize], _: Owner, _: &mut Terms) {}

    fn known(&self) -> Option<Known<'_>> {
        Some(Known::Path(&self.path))
    }
}
