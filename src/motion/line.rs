//! A straight line from pose to pose, from rest to rest.

use super::{Knot, POSES, Path, Pose};

/// p = from + (to - from) s(t/duration), s = 10 u^3 - 15 u^4 + 6 u^5, at rest before and after.
#[derive(Debug, Clone, Copy)]
pub struct Line {
    /// Start pose.
    pub from: [f64; 3],
    /// End pose.
    pub to: [f64; 3],
    /// Time of travel \[s\].
    pub duration: f64,
}

/// s(u) = 10 u^3 - 15 u^4 + 6 u^5 between 0 and 1 with its derivatives by u; constant outside.
pub(super) fn quintic(u: f64) -> [f64; 3] {
    let u = u.clamp(0.0, 1.0);
    [
        u * u * u * (10.0 + u * (-15.0 + 6.0 * u)),
        30.0 * u * u * (1.0 - u) * (1.0 - u),
        60.0 * u * (1.0 - u) * (1.0 - 2.0 * u),
    ]
}

impl Path for Line {
    fn at(&self, t: f64) -> Pose {
        let [s, by_u, by_u2] = quintic(t / self.duration);
        let s_dot = by_u / self.duration;
        let s_ddot = by_u2 / (self.duration * self.duration);
        let mut pose = Pose::default();
        for i in 0..3 {
            let increment = self.to[i] - self.from[i];
            pose.position[i] = self.from[i] + increment * s;
            pose.velocity[i] = increment * s_dot;
            pose.acceleration[i] = increment * s_ddot;
        }
        pose
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        (duration.min(self.duration), POSES)
    }

    fn knots(&self, _: f64) -> Vec<Knot> {
        vec![Knot::at(self.duration, 3)]
    }
}
