//! Uniform motion on a circle with constant orientation (eq. 27).

use super::{POSES, Path, Pose};

/// (x, y) = center + radius (cos, sin)(rate t + phase).
#[derive(Debug, Clone, Copy)]
pub struct Circle {
    /// Centre \[m\].
    pub center: [f64; 2],
    /// Radius \[m\].
    pub radius: f64,
    /// Angular rate \[rad/s\].
    pub rate: f64,
    /// Angle at t = 0 \[rad\].
    pub phase: f64,
    /// Orientation \[rad\].
    pub theta: f64,
}

impl Path for Circle {
    fn at(&self, t: f64) -> Pose {
        let (sine, cosine) = (self.rate * t + self.phase).sin_cos();
        let (x, y) = (self.radius * cosine, self.radius * sine);
        let w = self.rate;
        Pose {
            position: [self.center[0] + x, self.center[1] + y, self.theta],
            velocity: [-w * y, w * x, 0.0],
            acceleration: [-w * w * x, -w * w * y, 0.0],
        }
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        let revolution = std::f64::consts::TAU / self.rate.abs();
        (duration.min(revolution), POSES)
    }
}
