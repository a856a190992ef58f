//! A path whose coordinates are functions of time each.

use super::{Function, Knot, POSES, Path, Pose};

/// x(t), y(t) \[m\], theta(t) \[rad\].
impl Path for [Function; 3] {
    fn at(&self, t: f64) -> Pose {
        let values = self.each_ref().map(|f| f.at(t));
        Pose {
            position: values.map(|v| v[0]),
            velocity: values.map(|v| v[1]),
            acceleration: values.map(|v| v[2]),
        }
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        (duration, POSES)
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.iter().flat_map(|f| f.knots(until)).collect()
    }
}
