//! How large a mechanism is: what its tolerances are relative to.

use crate::body::PointRef;
use crate::scene::{NamedBody, Scene};
use std::collections::HashSet;

/// A constraint that follows from the others may be open by this part of the mechanism: the digits of typed lengths and positions.
pub(crate) const FITS: f64 = 1e-9;

/// The length of a mechanism: that of its longest body between joints; 1 m where no body has a length.
pub(crate) fn extent(scene: &Scene) -> f64 {
    match sizes(scene).into_iter().fold(0.0, f64::max) {
        0.0 => 1.0,
        largest => largest,
    }
}

/// Largest distance between two points of every body that joints use.
pub(super) fn sizes(scene: &Scene) -> Vec<f64> {
    let joints = scene.joints.iter().flat_map(|joint| joint.points());
    let used: HashSet<PointRef> = joints.collect();
    let size = |(b, body): (usize, &NamedBody)| {
        body.kind.length().unwrap_or_else(|| {
            let points = body.kind.points().iter().enumerate();
            let points = points.filter(|(point, _)| {
                used.contains(&PointRef {
                    body: b,
                    point: *point,
                })
            });
            let used: Vec<_> = points.map(|(_, point)| point.at).collect();
            let pairs = used
                .iter()
                .flat_map(|p| used.iter().map(move |q| (p - q).norm()));
            pairs.fold(0.0, f64::max)
        })
    };
    scene.bodies.iter().enumerate().map(size).collect()
}
