//! Full turns that a scene gives: a spring may be wound by some of them before the start.

use crate::body::Ground;
use crate::scene::Scene;

/// The angle of a revolute joint at t = 0 with its full turns \[rad\], where the scene gives it: as a drive, or as the angles of both
/// bodies, that of the ground being zero. A sketch gives no turns.
pub fn given_angle(scene: &Scene, joint: usize) -> Option<f64> {
    if let Some(angle) = scene.prescribed_angles().get(&joint) {
        return Some(angle.at(0.0)[0]);
    }
    let [first, second] = scene.joints[joint].points().map(|point| {
        let given = scene.initial.state_of(point.body);
        let ground = scene.bodies[point.body].kind.get::<Ground>().map(|_| 0.0);
        ground.or(given.map(|given| given.position[2]))
    });
    Some(second? - first?)
}
