//! A path whose coordinates are functions of time each.

use super::{Function, Motion, POSES, Path};

/// x(t), y(t), theta(t).
#[derive(Debug, Clone)]
pub struct Coordinates {
    /// x, y \[m\], theta \[rad\].
    pub functions: [Function; 3],
}

impl Path for Coordinates {
    fn at(&self, t: f64) -> Motion {
        let values = self.functions.each_ref().map(|f| f.at(t));
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
