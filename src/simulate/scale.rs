//! The size of a mechanism.

use crate::model::Model;
use crate::scene::Scene;
use crate::system::State;

/// The largest of the extents of its points in x and y and the sizes of its bodies \[m\].
pub(super) fn size(scene: &Scene, model: &Model, at: &State) -> f64 {
    let bodies = model.bodies().iter().enumerate();
    let moving = bodies.filter(|(_, body)| body.moves);
    let places = moving.flat_map(|(b, body)| {
        let centre = model.pose(b, at).position;
        let points = (0..body.points.len()).map(move |point| model.point(b, point, at)[0].into());
        std::iter::once([centre[0], centre[1]]).chain(points)
    });
    let (mut least, mut greatest) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in places {
        for axis in 0..2 {
            least[axis] = least[axis].min(place[axis]);
            greatest[axis] = greatest[axis].max(place[axis]);
        }
    }
    let extents = (0..2).map(|axis| greatest[axis] - least[axis]);
    // a body that swings about a point
    let lengths = model.lengths();
    let levers = model.angles.iter().map(|angle| lengths[*angle]);
    let sizes = scene.bodies.iter().map(|body| body.kind.size());
    extents.chain(levers).chain(sizes).fold(0.0, f64::max)
}
