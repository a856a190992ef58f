//! A path whose coordinates are functions of time each.

use super::{Function, Motion, POSES, Path};

/// x(t), y(t) \[m\], theta(t) \[rad\].
impl Path for [Function; 3] {
    fn at(&self, t: f64) -> Motion {
        let values = self.each_ref().map(|f| f.at(t));
        Motion {
            position: values.map(|v| v[0]),
            velocity: values.map(|v| v[1]),
            acceleration: values.map(|v| v[2]),
        }
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        (duration, POSES)
    }
}
