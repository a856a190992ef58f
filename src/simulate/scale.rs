//! The size of a mechanism.

use crate::model::Model;
use crate::scene::Scene;
use crate::system::State;

/// The largest of the extents of its points and the sizes of its bodies \[m\].
pub(super) fn size(scene: &Scene, model: &Model, at: &State) -> f64 {
    let lengths = model.lengths();
    let places = at.q.iter().enumerate();
    let places = places.filter(|(i, _)| lengths.get(*i).is_none_or(|length| *length == 1.0));
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    for (_, q) in places {
        (least, greatest) = (least.min(*q), greatest.max(*q));
    }
    // a body that swings about a point
    let levers = model.angles.iter().map(|angle| lengths[*angle]);
    let bodies = scene.bodies.iter().map(|body| body.kind.size());
    levers
        .chain(bodies)
        .fold((greatest - least).max(0.0), f64::max)
}
