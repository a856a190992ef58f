//! The size of a mechanism.

use crate::model::Model;
use crate::newton::Extent;
use crate::scene::Scene;
use crate::system::State;

/// The largest of the extents of its points in x and y, those included at which joints and forces hold it, and the sizes of its bodies
/// \[m\]; 1 m of a point alone.
pub(super) fn size(scene: &Scene, model: &Model, at: &State) -> f64 {
    let bodies = model.bodies().iter().enumerate();
    let moving = bodies.filter(|(_, body)| body.moves);
    let own = moving.flat_map(|(b, body)| {
        let centre = model.pose(b, at).position;
        let points = (0..body.points.len()).map(move |point| model.point(b, point, at)[0].into());
        std::iter::once([centre[0], centre[1]]).chain(points)
    });
    let held = scene.joints.iter().flat_map(|joint| joint.points());
    let held = held.chain(scene.forces.iter().flat_map(|force| force.kind.points()));
    let resting = held.filter(|point| !model.bodies()[point.body].moves);
    let resting = resting.map(|point| {
        scene.bodies[point.body].kind.points()[point.point]
            .at
            .into()
    });
    let places = own.chain(resting);
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
    match extents.chain(levers).chain(sizes).fold(0.0, f64::max) {
        0.0 => 1.0,
        size => size,
    }
}

/// What displacements are measured by; `lengths` are those of the model.
pub(super) fn extent<'a>(
    scene: &Scene,
    model: &Model,
    at: &State,
    lengths: &'a [f64],
) -> Extent<'a> {
    Extent {
        lengths,
        size: size(scene, model, at),
    }
}
